"""Numbers and sentences as tables, notes and pictures write them."""

import re
from collections.abc import Iterable
from math import inf


def fixed(value: float, digits: int = 2) -> str:
    """A number with so many digits after the point, and no sign before a zero.

    Examples
    --------
    >>> fixed(-0.0001), fixed(2.345, 1), fixed(inf)
    ('0.00', '2.3', 'infinite')
    """
    if value == inf:
        return "infinite"
    return f"{round(value, digits) + 0.0:.{digits}f}"


def counted(number: int, what: str) -> str:
    """So many of something.

    Examples
    --------
    >>> counted(1, "scene"), counted(8, "scene")
    ('1 scene', '8 scenes')
    """
    return f"{number} {what}{'' if number == 1 else 's'}"


def of_some(text: str, some: int, runs: int) -> str:
    """A measure, and how many of the runs it is over, if not over all.

    Examples
    --------
    >>> of_some("0.24", 20, 20), of_some("0.24", 19, 20)
    ('0.24', '0.24 (19 of 20)')
    """
    return text if some == runs else f"{text} ({some} of {runs})"


def some_of(names: Iterable[object], most: int) -> str:
    """The first of some names, and how many more there are.

    Examples
    --------
    >>> some_of("abc", 3), some_of("abcde", 3)
    ('a, b, c', 'a, b, c and 2 more')
    """
    different = list(dict.fromkeys(map(str, names)))
    more = f" and {len(different) - most} more" if len(different) > most else ""
    return ", ".join(different[:most]) + more


def joined(*sentences: str) -> str:
    """A note of several sentences, of which some may be empty."""
    return " ".join(filter(None, sentences))


LETTERS_OF_A_QUERY = 28
"""Longer names are cut in the middle."""

_NUMBER = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)"
_ENDS = re.compile(rf"{_NUMBER},{_NUMBER}:{_NUMBER},{_NUMBER}")


def query_label(name: str) -> str:
    """The name of a query for people: places to four digits, and no text longer than a column.

    Examples
    --------
    >>> query_label("main"), query_label("12.345678,4.5:20.125,9.25")
    ('main', '12.35,4.5:20.12,9.25')
    >>> query_label("from the loading bay to the far gate")
    'from the loadi… the far gate'
    """
    found = _ENDS.fullmatch(name)
    if found is not None:
        x, y, to_x, to_y = (f"{float(number):.4g}" for number in found.groups())
        return f"{x},{y}:{to_x},{to_y}"
    if len(name) <= LETTERS_OF_A_QUERY:
        return name
    kept = LETTERS_OF_A_QUERY - 1
    return f"{name[: kept - kept // 2]}…{name[-(kept // 2) :]}"
