"""A planner under examination, and its runs: each in this process, watched, and kept for all rules.

A run here goes as in the harness: a planner is built and warmed up, may refuse, and plans; then the
path is judged. The scene that it is given is its own: the judge has another.
"""

import traceback
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from suite.conformance.environment import watch
from suite.conformance.finding import Answer
from suite.conformance.small_scenes import SmallScene, asked, small_scenes
from suite.conformance.surroundings import Surroundings, fingerprint
from suite.errors import ContractError
from suite.planner import Budget, Plan, Planner, PlanStatus, Recorder, refusal
from suite.processes.random_state import seed_globals
from suite.referee.claims import plain_plan
from suite.referee.clock import Clock
from suite.referee.path import Referee, Verdict, flaw_of_path
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query, Scene
from suite.typed import plain

SEED = 1

GENERATIONS = 10
CHECKS = 4000
WALL_S = 0.2
"""Ordinary budgets: enough for simple scenes, and little enough that no author has to wait."""

TRACEBACK_LINES = 8

_lent: dict[str, Scene] = {}
"""The scenes that planners are given, by name; one that was written to is built anew."""


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """What a planner did.

    recorder : what it reported.
    refusal : what ``refuse`` returned.
    returned : what ``plan`` returned; None if it was not called.
    error : the end of the traceback, if anything raised.
    wall_s, cpu_s : what ``plan`` took, seconds.
    prepared : attributes of the planner that ``refuse`` has set.
    restarted : whether ``plan`` set the recorder's clock to zero.
    """

    recorder: Recorder
    refusal: Any = None
    returned: Any = None
    error: str | None = None
    wall_s: float = 0.0
    cpu_s: float = 0.0
    prepared: tuple[str, ...] = ()
    restarted: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class WarmUp:
    """The first warm-up of a planner: whatever is imported or compiled but once comes here.

    error : what it raised; None if it ended well.
    before, after : the process around it.
    """

    error: str | None
    before: Surroundings
    after: Surroundings


@dataclass(frozen=True, slots=True)
class Running:
    """A run that is about to begin.

    scene : the name of its small scene.
    ordinary : whether its budget is that of most runs.
    label : the run in words.
    """

    scene: str
    ordinary: bool
    label: str


@dataclass(frozen=True, eq=False)
class Trial:
    """One run of a planner, and what was seen around it.

    scene : which of the kit.
    budget, seed : what it was given.
    run : what it did.
    drew : whether anything was drawn from the stream.
    scene_changed : whether the scene or the query was written to.
    before, after : the process around it.
    """

    scene: SmallScene
    budget: Budget
    seed: int
    run: Run
    drew: bool
    scene_changed: bool
    before: Surroundings
    after: Surroundings

    @property
    def label(self) -> str:
        """The run in words, for findings."""
        return run_in_words(self.scene, self.seed, self.budget)

    @property
    def refused(self) -> bool:
        """Whether it was refused with a reason."""
        return isinstance(self.run.refusal, str) and bool(self.run.refusal.strip())

    @cached_property
    def plan(self) -> Plan | None:
        """What was returned, in plain numbers, if it has the form of a plan."""
        return None if form_of(self.run.returned) else plain_plan(self.run.returned)

    @property
    def ends(self) -> bool:
        """Whether the path starts and ends where it should."""
        if self.plan is None or self.plan.path is None:
            return False
        query = asked(_pristine(self.scene))
        ends = np.asarray(self.plan.path, dtype=np.float64)[[0, -1]]
        return bool(np.array_equal(ends, np.array([query.start, query.goal])))

    @cached_property
    def verdict(self) -> Verdict | None:
        """The referee's, on a path that was called solved and has the right ends."""
        plan = self.plan
        if plan is None or plan.status != PlanStatus.SOLVED or not self.ends:
            return None
        return _referee(self.scene).judge(asked(_pristine(self.scene)), plan.path)

    @property
    def length(self) -> float | None:
        """Length of the path in metres, if the referee accepts it."""
        return None if self.verdict is None else self.verdict.length

    @property
    def outcome(self) -> tuple[Any, ...]:
        """All of the run that must be the same when it is repeated: everything but times."""
        plan = self.plan
        if plan is None:
            return (str(self.run.refusal), self.run.error)
        told = tuple((i.cost, i.generation, i.checks) for i in self.run.recorder.improvements)
        path = None if plan.path is None else np.asarray(plan.path, dtype=np.float64).tobytes()
        counts = (plan.generations, plan.checks, plan.computed_checks)
        return (str(plan.status), path, *counts, told)


