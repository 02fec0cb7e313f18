"""The orientation predicate with an exact sign, after Shewchuk (1997).

A fast floating-point determinant with a proven error bound answers nearly every call; where its
sign is in doubt, the determinant is expanded into exact products and summed without error.
Exact as long as no product overflows or falls below 1e-290: coordinates of scenes are multiples of
1e-9 up to 1e9. All functions are numba kernels: scalars in, scalars out, no validation.
"""

import numpy as np

from suite.jit import allocating_kernel

# Shewchuk 1997, section 4.3: (3 + 16 eps) eps with eps = 2^-53, bounds the rounding of the
# determinant below relative to the sum of the magnitudes of its two products.
ERROR_BOUND = (3.0 + 16.0 * 2.0**-53) * 2.0**-53
_SPLITTER = 2.0**27 + 1.0


@allocating_kernel
def _two_product(a: float, b: float) -> tuple[float, float]:
    """A * b as an unevaluated sum of two floats (Dekker 1971); exact."""
    product = a * b
    c = _SPLITTER * a
    a_high = c - (c - a)
    a_low = a - a_high
    c = _SPLITTER * b
    b_high = c - (c - b)
    b_low = b - b_high
    error = product - a_high * b_high
    error -= a_low * b_high
    error -= a_high * b_low
    return product, a_low * b_low - error


@allocating_kernel
def _grow(expansion: np.ndarray, size: int, b: float) -> int:
    """Add b to a nonoverlapping expansion in place, without error (Shewchuk, theorem 10)."""
    q = b
    for i in range(size):
        e = expansion[i]
        total = q + e
        virtual = total - q
        expansion[i] = (q - (total - virtual)) + (e - virtual)
        q = total
    expansion[size] = q
    return size + 1


@allocating_kernel
def _exact_sign(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Sign of the determinant, from its six products expanded exactly."""
    expansion = np.empty(12, dtype=np.float64)
    size = 0
    left = (ax, bx, cx, -bx, -cx, -ax)
    right = (by, cy, ay, ay, by, cy)
    for i in range(6):
        high, low = _two_product(left[i], right[i])
        size = _grow(expansion, size, low)
        size = _grow(expansion, size, high)
    # The largest nonzero component of a nonoverlapping expansion has the sign of the sum.
    for i in range(size - 1, -1, -1):
        if expansion[i] > 0.0:
            return 1
        if expansion[i] < 0.0:
            return -1
    return 0


@allocating_kernel
def _subtraction_is_exact(a: float, b: float) -> bool:
    """Whether a - b was computed without rounding (Knuth's two-difference has no tail)."""
    difference = a - b
    virtual = a - difference
    return (a - (difference + virtual)) + (virtual - b) == 0.0


@allocating_kernel
def _sign_in_doubt(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Exact sign where the filter fails; on its own, so that the compiler inlines the filter."""
    if (
        _subtraction_is_exact(ax, cx)
        and _subtraction_is_exact(by, cy)
        and _subtraction_is_exact(ay, cy)
        and _subtraction_is_exact(bx, cx)
    ):
        # Lattice points end here: two exact products remain to be compared.
        left_high, left_low = _two_product(ax - cx, by - cy)
        right_high, right_low = _two_product(ay - cy, bx - cx)
        if left_high == right_high:
            left_high, right_high = left_low, right_low
        return int(left_high > right_high) - int(left_high < right_high)
    return _exact_sign(ax, ay, bx, by, cx, cy)


@allocating_kernel
def orientation(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> int:
    """Side of the directed line a -> b on which c lies: 1 left, -1 right, 0 exactly on it."""
    left = (ax - cx) * (by - cy)
    right = (ay - cy) * (bx - cx)
    determinant = left - right
    bound = ERROR_BOUND * (abs(left) + abs(right))
    if determinant > bound:
        return 1
    if -determinant > bound:
        return -1
    return _sign_in_doubt(ax, ay, bx, by, cx, cy)
