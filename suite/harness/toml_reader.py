"""Values out of a TOML file, each checked, with errors that say what, where, and how to mend."""

import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from suite.errors import MatrixError, did_you_mean


@dataclass(frozen=True, slots=True, eq=False)
class Reader:
    """A table of a TOML file, and where it stands, for errors.

    file : name of the file.
    values : what TOML holds there.
    place : of the table in the file; empty for the file itself.
    """

    file: str
    values: dict[str, Any]
    place: str = ""

    def error(self, what: str) -> MatrixError:
        """An error that names this place."""
        where = f"{self.file}, {self.place}" if self.place else self.file
        return MatrixError(f"{where}: {what}")

    def renamed(self, place: str) -> "Reader":
        """The same table, under a name that its reader knows better."""
        return replace(self, place=place)

    def allow(self, *keys: str) -> None:
        """Refuse every key but these."""
        for key in self.values:
            if key not in keys:
                hint = did_you_mean(key, keys)
                raise self.error(f"unknown key '{key}'. It may have: {', '.join(keys)}.{hint}")

    def take(self, key: str, how: str) -> Any:
        """The value of a key that must be there; ``how`` says how to mend its absence."""
        if key not in self.values:
            raise self.error(f"'{key}' is missing: {how}.")
        return self.values[key]

    def text(self, key: str, default: str | None = None, what: str = "a text") -> str:
        """A string, not empty unless the default is; ``what`` says which."""
        if default is not None and key not in self.values:
            return default
        value = self.take(key, f"give {what}")
        if not isinstance(value, str) or not (value or default == ""):
            raise self.error(f"{key} is {value!r}. Give {what}.")
        return value

    def flag(self, key: str) -> bool:
        """True or false; false if the key is not there."""
        value = self.values.get(key, False)
        if not isinstance(value, bool):
            raise self.error(f"{key} is {value!r}. Give true or false.")
        return value

    def texts(self, key: str) -> list[str]:
        """A list of strings, not empty."""
        value = self.take(key, "give a list of texts")
        if not isinstance(value, list) or not value or not all(isinstance(v, str) for v in value):
            raise self.error(f"{key} is {value!r}. Give a list of texts, at least one.")
        return value

    def table(self, key: str) -> "Reader":
        """A table; an empty one if the key is not there."""
        value = self.values.get(key, {})
        if not isinstance(value, dict):
            raise self.error(f"{key} is {value!r}. Give a table, such as [{key}].")
        return Reader(self.file, value, f"{self.place}, {key}" if self.place else key)

    def tables(self, key: str) -> list["Reader"]:
        """An array of tables, not empty."""
        value = self.take(key, f"give at least one [[{key}]]")
        if not isinstance(value, list) or not value or not all(isinstance(v, dict) for v in value):
            raise self.error(f"{key} is no array of tables. Write [[{key}]] above each.")
        return [Reader(self.file, v, f"{key} {i}") for i, v in enumerate(value, 1)]


def read_toml(path: Path) -> dict[str, Any]:
    """Read a TOML file.

    Raises
    ------
    MatrixError
        If it can't be read or is not TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise MatrixError(f"{path}: can't be read ({error.strerror}).") from error
    except UnicodeDecodeError as error:
        raise MatrixError(f"{path.name}: is not UTF-8 text (byte {error.start}).") from error
    except tomllib.TOMLDecodeError as error:
        raise MatrixError(f"{path.name}: not TOML: {error}.") from error
