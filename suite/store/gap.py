"""The optimality gap: how far a cost lies above the exact optimum, as a share of it.

Where start and goal are one place the optimum is 0: the gap of a path of no length is 0, that of
any other is infinite.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

ROUNDING = 1e-9
"""Relative: costs that differ by less are equal, as sums of the same lengths in another order."""


def gaps(cost: ArrayLike, optimum: ArrayLike) -> NDArray[np.float64]:
    """Costs over optima, less 1; what is rounding is 0.

    Parameters
    ----------
    cost, optimum : (r,) float64, metres
        nan where there is none.

    Returns
    -------
    (r,) float64

    Examples
    --------
    >>> gaps([110.0, 100.0 - 1e-12, 0.0, 0.1], [100.0, 100.0, 0.0, 0.0]).round(9).tolist()
    [0.1, 0.0, 0.0, inf]
    """
    costs, optima = (np.asarray(values, dtype=np.float64) for values in (cost, optimum))
    with np.errstate(divide="ignore", invalid="ignore"):
        ratio = np.where((optima == 0.0) & (costs == 0.0), 1.0, costs / optima)
    gap = ratio - 1.0
    return np.where(np.abs(gap) < ROUNDING, 0.0, gap)


def gap_of(cost: float, optimum: float | None) -> float | None:
    """The gap of one cost; None if there is no optimum, or the gap is not finite.

    Examples
    --------
    >>> gap_of(110.0, 100.0), gap_of(0.1, 0.0), gap_of(0.0, 0.0)
    (0.10000000000000009, None, 0.0)
    """
    if optimum is None:
        return None
    gap = float(gaps(cost, optimum))
    return gap if np.isfinite(gap) else None
