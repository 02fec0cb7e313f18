"""Rules about budgets: each that a planner says it keeps is kept; without one, a run ends too."""

from collections.abc import Iterator
from math import ceil
from typing import Any

import numpy as np

from suite.conformance.finding import Answer, Finding, NotApplicable
from suite.conformance.subject import Subject, Trial
from suite.planner import Budget, PlanStatus

HARD = ("one wall", "enclosed goal", "500 obstacles")
"""Scenes in which a search goes on as long as it may: nothing, or always more, is to be found."""

GENERATIONS = 3
CHECKS = 300
SHARE_IN_HAND = 0.02
"""Of a budget of checks: what a planner may need to end what it has begun. More would make its
budget another one than that of the planners beside it."""

WALL_S = 0.1
LATE_S = 0.5
"""Of either clock. An innermost loop may be long, and a look at the clock is not for nothing."""
ROOMY = 10**6
ROOMY_S = 2.0
"""Other budgets, which end no run. A run of a matrix may have several: it ends with the first."""

ATTEMPTS = 3
"""A machine may be busy: a planner is late if it is so each time."""


def most_checks(budget: int) -> int:
    """Checks that a run may have asked when it ends at a budget of so many.

    Examples
    --------
    >>> most_checks(300), most_checks(10)
    (306, 11)
    """
    return ceil((1.0 + SHARE_IN_HAND) * budget)


def keeps_wall_time(subject: Subject) -> Answer:
    """A run ends when its wall time is over, if it says that it keeps wall_s."""
    return _timed(subject, "wall_s")


def keeps_cpu_time(subject: Subject) -> Answer:
    """A run ends when its CPU time is over, if it says that it keeps cpu_s."""
    return _timed(subject, "cpu_s")


def _timed(subject: Subject, clock: str) -> Answer:
    if clock not in subject.planner_class.abilities.budgets:
        return NotApplicable(f"{clock} is not among the budgets that it keeps.")
    counted = subject.planner_class.abilities.budgets & {"generations", "checks"}
    others = {HARD[-1]: dict.fromkeys(counted, ROOMY)}
    for scene in subject.on(*HARD):
        budget = timed_budget(clock, **others.get(scene.name, {}))
        trial = subject.trial(scene, budget)
        took = [_took(trial, clock)]
        while took[-1] > WALL_S + LATE_S and len(took) < ATTEMPTS:
            took.append(_took(subject.trial(scene, budget), clock))
        if min(took) > WALL_S + LATE_S:
            what = f"it took {min(took):.2f} s, the quickest of {ATTEMPTS} runs"
            return _late(trial, clock, what)
    return None


def timed_budget(clock: str, **others: int) -> Budget:
    """A budget of WALL_S of one of the clocks ``wall_s`` and ``cpu_s``, and of what is given."""
    limits: dict[str, Any] = {clock: WALL_S, **others}
    return Budget(**limits)


def _took(trial: Trial, clock: str) -> float:
    return float(getattr(trial.run, clock))


def _late(trial: Trial, clock: str, what: str) -> Finding:
    kind = {"wall_s": "wall time", "cpu_s": "CPU time"}[clock]
    return Finding(
        f"{trial.label}: {what}",
        f"about {WALL_S} s of {kind}, and {WALL_S + LATE_S} s at the very most",
        f"Ask recorder.{clock}() in the innermost loop that lasts, and end when it reaches "
        f"budget.{clock}; or leave {clock} out of abilities.budgets.",
    )


def keeps_generations(subject: Subject) -> Answer:
    """A run ends after its generations, and counts them, if it says that it keeps them."""
    return _counted(subject, "generations", GENERATIONS, GENERATIONS)


def keeps_checks(subject: Subject) -> Answer:
    """A run ends after its collision checks, within 2 %, if it says that it keeps them.

    Checks are questions asked: one that is answered from memory counts too.
    """
    return _counted(subject, "checks", CHECKS, most_checks(CHECKS))


def _counted(subject: Subject, name: str, limit: int, most: int) -> Answer:
    if name not in subject.planner_class.abilities.budgets:
        return NotApplicable(f"{name} is not among the budgets that it keeps.")
    roomy: dict[str, Any] = (
        {"wall_s": ROOMY_S} if "wall_s" in subject.planner_class.abilities.budgets else {}
    )
    for scene in subject.on(*HARD):
        others = roomy if scene.name == HARD[-1] else {}
        trial = subject.trial(scene, Budget(**{name: limit}, **others))
        if trial.refused:
            return _uncounted(trial, name, f"refused: {trial.run.refusal}", most)
        if trial.plan is None:
            continue
        count = getattr(trial.plan, name)
        if count is None and trial.plan.status != PlanStatus.INFEASIBLE:
            return _uncounted(trial, name, f"the plan does not say how many {name} it took", most)
        counts = [count or 0, *_reported(trial, name)]
        if max(counts) > most:
            return _uncounted(trial, name, f"{max(counts)} {name}", most)
    return None


def _reported(trial: Trial, name: str) -> Iterator[Any]:
    field = {"generations": "generation"}.get(name, name)
    reports: list[Any] = [getattr(report, field) for report in trial.run.recorder.improvements]
    return (count for count in reports if isinstance(count, int | np.integer))


def _uncounted(trial: Trial, name: str, what: str, most: int) -> Finding:
    return Finding(
        f"{trial.label}: {what}",
        f"at most {most} {name}, told in Plan({name}=...)",
        f"Count {name} and end at budget.{name}; or leave {name} out of abilities.budgets.",
    )


def ends_or_refuses_whatever_the_budget(subject: Subject) -> Answer:
    """Without a budget, or with one that it keeps only in part, a run ends or is refused."""
    others = [Budget(generations=1, checks=1), Budget(1.0, generations=1, checks=1)]
    # Where an ordinary run raises something, another rule says it.
    good = {trial.scene.name for trial in subject.ordinary_trials if trial.run.error is None}
    for budget in (Budget(), *others):
        for scene in subject.on(*good & {"one wall", "enclosed goal"}):
            trial = subject.trial(scene, budget)
            if trial.run.error is not None:
                return Finding(
                    f"{trial.label}: {trial.run.error}",
                    "a run that ends, or a refusal with a reason",
                    "Give the planner a stop criterion of its own, or let `refuse` return a "
                    "sentence for budgets that it can't work with.",
                )
    return None
