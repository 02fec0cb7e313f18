"""The files that a scene is read from, and whether they are still what they were.

Maps consist of several files. Which belong to one is known by their names: those beside it that
share its name, and the image that a map_server file names. One too many costs time, no more: where
a digest differs, the scene is read to see whether it is another one.
"""

import hashlib
import re
from pathlib import Path

from suite.scenes.catalogue import main_file

MOST_BYTES = 500_000_000
"""Of a file that counts: a larger one is no map."""

_IMAGE = re.compile(r"^\s*image\s*:\s*['\"]?([^'\"\n#]+)", re.MULTILINE)


def files_digest(source: str) -> str | None:
    """Hash of the names and contents of the files of a scene; None if it has none.

    Parameters
    ----------
    source : str
        As :func:`suite.scenes.catalogue.load_scene` takes it.
    """
    file = main_file(source)
    if file is None:
        return None
    try:
        parts = [(found.name, _digest(found)) for found in _files(file)]
    except OSError:
        return None
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:32]


def _files(file: Path) -> list[Path]:
    own = f"{file.stem}."
    beside = {f for f in file.parent.iterdir() if f.name.startswith(own) and _is_of_a_map(f)}
    if file.suffix.lower() in (".yaml", ".yml"):
        images = _IMAGE.findall(file.read_text(encoding="utf-8", errors="replace"))
        beside |= {file.parent / name.strip() for name in images}
    return sorted({file, *beside}, key=lambda found: (found != file, found.name))


def _is_of_a_map(file: Path) -> bool:
    """Whether a file may belong to a map: what the suite itself writes does not."""
    return (
        file.is_file()
        and not file.name.endswith((".db", ".db-wal", ".db-shm", ".db.lock", ".html", ".toml"))
        and file.stat().st_size <= MOST_BYTES
    )


def _digest(file: Path) -> str:
    with file.open("rb") as content:
        return hashlib.file_digest(content, "sha256").hexdigest()
