"""Which planners came out the same each time: their runs are one run, however often it was made.

Rows do not hold what a planner says of itself, so it is read off them. A planner that draws nothing
gives the same path and asks for the same checks whatever the seed; one that draws may find the same
path again, but hardly by the same number of checks, in every scene and every run.
"""

import pandas as pd

from suite.report.rows import feasible

OUTCOME = [
    "status", "cost", "claimed_cost", "clearance", "segments", "turning", "generations",
    "generation_of_best", "checks",
]  # fmt: skip
"""What is the same, bit for bit: all of an outcome that no clock has a part in."""


def deterministic(runs: pd.DataFrame) -> frozenset[str]:
    """The variants of which all runs of each place came out the same.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it, with ``place``.

    Returns
    -------
    frozenset of str
        None that was run but once everywhere, or that never found a path: nothing tells then.
    """
    solved = set(feasible(runs)["variant"])
    place = [runs["variant"], runs["place"]]
    # A number that is missing is the same as one that is missing.
    outcomes = runs[OUTCOME].astype("object").where(runs[OUTCOME].notna(), None)
    codes = pd.Series(pd.factorize(pd.Series(map(tuple, outcomes.to_numpy())))[0], runs.index)
    different = codes.groupby(place).nunique().groupby(level=0).max()
    repeated = codes.groupby(place).size().groupby(level=0).max()
    same = different.index[(different == 1) & (repeated > 1)]
    return frozenset(str(name) for name in same if name in solved)
