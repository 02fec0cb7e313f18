"""Compile, or load, what planners need before the first run that is timed."""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from typing import Any

from suite.errors import PluginError, sentence
from suite.planner import Planner
from suite.plugins.discovery import load_planner, planner_info, planner_names
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path

EXACT = "exact solver"


@dataclass(frozen=True, slots=True)
class Warmed:
    """What came of warming up one planner.

    name : of the planner, or that of the exact solver.
    cpu_s : processor seconds that it took.
    problem : why it could not be done; None if it was.
    is_missing : whether the planner was not asked for by name and can't be had, as where an extra
        is not installed.
    """

    name: str
    cpu_s: float
    problem: str | None = None
    is_missing: bool = False

    @property
    def is_well(self) -> bool:
        """Whether nothing that was asked for went wrong."""
        return self.problem is None or self.is_missing

    @property
    def line(self) -> str:
        """In words."""
        if self.problem is None:
            return f"{self.name}: ready after {self.cpu_s:.1f} s of CPU time"
        return f"{self.name}: {'not there' if self.is_missing else 'failed'}: {self.problem}"

    @property
    def as_data(self) -> dict[str, Any]:
        """For programs."""
        return asdict(self)


def warm_up_each(planners: Sequence[str] | None) -> Iterator[Warmed]:
    """Warm up planners, after the exact solver, which every run asks for the optimum.

    Parameters
    ----------
    planners : names; None: all that are installed.

    Yields
    ------
    Warmed, as soon as each is done.

    Raises
    ------
    PluginError
        If no planner has a name; before anything is warmed up.
    """
    for name in planners or ():
        planner_info(name)
    yield _timed(EXACT, _warm_up_exact_solver)
    for name in planner_names() if planners is None else planners:
        try:
            planner = load_planner(name)
        except PluginError as error:
            yield Warmed(name, 0.0, sentence(error), is_missing=planners is None)
        else:
            yield _timed(name, partial(_warm_up, planner))


def _warm_up(planner: type[Planner]) -> None:
    planner().warm_up()


def _warm_up_exact_solver() -> None:
    scene = load_scene("unstructured")
    shortest_path(scene, scene.query())


def _timed(name: str, work: Callable[[], object]) -> Warmed:
    began = time.process_time()
    try:
        work()
    except Exception as error:  # a planner's own: whatever it is, the next ones are warmed up
        problem = sentence(f"{type(error).__name__}: {error}")
        return Warmed(name, time.process_time() - began, problem)
    return Warmed(name, time.process_time() - began)
