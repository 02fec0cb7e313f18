"""Where a fault is tried: a folder with a scene, a matrix, a store with rows, and the command."""

import os
import shutil
import signal
import sqlite3
import subprocess
import time
import uuid
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import psutil

from suite.store.read import read_paths, read_runs
from suite.store.write import open_store
from tests.suite.commands import COMMAND, hear_interrupts, marked
from tests.suite.harness.hostile_site import write_wall

BOUND_S = 180.0
"""A command that is not back by then never will be: the slowest fault here takes a tenth of it."""

GONE_S = 10.0
POLL_S = 0.02

GOOD = "wanderer"
"""The planner that does what it should, beside the one that is struck."""


@dataclass(frozen=True, slots=True)
class Said:
    """How a command ended.

    code : None if it did not end within BOUND_S, negative for a signal.
    text : all that it printed.
    """

    code: int | None
    text: str
    seconds: float


@dataclass(frozen=True, slots=True)
class Found:
    """A store as it was found.

    whole : whether it opens, and SQLite finds nothing wrong with it.
    rows : (wall time, bytes of the path, status, reason) of each row, by its key.
    planners : name of the variant of each row, by its key.
    """

    whole: bool
    rows: dict[str, tuple[Any, ...]] = field(default_factory=dict)
    planners: dict[str, str] = field(default_factory=dict)

    def of(self, planner: str) -> list[tuple[Any, ...]]:
        """The rows of a planner."""
        return [self.rows[key] for key, name in self.planners.items() if name == planner]


