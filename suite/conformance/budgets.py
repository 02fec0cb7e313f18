"""Rules about budgets: each that a planner says it keeps is kept; without one, a run ends too."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from suite.conformance.finding import Finding, NotApplicable
from suite.conformance.subject import Subject, Trial
from suite.planner import Budget, PlanStatus

Outcome = Finding | NotApplicable | None

HARD = ("one wall", "enclosed goal", "500 obstacles")
"""Scenes in which a search goes on as long as it may: nothing, or always more, is to be found."""

GENERATIONS = 3
CHECKS = 300
CHECKS_IN_HAND = 10_000
"""What a planner may need to end what it has begun: a generation of a population, one batch."""

WALL_S = 0.1
LATE_S = 0.5
ROOMY = 10**6
ROOMY_S = 2.0
"""Other budgets, which end no run. A run of a matrix may have several: it ends with the first."""

ATTEMPTS = 3
"""A machine may be busy: a planner is late if it is so each time."""


def keeps_wall_time(subject: Subject) -> Outcome:
    """A run ends when its wall time is over, if it says that it keeps wall_s."""
    if "wall_s" not in subject.planner_class.abilities.budgets:
        return NotApplicable("wall_s is not among the budgets that it keeps.")
    counted = subject.planner_class.abilities.budgets & {"generations", "checks"}
    for scene, others in zip(
        subject.on(*HARD), ({}, {}, dict.fromkeys(counted, ROOMY)), strict=True
    ):
        budget = Budget(wall_s=WALL_S, **others)
        late = [subject.trial(scene, budget)]
        while late[-1].run.wall_s > WALL_S + LATE_S and len(late) < ATTEMPTS:
            late.append(subject.trial(scene, budget))
        best = min(late, key=lambda trial: trial.run.wall_s)
        if best.run.wall_s > WALL_S + LATE_S:
            return Finding(
                f"{best.label}: it took {best.run.wall_s:.2f} s, the quickest of {ATTEMPTS} runs",
                f"about {WALL_S} s, and {WALL_S + LATE_S} s at the very most",
                "Ask recorder.wall_s() in the innermost loop that lasts, and end when it reaches "
                "budget.wall_s; or leave wall_s out of abilities.budgets.",
            )
    return None


def keeps_generations(subject: Subject) -> Outcome:
    """A run ends after its generations, and counts them, if it says that it keeps them."""
    return _counted(subject, "generations", GENERATIONS, GENERATIONS)


def keeps_checks(subject: Subject) -> Outcome:
    """A run ends soon after its collision checks, and counts them, if it says that it keeps them.

    It may end what it has begun, such as a generation.
    """
    return _counted(subject, "checks", CHECKS, CHECKS + CHECKS_IN_HAND)


def _counted(subject: Subject, name: str, limit: int, most: int) -> Outcome:
    if name not in subject.planner_class.abilities.budgets:
        return NotApplicable(f"{name} is not among the budgets that it keeps.")
    roomy: dict[str, Any] = (
        {"wall_s": ROOMY_S} if "wall_s" in subject.planner_class.abilities.budgets else {}
    )
    for scene, others in zip(subject.on(*HARD), ({}, {}, roomy), strict=True):
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


def ends_or_refuses_whatever_the_budget(subject: Subject) -> Outcome:
    """Without a budget, or with one that it keeps only in part, a run ends or is refused."""
    others = [Budget(generations=1, checks=1), Budget(1.0, generations=1, checks=1)]
    # Where an ordinary run raises something, another rule says it.
    good = {trial.scene.name for trial in subject.trials if trial.run.error is None}
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
