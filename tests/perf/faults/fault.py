"""A fault that a user meets, and what came of it by stated criteria."""

import re
from collections import Counter
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path

from tests.perf.faults.stage import GOOD, Found, Said, Stage

CRITERIA = (
    "every run that was tried is a row, or is run when the same command is given again",
    "the store opens, SQLite's integrity check says ok, and the rows from before are as they were",
    "the planner beside the struck one has all its rows, solved, in the end",
    "the command ends by itself, without a traceback",
    "where it does not do all, its exit code is not 0 and its words say what, where, how to mend",
    "no process is left",
)


def no_need() -> str | None:
    """A fault that can be tried anywhere."""
    return None


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that goes wrong.

    name : what, in the user's words.
    how : how it is brought about here.
    strike : runs the command on the stage and lets it happen; whatever stands in the way of the
        same command is taken away again before it returns.
    planner : name of the planner that is struck.
    settings : of the planner, TOML.
    status : of its rows in the end, of which each must be one.
    codes : exit codes of the command that are right.
    says : a pattern that the command's words, or the reasons of the rows, must have.
    needs : says what is missing for it here, or None.
    """

    name: str
    how: str
    strike: Callable[[Stage], Said] = Stage.run
    planner: str = "sleeper"
    settings: str = ""
    seeds: int = 2
    limits: str = "wall_s = 60\nmemory_mb = 600"
    status: tuple[str, ...] = ("solved",)
    codes: tuple[int, ...] = (0,)
    says: str = ""
    place: str = "."
    options: tuple[str, ...] = ("--jobs", "2")
    ground: Callable[[Stage], AbstractContextManager[None]] = lambda _: nullcontext()
    needs: Callable[[], str | None] = no_need


@dataclass(frozen=True, slots=True)
class Outcome:
    """What came of a fault; see :data:`CRITERIA`."""

    fault: Fault
    wanted: int
    before: Found
    said: Said
    left: int
    found: Found
    again: Said
    end: Found

    def flaws(self) -> list[str]:
        """The criteria that do not hold, in a few words each; none if the fault is contained."""
        return [words for words, holds in self._criteria() if not holds]

    def _criteria(self) -> list[tuple[str, bool]]:
        code = self.said.code
        return [
            ("the command hangs", code is not None),
            (f"exit code {code}", code is None or code in self.fault.codes),
            ("a traceback", "Traceback" not in self.said.text),
            (f"no word of {self.fault.says!r}", self._says()),
            ("rows are missing and the exit code is 0", self.is_complete(self.found) or code != 0),
            ("the store is not whole", self.found.whole and self.end.whole),
            ("rows from before are lost or changed", self._kept(self.before, self.found)),
            ("rows are lost or changed later", self._kept(self.found, self.end)),
            ("the same command does not do the rest", self._is_resumed()),
            ("the planner beside it is struck", self._is_good_solved()),
            (f"its rows are {self.statuses(self.end)}", self._is_row_right()),
            (f"{self.left} processes are left", self.left == 0),
        ]

    def is_complete(self, found: Found) -> bool:
        """Whether the rows of the whole matrix are there."""
        return len(found.rows) == self.wanted

    def statuses(self, found: Found) -> str:
        """How often the struck planner's rows have which status."""
        counts = Counter(row[2] for row in found.of(self.fault.planner))
        return ", ".join(f"{status} x {n}" for status, n in sorted(counts.items())) or "none"

    def words(self) -> str:
        """The line of what the command printed that was wanted, or else the last one."""
        lines = self.said.text.strip().splitlines()
        wanted = [line for line in lines if self.fault.says and re.search(self.fault.says, line)]
        return (wanted or lines or [""])[-1]

    def reason(self) -> str:
        """What the struck planner's row says, in short."""
        for *_, reason in self.end.of(self.fault.planner):
            if isinstance(reason, str) and reason.strip():
                return reason.strip().splitlines()[-1]
        return ""

    def _says(self) -> bool:
        reasons = [row[3] for row in self.end.of(self.fault.planner) if isinstance(row[3], str)]
        return re.search(self.fault.says, "\n".join([self.said.text, *reasons])) is not None

    def _kept(self, before: Found, after: Found) -> bool:
        return all(after.rows.get(key) == row for key, row in before.rows.items())

    def _is_resumed(self) -> bool:
        return self.again.code == 0 and self.is_complete(self.end)

    def _is_good_solved(self) -> bool:
        return all(row[2] == "solved" for row in self.end.of(GOOD))

    def _is_row_right(self) -> bool:
        return {row[2] for row in self.end.of(self.fault.planner)} <= set(self.fault.status)


def suffer(fault: Fault, folder: Path, site: Path, rows: Path) -> Outcome:
    """Let a fault happen in an empty folder, and look at what is left.

    rows : a store with rows that must outlive it.
    """
    planner = f'[[planner]]\nplanner = "{fault.planner}"\n{fault.settings}\n'
    stage = Stage(
        folder,
        site,
        planner.replace("FOLDER", str(folder)),
        fault.seeds,
        fault.limits,
        fault.place,
        fault.options,
    )
    with fault.ground(stage):
        try:
            return _suffered(fault, stage, rows)
        finally:
            stage.sweep()


def _suffered(fault: Fault, stage: Stage, rows: Path) -> Outcome:
    stage.prepare(rows)
    before = stage.look()
    said = fault.strike(stage)
    left = len(stage.left())
    stage.sweep()
    found = stage.look()
    if said.code == 0 and len(found.rows) == stage.wanted:
        return Outcome(fault, stage.wanted, before, said, left, found, said, found)
    again = stage.run()
    return Outcome(fault, stage.wanted, before, said, left, found, again, stage.look())
