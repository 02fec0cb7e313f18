"""How much of a generation fits into the time that is left.

Looking at the clock is cheap; leaving the compiled code for it costs as much as a child or two. So
it is looked at seldom while there is much time, and often at the end.
"""

from collections.abc import Callable
from math import inf

PAIR = 2
"""Children that are made at once: fewer can't be."""

SHARE = 0.5
"""Of the time that is left, what the next children may take: they may be slower than the last."""

MOST = 1_000_000
"""Children that may be made before the clock is looked at, where one takes next to no time."""


class Deadline:
    """Says how many children may be made before the clock is looked at again.

    Parameters
    ----------
    left : callable
        The seconds that are left.

    Examples
    --------
    >>> seconds = iter([10.0, 9.0, 0.0])
    >>> deadline = Deadline(lambda: next(seconds))
    >>> deadline.children_after(0), deadline.children_after(2), deadline.children_after(10)
    (2, 8, 0)
    """

    def __init__(self, left: Callable[[], float]) -> None:
        self._left = left
        self._before = (0, inf)

    def children_after(self, total: int) -> int:
        """How many children may be made now; 0 if the time is over.

        Parameters
        ----------
        total : int
            Children that have been made so far.
        """
        left = self._left()
        made, took = total - self._before[0], self._before[1] - left
        self._before = (total, left)
        if left <= 0.0:
            return 0
        if made == 0:  # so that it is known how long a pair takes
            return PAIR
        fitting = SHARE * left / took * made if took > 0.0 else MOST
        return PAIR * max(1, int(min(fitting, MOST)) // PAIR)
