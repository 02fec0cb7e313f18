"""OMPL's simplifiers (Geraerts and Overmars 2007, and more) on a budget, with the exact check.

They cut corners wherever the shortcut is free, and drop and merge vertices.
"""

from collections.abc import Iterator
from contextlib import contextmanager

from ompl import geometric as og

from baselines.ompl.adapter import Problem


class BudgetSpentError(Exception):
    """Ends the simplifier in the middle of a step."""


@contextmanager
def ended_by_exception(problem: Problem) -> Iterator[None]:
    """End what is in the block by BudgetSpentError as soon as the budget is spent.

    Merely refused, OMPL would take the path for a colliding one and move its waypoints at random
    to mend it.
    """

    def end() -> None:
        raise BudgetSpentError

    before, problem.collision.end = problem.collision.end, end
    try:
        yield
    finally:
        problem.collision.end = before


def simplify(problem: Problem) -> None:
    """Simplify the problem's solution until nothing changes or the budget is spent.

    The path is free after each check.
    """
    if problem.is_over():
        return
    solution = problem.definition.getSolutionPath()
    condition = problem.until_over()
    try:
        with ended_by_exception(problem):
            og.PathSimplifier(problem.information).simplify(solution, condition, False)
    except BudgetSpentError:
        pass
