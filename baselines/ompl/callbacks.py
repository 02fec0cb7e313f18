"""What OMPL's way into Python and back costs, which no clock in Python sees."""

from functools import cache
from time import perf_counter_ns
from typing import Any

from ompl import base as ob
from ompl import geometric as og

QUESTIONS = 2000
ROUNDS = 7


class _Empty(ob.MotionValidator):  # type: ignore[misc]
    def checkMotion(self, a: Any, b: Any) -> bool:  # noqa: ARG002, N802 (OMPL's name)
        return True


@cache
def way_s() -> float:
    """How long OMPL's way into an empty method in Python and back takes: 0.15 to 0.2 us.

    OMPL goes through the motions of a path of two thousand, seven times; the quickest counts. It
    is measured once for each process and its children.

    Returns
    -------
    float
        Seconds for each question.
    """
    space = ob.RealVectorStateSpace(2)
    bounds = ob.RealVectorBounds(2)
    bounds.setLow(0.0)
    bounds.setHigh(1.0)
    space.setBounds(bounds)
    information = ob.SpaceInformation(space)
    empty = _Empty(information)
    information.setMotionValidator(empty)
    information.setStateValidityChecker(lambda _: True)
    information.setup()
    state = space.allocState()
    state[0] = state[1] = 0.5
    path = og.PathGeometric(information, [state] * (QUESTIONS + 1))
    taken = []
    for _ in range(ROUNDS):
        began = perf_counter_ns()
        path.check()
        taken.append(perf_counter_ns() - began)
    return 1e-9 * min(taken) / QUESTIONS
