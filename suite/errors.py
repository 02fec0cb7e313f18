"""The errors that a user can meet, and hints. A message says what, where, and how to mend it."""

from collections.abc import Iterable
from difflib import SequenceMatcher, get_close_matches

LEAST_LETTERS = 2
"""Of what a name may begin with to be meant by it."""

CUTOFF = 0.7
"""Likeness, of difflib, below which a hint would be a guess: 'steps' for 'temp'."""


class KbgaBenchError(Exception):
    """Base of every error that the suite raises on purpose."""


class SceneError(KbgaBenchError):
    """A scene file or a scene's geometry can't be used."""


class PluginError(KbgaBenchError):
    """A planner can't be found, imported, or built with the given settings."""


class ContractError(KbgaBenchError):
    """A planner broke the plugin contract of ``suite.planner``."""


class MatrixError(KbgaBenchError):
    """A matrix file can't be used."""


class StoreError(KbgaBenchError):
    """A result store can't be opened, read or written."""


class HarnessError(KbgaBenchError):
    """The harness can't go on with a matrix."""


def did_you_mean(word: str, words: Iterable[str]) -> str:
    """A hint at the nearest of some words, to be put behind an error, or nothing.

    A word that begins with what was typed, or is the beginning of it, comes first.

    Examples
    --------
    >>> did_you_mean("temp", ["steps", "temperature"])
    " Did you mean 'temperature'?"
    >>> did_you_mean("temp", ["steps"])
    ''
    """
    known = list(words)
    alike = [name for name in known if _one_begins_the_other(name, word)]
    nearest = max(alike, key=lambda name: SequenceMatcher(None, word, name).ratio(), default=None)
    found = [nearest] if nearest is not None else get_close_matches(word, known, 1, CUTOFF)
    return f" Did you mean '{found[0]}'?" if found else ""


def _one_begins_the_other(one: str, other: str) -> bool:
    short, long = sorted((one.lower(), other.lower()), key=len)
    return len(short) >= LEAST_LETTERS and long.startswith(short)