class Subject:
    """A planner's class with settings, and the runs that the rules share.

    Parameters
    ----------
    planner_class : type[Planner]
    settings : planner_class.Settings, optional
        Default: the planner's own.
    on_run : callable, optional
        Told of each run before it begins.
    without : collection of str
        Names of small scenes that are left out, because a run there has ended the process.
    """

    def __init__(
        self,
        planner_class: type[Planner],
        settings: Any = None,
        on_run: Callable[[Running], None] = lambda _: None,
        without: Collection[str] = (),
    ) -> None:
        watch(planner_class)
        self.without = frozenset(without)
        self.missed: set[str] = set()
        self.is_blank = False
        self.planner_class = planner_class
        self.settings = settings
        self._on_run = on_run

    def build(self) -> Planner:
        """A new planner."""
        return self.planner_class(self.settings)

    @property
    def ordinary(self) -> Budget:
        """The budget of most runs: counted if the planner counts anything, so that it repeats."""
        budgets = self.planner_class.abilities.budgets
        if "generations" in budgets:
            return Budget(generations=GENERATIONS)
        if "checks" in budgets:
            return Budget(checks=CHECKS)
        if "wall_s" in budgets:
            return Budget(wall_s=WALL_S)
        return Budget(cpu_s=WALL_S) if "cpu_s" in budgets else Budget()

    @property
    def is_timed(self) -> bool:
        """Whether its runs end by the clock, so that no two of them need to be alike."""
        return self.ordinary.wall_s is not None or self.ordinary.cpu_s is not None

    @cached_property
    def warm_up(self) -> WarmUp:
        """The first one, of a new planner."""
        before, error = Surroundings.now(), None
        try:
            self.build().warm_up()
        except (Exception, SystemExit) as raised:  # other people's code: it may raise anything
            error = f"{type(raised).__name__}: {raised}"
        after = Surroundings.now()
        before.restore()
        return WarmUp(error, before, after)

    @property
    def trials(self) -> tuple[Trial, ...]:
        """An ordinary run on each small scene."""
        self.missed |= self.without & {scene.name for scene in small_scenes()}
        return self.ordinary_trials

    @cached_property
    def ordinary_trials(self) -> tuple[Trial, ...]:
        """The same, for rules whose answer does not rest on all of them."""
        return tuple(self.trial(s) for s in small_scenes() if s.name not in self.without)

    def on(self, *names: str) -> Sequence[SmallScene]:
        """Scenes of the kit by name, without those that are left out."""
        self.missed |= self.without & set(names)
        left = [s for s in small_scenes() if s.name in names and s.name not in self.without]
        self.is_blank |= bool(names) and not left
        return left

    def begin_rule(self) -> None:
        """Forget what earlier rules have missed.

        ``missed`` are the scenes that the rule asks for and does not get; ``is_blank`` says that
        one of its questions had no scene left.
        """
        self.missed, self.is_blank = set(), False

    def trial(
        self,
        scene: SmallScene,
        budget: Budget | None = None,
        seed: int = SEED,
        planner: Planner | None = None,
    ) -> Trial:
        """One run, by a new planner or by one that is given; kept by nobody."""
        budget, rng = budget or self.ordinary, np.random.default_rng([seed, 2003])
        given = _lent.get(scene.name) or _lent.setdefault(scene.name, scene.build())
        build = self.build if planner is None else lambda: planner
        query = asked(given)
        trial = self.watched(
            scene, budget, seed, rng, given, query, lambda: _run(build, given, budget, rng)
        )
        if trial.scene_changed:
            del _lent[scene.name]
        return trial

    def watched(
        self,
        scene: SmallScene,
        budget: Budget,
        seed: int,
        rng: np.random.Generator,
        given: Scene,
        query: Query,
        run: Callable[[], Run],
    ) -> Trial:
        """Do a run, and say what it did beside; what it changed is put back, but for the scene.

        Parameters
        ----------
        scene : SmallScene
            By which it is judged; ``given`` and ``query`` are what it takes.
        budget, seed, rng : what it takes, too.
        run : callable
            Does it.
        """
        label = run_in_words(scene, seed, budget)
        self._on_run(Running(scene.name, budget == self.ordinary, label))
        outer, stream = Surroundings.now(), str(rng.bit_generator.state)
        seed_globals(seed)
        before, drawn = Surroundings.now(), fingerprint(given, query)
        done = run()
        after, changed = Surroundings.now(), fingerprint(given, query) != drawn
        outer.restore()
        drew = str(rng.bit_generator.state) != stream
        return Trial(scene, budget, seed, done, drew, changed, before, after)


