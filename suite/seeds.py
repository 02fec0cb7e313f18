"""Which seeds there are: those that a store, pandas and every format of rows can hold."""

from suite.errors import KbgaBenchError

MOST = 2**63 - 1
"""The largest seed. SQLite's and pandas' integers have 64 bits and a sign."""

WHICH = f"whole numbers from 0 to {MOST}"


def check_seed(seed: int) -> None:
    """Refuse a seed that no row could have.

    Raises
    ------
    KbgaBenchError

    Examples
    --------
    >>> check_seed(MOST)
    """
    if not 0 <= seed <= MOST:
        raise KbgaBenchError(f"the seed is {seed}. Seeds are {WHICH}.")
