"""The errors that a user can meet, and hints. A message says what, where, and how to mend it."""

import errno
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from difflib import SequenceMatcher, get_close_matches
from pathlib import Path

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


@contextmanager
def writing(file: Path, error: type[KbgaBenchError] = KbgaBenchError) -> Iterator[None]:
    """Raise an error that names the file if the system refuses to write it."""
    try:
        yield
    except OSError as cause:
        raise error(f"{file}: can't be written ({cause.strerror}).{_mend(cause)}") from cause


def _mend(cause: OSError) -> str:
    """What to do about a file that the system refuses to write; nothing, if that is plain."""
    if cause.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
        return " Make room, or name another place."
    if cause.errno in (errno.EROFS, errno.EACCES, errno.EPERM):
        return " Name a place that you may write to."
    return ""


def check_file(
    file: Path, what: str, suffixes: Sequence[str], error: type[KbgaBenchError] = KbgaBenchError
) -> None:
    """Refuse a file of a kind that these things can't be, or in a folder that there is not.

    Before anything is made for it, which may take long.

    Examples
    --------
    >>> check_file(Path("a.bmp"), "figures", [".png", ".pdf"])
    Traceback (most recent call last):
    suite.errors.KbgaBenchError: a.bmp: figures are .png, .pdf. Name such a file.
    """
    if file.suffix.lower() not in suffixes:
        raise error(f"{file}: {what} are {', '.join(suffixes)}. Name such a file.")
    if not file.parent.is_dir():
        raise error(f"{file}: there is no folder {file.parent}. Make it first.")


def sentence(text: object) -> str:
    """A text with a full stop, unless it has its own end: what others wrote may have one.

    Examples
    --------
    >>> sentence("no such file"), sentence("another version?"), sentence("Install it.")
    ('no such file.', 'another version?', 'Install it.')
    """
    words = str(text).rstrip()
    return words if words.endswith((".", "?", "!", ":")) else f"{words}."


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
