"""What a planner says of its run, as plain numbers: whatever it hands over, a store can hold them.

Counts come as numpy's integers, measures as float32 or NaN, and some lists are written to behind
the recorder's back. None of it may stop a matrix, or spoil the tables of the others.
"""

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise
from numbers import Integral
from typing import Any

from suite.errors import ContractError
from suite.planner import LARGEST_COUNT, Improvement, Plan, PlanStatus, Recorder


def plain_plan(returned: Any) -> Plan:
    """What ``plan`` returned, in plain numbers; its path is as it was, for the referee to judge.

    Raises
    ------
    ContractError
        If it is no Plan, claims what it may not, is solved without a path, or holds what is no
        number where there should be one.
    """
    if not isinstance(returned, Plan):
        raise ContractError(f"plan returned {type(returned).__name__}. It must return a Plan.")
    if returned.status not in PlanStatus.CLAIMABLE:
        allowed = ", ".join(PlanStatus.CLAIMABLE)
        raise ContractError(
            f"plan returned the status {returned.status!r}. It may claim {allowed}."
        )
    if returned.status == PlanStatus.SOLVED and returned.path is None:
        raise ContractError("plan says 'solved' and returns no path.")
    checks, computed_checks = as_checks(returned)
    claim = returned.claimed_cost
    return Plan(
        PlanStatus(returned.status),
        returned.path,
        None if claim is None else float(as_measure(claim, "claimed_cost of the plan")),
        as_count(returned.generations, "generations of the plan"),
        as_count(returned.generation_of_best, "generation_of_best of the plan"),
        checks,
        _as_details(returned.details),
        computed_checks,
        _as_reason(returned),
    )


def _as_reason(returned: Plan) -> str | None:
    """Why there is no path; with a path there is nothing to explain."""
    reason = returned.reason
    if reason is not None and not isinstance(reason, str):
        raise ContractError(
            f"the reason of the plan is a {type(reason).__name__}. It must be a sentence, or None."
        )
    return None if returned.status == PlanStatus.SOLVED else reason


def _as_details(details: Any) -> dict[str, float]:
    if not isinstance(details, Mapping):
        raise ContractError(
            f"details of the plan are a {type(details).__name__}. They must be a mapping from "
            "names to numbers."
        )
    return {
        str(name): float(as_measure(value, f"the detail {str(name)!r} of the plan"))
        for name, value in details.items()
    }


def as_count(value: Any, name: str) -> int | None:
    """A count of generations or checks; None stays None.

    Raises
    ------
    ContractError
        If it is not a whole number, 0 or more.

    Examples
    --------
    >>> import numpy as np
    >>> as_count(np.int64(7), "checks")
    7
    """
    if value is None:
        return None
    try:
        count = int(value)
    except (TypeError, ValueError, OverflowError):
        count = -1
    if not 0 <= count <= LARGEST_COUNT or isinstance(value, str):
        raise ContractError(f"{name} is {value!r}. It must be a whole number, 0 or more, or None.")
    return count


def as_checks(plan: Plan) -> tuple[int | None, int | None]:
    """The checks of a plan that were asked, and those of them that were computed.

    Raises
    ------
    ContractError
        If one is no count, or more were computed than asked.

    Examples
    --------
    >>> from suite.planner import PlanStatus
    >>> as_checks(Plan(PlanStatus.EXHAUSTED, checks=500, computed_checks=120))
    (500, 120)
    """
    asked = as_count(plan.checks, "checks of the plan")
    computed = as_count(plan.computed_checks, "computed_checks of the plan")
    if computed is not None and (asked is None or computed > asked):
        raise ContractError(
            f"computed_checks of the plan are {computed}, and its checks {asked}. What is computed "
            "was asked: give both, computed_checks no more than checks."
        )
    return asked, computed


def as_measure(value: Any, name: str) -> float:
    """A number as Python's own; a whole one stays whole.

    Raises
    ------
    ContractError
        If it is none.
    """
    try:
        if isinstance(value, str | bytes):
            raise TypeError  # float would read it
        return int(value) if isinstance(value, Integral) else float(value)
    except (TypeError, ValueError, OverflowError) as error:
        raise ContractError(f"{name} is {value!r}. It must be a number.") from error


def improvements(recorder: Recorder, wall_s: float) -> tuple[Improvement, ...]:
    """The reported improvements of a run that took so long, in plain numbers.

    Raises
    ------
    ContractError
        If any is no improvement, or their costs or times are out of order.
    """
    reports = tuple(_plain(report) for report in recorder.improvements)
    wrong = disorder(reports, wall_s)
    if wrong is not None:
        raise ContractError(
            f"reported improvements: {wrong}. Call recorder.improved, which stamps."
        )
    return reports


def disorder(reports: Sequence[Improvement], wall_s: float) -> str | None:
    """What is wrong with the costs and times of improvements; None if nothing is.

    The recorder lets pass only costs that fall, and stamps them; a planner can go round it.
    """
    for report in reports:
        if not (math.isfinite(report.cost) and report.cost >= 0.0):
            return f"a cost of {report.cost} m"
        if not 0.0 <= report.wall_s <= wall_s:
            return f"a time of {report.wall_s:.6g} s in a run of {wall_s:.6g} s"
    for before, after in pairwise(reports):
        if after.cost >= before.cost:
            return f"{after.cost:.9g} m after {before.cost:.9g} m"
        if after.wall_s < before.wall_s or after.cpu_s < before.cpu_s:
            return f"a time of {after.wall_s:.6g} s after one of {before.wall_s:.6g} s"
    return None


def trace(recorder: Recorder) -> tuple[dict[str, float], ...]:
    """The described generations in plain numbers.

    Raises
    ------
    ContractError
        If a measure is no number.
    """
    return tuple(
        {str(name): as_measure(value, f"the measure {name!r}") for name, value in row.items()}
        for row in recorder.trace
    )


def _plain(report: Any) -> Improvement:
    if not isinstance(report, Improvement):
        raise ContractError(f"recorder.improvements holds a {type(report).__name__}.")
    return Improvement(
        float(as_measure(report.wall_s, "wall_s of an improvement")),
        float(as_measure(report.cpu_s, "cpu_s of an improvement")),
        float(as_measure(report.cost, "cost of an improvement")),
        as_count(report.generation, "generation of an improvement"),
        as_count(report.checks, "checks of an improvement"),
    )
