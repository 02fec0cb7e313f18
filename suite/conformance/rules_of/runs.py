"""Rules about what a run returns and reports, looked at in an ordinary run on each small scene."""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from suite.conformance.finding import Answer, Finding, NotApplicable
from suite.conformance.subject import Subject, Trial, form_of, optimum, times
from suite.errors import ContractError
from suite.geometry.tolerances import COST_CLAIM_RELATIVE
from suite.planner import Improvement, PlanStatus
from suite.referee.claims import improvements, trace

MORE = (10, 100)
"""Times an ordinary budget, for planners whose generations or checks do little."""


def warms_up(subject: Subject) -> Answer:
    """A planner can be built, and its warm_up ends and raises nothing."""
    error = subject.warm_up.error
    if error is None:
        return None
    return Finding(
        error,
        "a planner that is built from its settings, and a warm_up that returns",
        "warm_up takes nothing: plan in a tiny scene of your own there, or leave it out.",
    )


def runs_end_without_an_exception(subject: Subject) -> Answer:
    """A run ends, and raises no exception, whatever the scene."""

    def judge(trial: Trial) -> Finding | None:
        if trial.run.error is None:
            return None
        return Finding(
            f"{trial.label}: {trial.run.error}",
            "a Plan, also where there is nothing to find",
            "Handle that scene, or refuse it: `refuse` returns a sentence that says why.",
        )

    return _first(subject, judge)


def refuses_with_a_reason(subject: Subject) -> Answer:
    """What refuse returns is None, or a sentence."""

    def judge(trial: Trial) -> Finding | None:
        said = trial.run.refusal
        if said is None or trial.refused:
            return None
        return Finding(
            f"{trial.label}: refuse returned {said!r}",
            "None if it can, else a sentence that says why it can't",
            "Return the reason as text: it stands in the row, for people to read.",
        )

    return _first(subject, judge)


def refuse_prepares_nothing(subject: Subject) -> Answer:
    """What refuse finds out is not kept for plan: it is called outside the clock."""

    def judge(trial: Trial) -> Finding | None:
        if not trial.run.prepared:
            return None
        return Finding(
            f"{trial.label}: refuse set {', '.join(f'self.{name}' for name in trial.run.prepared)}",
            "a planner that is the same after refuse as before",
            "Do in plan what takes time and is needed there, even if refuse has done it already.",
        )

    return _first(subject, judge)


def returns_a_plan(subject: Subject) -> Answer:
    """A run returns a Plan that says solved with a path, infeasible or exhausted."""

    def judge(trial: Trial) -> Finding | None:
        wrong = None if _has_not_run(trial) else form_of(trial.run.returned)
        if wrong is None:
            return None
        return Finding(
            f"{trial.label}: {wrong}",
            "a Plan: SOLVED with a path (n, 2) of finite numbers, INFEASIBLE or EXHAUSTED, with "
            "numbers or None in its other fields",
            "Return Plan(PlanStatus.SOLVED, path), or Plan(PlanStatus.EXHAUSTED) without a path.",
        )

    return _first(subject, judge)


def path_has_the_right_ends(subject: Subject) -> Answer:
    """A path leads from exactly the start to exactly the goal."""

    def judge(trial: Trial) -> Finding | None:
        plan = trial.plan
        if plan is None or plan.path is None or plan.status != PlanStatus.SOLVED or trial.ends:
            return None
        first, last = np.asarray(plan.path, dtype=np.float64)[[0, -1]].tolist()
        return Finding(
            f"{trial.label}: a path from {tuple(first)} to {tuple(last)}",
            "query.start as its first row and query.goal as its last, to the last bit",
            "Put query.start and query.goal themselves into the path, not what a grid made of "
            "them, nor those of scene.query(); list the path from the start on.",
        )

    return _first(subject, judge)


def path_is_free(subject: Subject) -> Answer:
    """The referee accepts each path where there is one."""

    def judge(trial: Trial) -> Finding | None:
        if not trial.scene.has_path or trial.verdict is None or trial.verdict.valid:
            return None
        return Finding(
            f"{trial.label}: {trial.verdict.reason}",
            "a path that touches obstacles at most",
            "Check it with suite.geometry.kernels.first_collision(path, scene.arrays), which means "
            "by free what the referee means; the whole path, for segment by segment no bend is "
            "seen that slips through a point in which two obstacles touch.",
        )

    return _first(subject, judge)


def solves_what_is_trivial(subject: Subject) -> Answer:
    """It finds a path where the straight line is one."""

    def judge(trial: Trial) -> Finding | None:
        if not trial.scene.is_trivial or not _is_without_a_path(trial):
            return None
        for factor in MORE:  # what one planner calls a generation is another's single sample
            more = subject.trial(trial.scene, times(subject.ordinary, factor))
            if not _is_without_a_path(more):
                return None
        what = f"refused: {trial.run.refusal}" if trial.refused else "no path was found"
        return Finding(
            f"{trial.label}: {what}, nor with {MORE[-1]} times the budget",
            "a path: nothing is in the way, and the budget is one that it says it keeps",
            "Try the straight line first; or keep fewer budgets in `abilities`.",
        )

    return _first(subject, judge)


def _is_without_a_path(trial: Trial) -> bool:
    return trial.refused or (trial.plan is not None and trial.plan.status == PlanStatus.EXHAUSTED)


