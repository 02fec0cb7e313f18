"""Rules about replanners, for planners that have one of their own: one drive, seen from all sides.

Whoever plans afresh at each update is held to the rules about runs, and that is enough.
"""

from collections.abc import Iterable
from functools import wraps

from suite.conformance.drive import STEPS, drive, ordinary_drive
from suite.conformance.finding import Answer, Finding, NotApplicable, NotTested
from suite.conformance.rules_of.budgets import (
    ATTEMPTS,
    CHECKS,
    GENERATIONS,
    LATE_S,
    WALL_S,
    most_checks,
    timed_budget,
)
from suite.conformance.rules_of.repeatability import TIMED, difference
from suite.conformance.rules_of.runs import MORE
from suite.conformance.subject import Rule, Subject, Trial, form_of, times
from suite.conformance.surroundings import Surroundings
from suite.planner import Budget, Planner, PlanStatus

AFRESH = NotApplicable("it has no replanner of its own.")
UNTESTED = NotTested("a drive ends the process: mend that first.")
UNPLANNED = NotApplicable("not all updates end with a plan.")


def _for_replanners(rule: Rule) -> Rule:
    """A rule that says nothing of planners that plan afresh, or refuse to begin."""

    @wraps(rule)
    def applied(subject: Subject) -> Answer:
        if subject.planner_class.replanner is Planner.replanner:
            return AFRESH
        if subject.without & {step.small.name for step in STEPS}:
            return UNTESTED
        refused = _refused(subject)
        return NotApplicable(f"refused: {refused}") if refused else rule(subject)

    return applied


def _refused(subject: Subject) -> str | None:
    """Why a drive is not begun, in words; an exception is told by the rules about runs."""
    trial = subject.ordinary_trials[0]
    return str(trial.run.refusal) if trial.run.refusal is not None else trial.run.error


@_for_replanners
def replans_end_with_a_plan(subject: Subject) -> Answer:
    """A replanner raises no exception and returns a Plan, at the beginning and at each update."""
    for trial in ordinary_drive(subject):
        wrong = trial.run.error or form_of(trial.run.returned)
        if wrong is not None:
            return Finding(
                f"{trial.label}: {wrong}",
                "a Plan from begin and from each update, also where there is nothing to find",
                "Return what plan would return. An update may come after one without a path, with "
                "other obstacles than before, or with the same scene.",
            )
    return None


@_for_replanners
def replans_suit_what_is_known(subject: Subject) -> Answer:
    """It finds free paths from where the robot is; none where there is none; and then one again."""
    for trial in ordinary_drive(subject):
        wrong = _unsuitable(trial)
        if wrong is not None:
            return Finding(
                f"{trial.label}: {wrong}",
                "a path from query.start to query.goal that is free in the scene of this update",
                "Take start and obstacles from the update's own query and scene, and check there "
                "whatever is kept from earlier ones. Without a path: EXHAUSTED.",
            )
    return _lasting_failure(subject)


def _unsuitable(trial: Trial) -> str | None:
    plan = trial.plan
    if plan is None or plan.status == PlanStatus.EXHAUSTED:
        return None
    if plan.status == PlanStatus.INFEASIBLE:
        return "'infeasible', but a path exists" if trial.scene.has_path else None
    if not trial.ends:
        return "the path does not lead from where the robot is to the goal"
    return None if trial.verdict is None or trial.verdict.valid else trial.verdict.reason


def _lasting_failure(subject: Subject) -> Finding | None:
    """The update of an open room for which no path is found, whatever the budget."""
    lost = _without_a_path(ordinary_drive(subject))
    for factor in MORE if lost else ():
        lost = _without_a_path(drive(subject, times(subject.ordinary, factor)))
        if not lost:
            return None
    if not lost:
        return None
    return Finding(
        f"{lost[0].label}: no path was found",
        "a path: nothing is in the way any more",
        "Forget what was known to be closed when the scene is another one, and try the straight "
        "line.",
    )


