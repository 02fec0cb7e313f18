"""OMPL's simplifier (Geraerts and Overmars 2007, and more) on a budget, with the exact check.

It cuts corners wherever the shortcut is free, and drops and merges vertices.
"""

import numpy as np
from ompl import base as ob
from ompl import geometric as og

from baselines.ompl.adapter import Problem
from baselines.ompl.collision import do_nothing

CHECKS_BETWEEN_LOOKS = 64
"""Checks after which a step of the simplifier looks at the clock: about 0.05 ms."""


class BudgetSpentError(Exception):
    """Ends the simplifier in the middle of a step."""


def simplify(problem: Problem) -> None:
    """Simplify the problem's solution until nothing changes or the budget is spent.

    The path is free after each check. Merely refused when the budget is spent, OMPL would take the
    path for a colliding one and move its waypoints at random to mend it: an exception ends it.
    """
    collision = problem.collision

    def look() -> None:
        if problem.is_over():
            raise BudgetSpentError
        collision.call_at(min(collision.checks + CHECKS_BETWEEN_LOOKS, collision.limit), look)

    solution = problem.definition.getSolutionPath()
    is_over = ob.PlannerTerminationCondition(problem.is_over)
    collision.call_at(collision.checks, look)
    try:
        og.PathSimplifier(problem.information).simplify(solution, is_over, False)
    except BudgetSpentError:
        pass
    finally:
        collision.call_at(np.inf, do_nothing)  # ``look`` would keep the problem alive
