"""A replanner under examination: a short drive through a room in which things appear and go."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

import numpy as np
import shapely

from suite.conformance.small_scenes import LEFT, RIGHT, ROOM, SmallScene, asked
from suite.conformance.subject import SEED, Run, Subject, Trial, failed, timed
from suite.planner import Budget, Planner, Recorder, Replanner
from suite.scenes.scene import Scene, make_scene

SUBJECTS = 4

WALL = shapely.box(4, 0, 6, 8)
CELL = shapely.Polygon(shapely.box(7.5, 3, 10, 7).exterior, [shapely.box(8, 4, 9.5, 6).exterior])


def _scene(obstacles: tuple[Any, ...], place: tuple[float, float]) -> Scene:
    """What is known of the room. The query that is asked leads from where the robot is."""
    queries = {"main": (LEFT, RIGHT), "from here": (place, RIGHT)}
    return make_scene("room", ROOM, obstacles, queries)


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """One update.

    small : what is known and from where the robot asks, by which the answer is judged.
    known : the name of the scene that the replanner is given; with the same name as in the step
        before, it is the same object.
    """

    small: SmallScene
    known: str


def _step(
    words: str, known: str, place: tuple[float, float], *obstacles: Any, has_path: bool = True
) -> Step:
    build = partial(_scene, obstacles, place)
    return Step(SmallScene(words, build, has_path, is_trivial=not obstacles), known)


STEPS = (
    _step("first an open room", "open", LEFT),
    _step("then a wall appears", "wall", (1.5, 5.0), WALL),
    _step("then the robot has moved", "wall", (2.5, 5.5), WALL),
    _step("then the goal is enclosed", "cell", (3.0, 6.0), WALL, CELL, has_path=False),
    _step("then all is open again", "open again", (3.0, 6.0)),
    _step("then nothing has changed", "open again", (3.0, 6.0)),
)


@lru_cache(maxsize=SUBJECTS)
def ordinary_drive(subject: Subject) -> tuple[Trial, ...]:
    """The drive with ordinary budgets, which several rules look at."""
    return drive(subject, subject.ordinary)


def drive(
    subject: Subject, budget: Budget, seed: int = SEED, *, beside: bool = False
) -> tuple[Trial, ...]:
    """Ask a new replanner at each step.

    Parameters
    ----------
    subject : Subject
    budget : Budget
        Of each single plan.
    seed : int
    beside : bool
        Whether another replanner of the same planner is asked in turn with it.

    Returns
    -------
    tuple of Trial
        One for each of STEPS, as if it were a run of its own.
    """
    planner = subject.build()
    planner.warm_up()
    rng = np.random.default_rng([seed, 2003])
    ask, ask_other = _asking(planner, rng), _asking(planner, np.random.default_rng(seed))
    scenes, others = _known(), _known()
    trials = []
    for step in STEPS:
        given, query = scenes[step.known], asked(step.small.build())
        if beside:
            _answer(ask_other, others[step.known], query, budget)
        run = partial(_answer, ask, given, query, budget)
        trials.append(subject.watched(step.small, budget, seed, rng, given, query, run))
    return tuple(trials)


def _known() -> dict[str, Scene]:
    """The scenes that a replanner is given, by name."""
    return {step.known: step.small.build() for step in STEPS}


def _asking(planner: Planner, rng: np.random.Generator) -> Callable[..., Any]:
    """Ask a new replanner, which is made with the first plan: begin, and update from then on."""
    made: list[Replanner] = []

    def ask(*arguments: Any) -> Any:
        if made:
            return made[0].update(*arguments)
        made.append(planner.replanner(rng))
        return made[0].begin(*arguments)

    return ask


def _answer(ask: Callable[..., Any], scene: Scene, query: Any, budget: Budget) -> Run:
    recorder = Recorder()
    try:
        return timed(lambda: ask(scene, query, budget, recorder), recorder)
    except (Exception, SystemExit):  # other people's code: it may raise anything
        return failed(recorder)