Rule = Callable[[Subject], Answer]
"""A function whose name and docstring are the name and the claim of the rule."""


def _run(
    build: Callable[[], Planner], scene: Scene, budget: Budget, rng: np.random.Generator
) -> Run:
    """Do what the harness does with a planner, and take whatever comes of it."""
    query, recorder = asked(scene), Recorder()
    try:
        planner = build()
        planner.warm_up()
        had = dict(vars(planner))
        reason = refusal(planner, scene, query, budget)
        prepared = tuple(k for k, v in vars(planner).items() if k not in had or v is not had[k])
        if reason is not None:
            return Run(recorder, refusal=reason, prepared=prepared)
        done = timed(lambda: planner.plan(scene, query, budget, rng, recorder), recorder)
        return replace(done, prepared=prepared)
    except (Exception, SystemExit):  # other people's code: it may raise anything
        return failed(recorder)


def timed(plan: Callable[[], Any], recorder: Recorder) -> Run:
    """Plan within the clock; whatever is raised passes."""
    with Clock(recorder) as clock:
        returned = plan()
    return Run(recorder, None, returned, None, clock.wall_s, clock.cpu_s, restarted=clock.restarted)


def failed(recorder: Recorder) -> Run:
    """The run that has just raised an exception."""
    lines = traceback.format_exc().strip().splitlines()[-TRACEBACK_LINES:]
    return Run(recorder, error="\n".join(lines))


def form_of(returned: Any) -> str | None:
    """What is wrong with the form of what ``plan`` returned; None if nothing is."""
    try:
        plan = plain_plan(returned)
    except ContractError as error:
        return str(error)
    return None if plan.path is None else flaw_of_path(plan.path)


def times(budget: Budget, factor: int) -> Budget:
    """So many times a budget."""
    return Budget(**{name: factor * limit for name, limit in _limits(budget).items()})


def _limits(budget: Budget) -> dict[str, Any]:
    """The limits that a budget sets, by name."""
    return {name: limit for name, limit in plain(budget).items() if limit is not None}


def optimum(scene: SmallScene) -> float:
    """Length of the shortest path, metres; infinite without a path."""
    given = _pristine(scene)
    return shortest_path(given, asked(given)).length


def run_in_words(scene: SmallScene, seed: int, budget: Budget) -> str:
    """What was run, for findings; the budget as an author would write it."""
    inner = ", ".join(f"{name}={value}" for name, value in _limits(budget).items())
    return f"on '{scene.name}' with seed {seed} and Budget({inner})"


@lru_cache(maxsize=32)
def _pristine(scene: SmallScene) -> Scene:
    """A scene that no planner has in its hands."""
    return scene.build()


@lru_cache(maxsize=32)
def _referee(scene: SmallScene) -> Referee:
    return Referee(_pristine(scene))