def _without_a_path(trials: Iterable[Trial]) -> list[Trial]:
    return [
        trial
        for trial in trials
        if trial.scene.is_trivial and trial.plan and trial.plan.status != PlanStatus.SOLVED
    ]


@_for_replanners
def replans_keep_budgets(subject: Subject) -> Answer:
    """Each update keeps the budgets that the planner says it keeps, and counts from zero."""
    most = {"generations": GENERATIONS, "checks": most_checks(CHECKS)}
    limits = {"generations": GENERATIONS, "checks": CHECKS}
    for name in sorted(subject.planner_class.abilities.budgets & limits.keys()):
        for trial in drive(subject, Budget(**{name: limits[name]})):
            count = 0 if trial.plan is None else getattr(trial.plan, name)
            if count is None and trial.plan and trial.plan.status != PlanStatus.INFEASIBLE:
                return _unkept(trial, f"the plan does not say how many {name} it took", name)
            if (count or 0) > most[name]:
                return _unkept(trial, f"{count} {name}", name)
    clocks = sorted(subject.planner_class.abilities.budgets & {"wall_s", "cpu_s"})
    findings = (_late(subject, clock) for clock in clocks)
    return next((found for found in findings if found is not None), None)


def _late(subject: Subject, clock: str) -> Finding | None:
    """The update that takes too long in each of several drives: a machine may be busy."""
    for _ in range(ATTEMPTS):
        trials = drive(subject, timed_budget(clock))
        late = [trial for trial in trials if getattr(trial.run, clock) > WALL_S + LATE_S]
        if not late:
            return None
    return _unkept(late[0], f"it took {getattr(late[0].run, clock):.2f} s", clock)


def _unkept(trial: Trial, what: str, name: str) -> Finding:
    return Finding(
        f"{trial.label}: {what}",
        f"an update that keeps budget.{name} by itself, as a run does",
        f"Count from zero at each update, and end at budget.{name}: what earlier updates took is "
        "in their plans.",
    )


@_for_replanners
def replans_repeat(subject: Subject) -> Answer:
    """The same seed gives the same sequence, also when another replanner is asked in between."""
    if subject.is_timed and not subject.planner_class.abilities.deterministic:
        return TIMED
    first = ordinary_drive(subject)
    if any(trial.plan is None for trial in first):
        return UNPLANNED
    again = drive(subject, subject.ordinary)
    if (found := _difference(first, again, "two drives")) is not None:
        return found
    beside = drive(subject, subject.ordinary, beside=True)
    return _difference(first, beside, "drives with and without another replanner beside")


def _difference(one: Iterable[Trial], other: Iterable[Trial], which: str) -> Finding | None:
    for mine, yours in zip(one, other, strict=True):
        if mine.outcome != yours.outcome:
            return Finding(
                f"{mine.label}: {which} differ in {difference(mine.outcome, yours.outcome)}",
                "the same paths, counts and reports",
                "Draw from the `rng` that replanner is given, and keep what belongs to a drive in "
                "the object that replanner returns: not in the planner, its class or the module.",
            )
    return None


@_for_replanners
def replans_leave_things_alone(subject: Subject) -> Answer:
    """An update writes to no scene, and changes nothing of the process."""
    for trial in ordinary_drive(subject):
        changed = "the scene or the query" if trial.scene_changed else None
        changed = changed or _changed(trial.before, trial.after)
        if changed is not None or trial.run.restarted:
            return Finding(
                f"{trial.label}: {changed or 'the clock'} was changed",
                "scenes, working directory, environment, global generators and clock as they were",
                "Copy what you change, and draw from the `rng` that replanner is given.",
            )
    return None


def _changed(before: Surroundings, after: Surroundings) -> str | None:
    if before.folder != after.folder:
        return "the working directory"
    names = [*before.changed_generators(after), *before.changed_variables(after)]
    return names[0] if names else None