def says_that_there_is_no_path(subject: Subject) -> Answer:
    """Where there is no path, it says infeasible or exhausted."""

    def judge(trial: Trial) -> Finding | None:
        plan = trial.plan
        if trial.scene.has_path or plan is None or plan.status != PlanStatus.SOLVED:
            return None
        if trial.verdict is None:  # wrong ends: another rule says it
            return None
        return Finding(
            f"{trial.label}: 'solved', but {trial.verdict.reason}",
            "INFEASIBLE, or EXHAUSTED if it can't know",
            "Call SOLVED only a path that you have checked whole; the line between obstacles that "
            "share an edge is closed.",
        )

    return _first(subject, judge)


def infeasible_is_true(subject: Subject) -> Answer:
    """It says infeasible only where there is no path."""

    def judge(trial: Trial) -> Finding | None:
        plan = trial.plan
        if plan is None or plan.status != PlanStatus.INFEASIBLE or not trial.scene.has_path:
            return None
        return Finding(
            f"{trial.label}: 'infeasible', but a path of {optimum(trial.scene):.4g} m exists",
            "EXHAUSTED where the search ended without a path",
            "INFEASIBLE is a proof. A planner that has only not found a path is EXHAUSTED.",
        )

    return _first(subject, judge)


def exact_is_exact(subject: Subject) -> Answer:
    """A planner that is called exact finds the shortest path, or the proof that there is none."""
    if not subject.planner_class.abilities.exact:
        return NotApplicable("it is not called exact.")

    return _first(subject, _finding_of_exactness)


def _finding_of_exactness(trial: Trial) -> Finding | None:
    if trial.plan is None or trial.plan.status == PlanStatus.INFEASIBLE:
        return None
    best, length = optimum(trial.scene), trial.length
    if trial.plan.status == PlanStatus.SOLVED and length is None:
        return None  # not a path at all: another rule says it
    if length is not None and length <= best + _allowed(best):
        return None
    return Finding(
        f"{trial.label}: {'no path' if length is None else f'{length:.9g} m'}",
        f"a path of {best:.9g} m" if trial.scene.has_path else "INFEASIBLE",
        "Leave `exact` out of abilities, or mend the search.",
    )


def improvements_agree_with_the_result(subject: Subject) -> Answer:
    """What it reports while it runs gets better, and the last of it is what it returns."""
    return _first(subject, _finding_of_reports)


def _finding_of_reports(trial: Trial) -> Finding | None:
    wrong = None if _has_not_run(trial) or trial.run.restarted else _wrong_report(trial)
    if wrong is None:
        return None
    return Finding(
        f"{trial.label}: {wrong}",
        "costs in metres of feasible paths, each with its generation and checks so far; the path "
        "returned is the best reported",
        "Call recorder.improved(length) when, and only when, a feasible path is a new best, and "
        "return that path; generation_of_best is the generation that was reported with it.",
    )


def _wrong_report(trial: Trial) -> str | None:
    try:
        trace(trial.run.recorder)
        reports = improvements(trial.run.recorder, trial.run.wall_s)
    except ContractError as error:
        return str(error)
    return _falling_counts(reports) or _disagreement(trial, reports)


def _falling_counts(reports: Sequence[Improvement]) -> str | None:
    for name in ("generation", "checks"):
        counts = [c for r in reports if (c := getattr(r, name)) is not None]
        for before, after in pairwise(counts):
            if after < before:
                return f"{name} falls from {before} to {after} between two reports"
    return None


def _disagreement(trial: Trial, reports: Sequence[Improvement]) -> str | None:
    """What is wrong with reports beside the plan."""
    if not reports or trial.plan is None:
        return None
    last, length = reports[-1].cost, trial.length
    if trial.plan.status != PlanStatus.SOLVED:
        return f"{last:.9g} m were reported, and the run ends as '{trial.plan.status}'"
    if length is not None and abs(last - length) > _allowed(length):
        return f"the best reported cost is {last:.9g} m, and the returned path has {length:.9g} m"
    told, best = reports[-1].generation, trial.plan.generation_of_best
    if told is not None and best is not None and told != best:
        return f"the best was reported in generation {told}, and generation_of_best is {best}"
    return None


def anytime_reports(subject: Subject) -> Answer:
    """A planner that is called anytime reports the paths that it finds."""
    if not subject.planner_class.abilities.anytime:
        return NotApplicable("it is not called anytime.")

    def judge(trial: Trial) -> Finding | None:
        if trial.length is None or trial.run.recorder.improvements:
            return None
        return Finding(
            f"{trial.label}: solved, and nothing was reported",
            "at least one call of recorder.improved",
            "Report each better path with recorder.improved(cost), or leave `anytime` out.",
        )

    return _first(subject, judge)


def claimed_cost_is_the_length(subject: Subject) -> Answer:
    """The cost that it claims is the length that the referee measures (a warning)."""

    def judge(trial: Trial) -> Finding | None:
        claim = None if trial.plan is None else trial.plan.claimed_cost
        length = trial.length
        if claim is None or length is None or abs(claim - length) <= _allowed(length):
            return None
        return Finding(
            f"{trial.label}: claimed {claim:.9g} m, measured {length:.9g} m",
            "the length of the path, or None",
            "Tables show the referee's length; if yours is another measure, leave claimed_cost "
            "out and put it into `details`.",
        )

    return _first(subject, judge)


def _has_not_run(trial: Trial) -> bool:
    return trial.run.error is not None or trial.run.refusal is not None


def _allowed(length: float) -> float:
    """By how much two figures of one length may differ, metres."""
    return COST_CLAIM_RELATIVE * max(length, 1.0)


def _first(subject: Subject, judge: Callable[[Trial], Finding | None]) -> Finding | None:
    """The first finding in the ordinary runs."""
    findings = (judge(trial) for trial in subject.trials)
    return next((found for found in findings if found is not None), None)