@dataclass(slots=True)
class Stage:
    """A folder in which commands are run, all of whose processes are known by a mark.

    folder : Path of an empty folder.
    site : Path of the hostile planners' distribution.
    planner : TOML of the planner that is struck.
    seeds : of each planner.
    limits : TOML of the limits.
    place : folder of the store, below the other.
    options : of each `run` of the matrix.
    said : what each command prints, by its process.
    """

    folder: Path
    site: Path
    planner: str
    seeds: int = 2
    limits: str = "wall_s = 60\nmemory_mb = 600"
    place: str = "."
    options: Sequence[str] = ()
    mark: str = field(default_factory=lambda: uuid.uuid4().hex)
    said: dict[int, Path] = field(default_factory=dict)

    @property
    def store(self) -> Path:
        """The store's file."""
        return self.folder / self.place / "store.db"

    @property
    def wanted(self) -> int:
        """Rows of the whole matrix."""
        return self.seeds * (2 if self.planner else 1)

    def prepare(self, rows: Path) -> None:
        """Write the scene and the matrix, and put a store there whose rows must outlive the fault.

        rows : a store that :func:`first_rows` has made.
        """
        write_wall(self.folder / "wall.geojson")
        text = (
            f'scenes = ["wall.geojson"]\nseeds = {self.seeds}\n[limits]\n{self.limits}\n'
            f'[[planner]]\nplanner = "{GOOD}"\n'
        )
        (self.folder / "matrix.toml").write_text(text + self.planner)
        shutil.copy(rows, self.store)

    def start(
        self,
        *,
        environment: Mapping[str, str | None] | None = None,
        before: Callable[[], None] = lambda: None,
        prefix: Sequence[str] = (),
    ) -> "subprocess.Popen[bytes]":
        """Start `kbga-bench run`, as the leader of a session.

        environment : changes; a variable of None is taken away.
        before : done in the new process.
        prefix : a program that starts it.
        """
        matrix = str(self.folder / "matrix.toml")
        options = [option.replace("FOLDER", str(self.folder)) for option in self.options]
        arguments = ["run", matrix, "--store", str(self.store), *options]
        return self.begin([*prefix, *COMMAND, *arguments], environment, before)

    def begin(
        self,
        command: Sequence[str],
        environment: Mapping[str, str | None] | None = None,
        before: Callable[[], None] = lambda: None,
    ) -> "subprocess.Popen[bytes]":
        """Start any command with this stage's environment."""
        paths = [str(self.site), os.environ.get("PYTHONPATH", "")]
        wanted: dict[str, str | None] = {
            **os.environ,
            "PYTHONPATH": os.pathsep.join(filter(None, paths)),
            "KBGA_TEST_MARK": self.mark,
            "KBGA_BENCH_PATIENCE": "0",
            **(environment or {}),
        }

        def prepare() -> None:
            hear_interrupts()
            # So does `nohup` with this one, and this command may have been started by it.
            signal.signal(signal.SIGHUP, signal.SIG_DFL)
            before()

        # Not into a pipe: whoever reads that waits for all that have it, and not for the command.
        said = self.folder / f"said-{uuid.uuid4().hex}.txt"
        with said.open("w") as output:
            process = subprocess.Popen(
                command,
                env={name: value for name, value in wanted.items() if value is not None},
                cwd=self.folder,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=prepare,
            )
        self.said[process.pid] = said
        return process

    def run(self, **options: Any) -> Said:
        """Run `kbga-bench run` to its end."""
        return self.finish(self.start(**options))

    def finish(self, command: "subprocess.Popen[bytes]") -> Said:
        """Wait for the end of a command."""
        began = time.monotonic()
        code: int | None = None
        try:
            code = command.wait(BOUND_S)
        except subprocess.TimeoutExpired:
            self.sweep()
            command.wait()
        text = self.said[command.pid].read_text(encoding="utf-8", errors="replace")
        return Said(code, text, time.monotonic() - began)

    def wait_for_rows(self, count: int) -> None:
        """Until the store has so many."""
        wait_until(lambda: len(self.look().rows) >= count)

    def server_of(self, command: "subprocess.Popen[bytes]") -> psutil.Process:
        """The fork server of a command that runs runs."""
        (server,) = [
            child
            for child in psutil.Process(command.pid).children()
            if "forkserver" in " ".join(child.cmdline())
        ]
        return server

    def worker(self) -> psutil.Process:
        """The process of a run of the planner `lingers`, as soon as there is one."""
        file = self.folder / "pid"
        wait_until(lambda: file.exists() and file.read_text().endswith("."))
        return psutil.Process(int(file.read_text()[:-1]))

    def left(self) -> list[psutil.Process]:
        """Processes of this stage that do not end by themselves."""
        deadline = time.monotonic() + GONE_S
        while (found := marked(self.mark)) and time.monotonic() < deadline:
            time.sleep(POLL_S)
        return found

    def sweep(self) -> None:
        """Kill the processes of this stage, and no others."""
        for process in marked(self.mark):
            process.kill()

    def look(self) -> Found:
        """What is in the store."""
        try:
            with closing(sqlite3.connect(f"file:{self.store}?mode=ro", uri=True)) as connection:
                verdict = connection.execute("PRAGMA integrity_check").fetchone()
            runs, paths = read_runs(self.store), read_paths(self.store)
        except Exception:
            return Found(whole=False)
        rows = {
            row["key"]: (
                str(row["wall_s"]),
                paths[row["key"]].tobytes() if row["key"] in paths else None,
                row["status"],
                row["reason"] if isinstance(row["reason"], str) else "",
            )
            for row in runs.to_dict("records")
        }
        return Found(verdict == ("ok",), rows, dict(zip(runs["key"], runs["variant"], strict=True)))


def wait_until(condition: Callable[[], bool]) -> None:
    """Wait for something that must come."""
    deadline = time.monotonic() + BOUND_S
    while not condition():
        if time.monotonic() > deadline:
            raise AssertionError("waited too long for the moment of the fault")
        time.sleep(POLL_S)


def first_rows(folder: Path, site: Path) -> Path:
    """A store with a row of the planner that does what it should, made in an empty folder."""
    stage = Stage(folder, site, planner="", seeds=1)
    empty = folder / "empty.db"
    with open_store(empty):
        pass
    stage.prepare(empty)
    done = stage.run()
    if done.code != 0:
        raise AssertionError(f"the row before all faults: {done}")
    return stage.store
