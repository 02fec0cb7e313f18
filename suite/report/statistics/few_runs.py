"""Whether there are enough runs for a test to show a difference at all, however large it is."""

from collections.abc import Sequence
from itertools import count

from suite.report.statistics.inference import CONSTANT, LEVEL, smallest_p
from suite.report.words import counted

PAIR = tuple[int, int]
"""Numbers of runs of the two sides of a comparison; one of them may be a constant."""


def too_few(sizes: Sequence[PAIR]) -> str:
    """A sentence that says that no difference could be shown, and how many runs would do.

    Parameters
    ----------
    sizes : sequence of (int, int)
        Of each comparison of which the p-values are corrected together, after Holm.

    Returns
    -------
    str
        Empty if a difference could be shown in one of them, or if there is none.
    """
    if not sizes:
        return ""
    # Holm's factor of the smallest of all is their number.
    clearest = min(sizes, key=lambda pair: smallest_p(*pair))
    least = min(len(sizes) * smallest_p(*clearest), 1.0)
    if least < 1.0 - LEVEL:
        return ""
    comparisons = counted(len(sizes), "comparison")
    return (
        f"Too few runs: with {_side(clearest[0])} against {_side(clearest[1])} and {comparisons}, "
        "the smallest p "
        f"that there can be is {least:.2g} after Holm's correction, so that no difference can be "
        f"shown at {100 * (1 - LEVEL):.0f} %, however large; {enough(len(sizes))} runs on each "
        "side would do for a large one."
    )


def _side(runs: int) -> str:
    return "a constant" if runs == CONSTANT else str(runs)


def enough(comparisons: int) -> int:
    """Runs on each side with which the clearest difference is shown, among so many comparisons.

    Examples
    --------
    >>> enough(1), enough(12), enough(40)
    (4, 6, 7)
    """
    return next(n for n in count(2) if comparisons * smallest_p(n, n) < 1.0 - LEVEL)
