"""Maps that are text, read so that what is none is said, and the numbers in it."""

import math
from pathlib import Path

from suite.errors import SceneError


def read_lines(path: Path) -> list[str]:
    """The lines of a text file, however they end.

    Raises
    ------
    SceneError
        If it can't be read, or is no text.
    """
    try:
        return path.read_text(encoding="utf-8-sig").split("\n")
    except UnicodeDecodeError as error:
        raise SceneError(f"{path.name}: is no text ({error.reason}). Save it as UTF-8.") from error
    except OSError as error:
        raise SceneError(f"{path}: can't be read ({error.strerror}).") from error


def finite(text: str) -> float | None:
    """The finite number that a text is; None if it is none.

    Examples
    --------
    >>> finite("0.05"), finite("nan"), finite("five")
    (0.05, None, None)
    """
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def one_line(words: object, longest: int = 100) -> str:
    r"""What a library or a file says, as a part of an error: on one line, printable, and not long.

    Examples
    --------
    >>> one_line(ValueError("bad\n  header\x00"))
    'bad header'
    """
    text = "".join(c for c in " ".join(str(words).split()) if c.isprintable())
    return text if len(text) <= longest else f"{text[: longest - 3]}..."
