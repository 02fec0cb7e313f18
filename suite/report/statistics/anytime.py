"""Runs as step functions: cost of the best path over wall time, CPU time, generations or checks.

What a planner reports while it runs is its claim: the referee measures the last path only. So a
run that ended without an accepted path has no steps, no step is below the cost that the referee
measured, and a run that ended with a better path than it had reported has a last step at its end.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from suite.report.rows import feasible, places
from suite.report.statistics.clock import WALL, by_the_clock
from suite.report.statistics.inference import Array
from suite.store.gap import ROUNDING, gaps

CLOCKS = {"wall_s": "wall_s", "cpu_s": "cpu_s", "generation": "generations", "checks": "checks"}
"""Clocks of the events, and the columns of the runs that hold what they show at the end."""


@dataclass(frozen=True, slots=True, eq=False)
class Steps:
    """The runs of a store as step functions.

    runs : DataFrame of r rows, as :func:`suite.store.read.read_runs` gives it, numbered from 0, and
        ``place``: the scene, and the query if there are several.
    optimum : (r,) float64, metres; nan if there is none.
    run : (s,) int64, number of the run of each step, rising.
    cost : (s,) float64, metres, not rising within a run.
    clocks : from the name of a clock to (s,) float64, when each step was taken; nan if not counted.
    """

    runs: pd.DataFrame
    optimum: Array
    run: NDArray[np.int64]
    cost: Array
    clocks: Mapping[str, Array]


def steps_of(runs: pd.DataFrame, events: pd.DataFrame) -> Steps:
    """Make step functions of runs and of the improvements that their planners reported.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    events : DataFrame
        As :func:`suite.store.read.read_events` gives it; those of other runs are left out.

    Returns
    -------
    Steps
    """
    runs = runs.reset_index(drop=True).assign(place=places(runs).to_numpy())
    accepted = feasible(runs)
    numbers = pd.Series(accepted.index, index=accepted["key"])
    run = events["key"].map(numbers)
    reported = events.assign(run=run)[run.notna().to_numpy()]
    reported = reported.astype({"run": "int64"}).sort_values(["run", "number"], kind="stable")
    cost = runs["cost"].to_numpy()
    reported["cost"] = np.maximum(reported["cost"].to_numpy(), cost[reported["run"]])
    # Counts that nobody made are missing in several ways.
    parts = [
        part[["run", "cost", *CLOCKS]].astype("float64")
        for part in (reported, _ends(accepted, reported))
    ]
    joined = pd.concat(parts).sort_values("run", kind="stable")
    return Steps(
        runs,
        _optimum(runs),
        joined["run"].to_numpy().astype(np.int64),
        joined["cost"].to_numpy(),
        {clock: joined[clock].to_numpy() for clock in CLOCKS},
    )


def only(steps: Steps, wanted: NDArray[np.bool_]) -> Steps:
    """Some of the runs, numbered anew.

    Parameters
    ----------
    steps : Steps
    wanted : (r,) bool
    """
    number = np.cumsum(wanted) - 1
    kept = wanted[steps.run]
    return Steps(
        steps.runs[wanted].reset_index(drop=True),
        steps.optimum[wanted],
        number[steps.run[kept]],
        steps.cost[kept],
        {clock: shown[kept] for clock, shown in steps.clocks.items()},
    )


def on_clock(steps: Steps, clock: str) -> Steps:
    """The runs that can be compared on a clock; see :mod:`suite.report.statistics.clock`.

    Parameters
    ----------
    steps : Steps
    clock : str
        Of :data:`CLOCKS`.
    """
    return only(steps, by_the_clock(steps.runs)) if clock == WALL else steps


def cost_at(steps: Steps, clock: str, value: float) -> Array:
    """Cost of each run's best path when a clock shows a value.

    Parameters
    ----------
    steps : Steps
    clock : str
        Of :data:`CLOCKS`.
    value : float
        Seconds, or a number of generations or checks.

    Returns
    -------
    (r,) float64, metres
        Infinite where there is no path yet, nan where the run did not count. A run that ended
        before keeps its last cost.
    """
    shown = steps.clocks[clock]
    taken = np.flatnonzero(shown <= value)
    run = steps.run[taken]
    # Costs do not rise: the last of a run's steps is its best.
    last = np.append(run[1:] != run[:-1], True)[: len(run)]
    cost = np.full(len(steps.runs), np.inf)
    cost[run[last]] = steps.cost[taken[last]]
    cost[steps.run[np.isnan(shown)]] = np.nan
    return cost


def gap_at(steps: Steps, clock: str, value: float) -> Array:
    """Gap of each run's best path when a clock shows a value; see :func:`cost_at`.

    Returns
    -------
    (r,) float64
        nan also where there is no optimum.
    """
    return gaps(cost_at(steps, clock, value), steps.optimum)


def first_within(steps: Steps, clock: str, gap: float) -> Array:
    """What a clock shows when each run first comes within a gap of the optimum.

    Parameters
    ----------
    steps : Steps
    clock : str
        Of :data:`CLOCKS`.
    gap : float
        Cost over optimum, less 1.

    Returns
    -------
    (r,) float64
        Infinite where the run never does, nan where it does and did not count, and where there is
        no optimum.
    """
    target = steps.optimum * (1.0 + gap) * (1.0 + ROUNDING)
    within = np.flatnonzero(steps.cost <= target[steps.run])
    run = steps.run[within]
    first = np.append(True, run[1:] != run[:-1])[: len(run)]
    shown = np.where(np.isnan(steps.optimum), np.nan, np.inf)
    shown[run[first]] = steps.clocks[clock][within[first]]
    return shown


def final_gaps(steps: Steps) -> Array:
    """Gap of each run's accepted path; infinite if it has none, nan if there is no optimum.

    Returns
    -------
    (r,) float64
    """
    cost = np.full(len(steps.runs), np.inf)
    # Costs do not rise: later steps of a run write over earlier ones.
    cost[steps.run] = steps.cost
    return gaps(cost, steps.optimum)


def groups_of(steps: Steps, wanted: NDArray[np.bool_]) -> dict[tuple[str, str], NDArray[np.int64]]:
    """Numbers of the runs of each scene and planner.

    Parameters
    ----------
    steps : Steps
    wanted : (r,) bool
        Which runs.

    Returns
    -------
    dict from (place, variant) to (n,) int64
        In the order of the first runs.
    """
    chosen = steps.runs.loc[wanted, ["place", "variant"]]
    names = chosen["place"].astype(str), chosen["variant"].astype(str)
    codes, pairs = pd.MultiIndex.from_arrays(names).factorize()
    return {pair: chosen.index.to_numpy()[codes == i] for i, pair in enumerate(pairs)}


def _optimum(runs: pd.DataFrame) -> Array:
    """The optimum of each run's query; a run that died before it was asked has its neighbours'."""
    same = [runs[column] for column in ("scene", "query", "scene_hash")]
    found = runs["optimum"].astype("float64").groupby(same).transform("max")
    return np.array(found, dtype=np.float64)


def _ends(accepted: pd.DataFrame, reported: pd.DataFrame) -> pd.DataFrame:
    """Last steps of the runs that ended with a better path than they had reported."""
    last = reported.groupby("run")["cost"].last().reindex(accepted.index, fill_value=np.inf)
    better = accepted[last > accepted["cost"] * (1.0 + ROUNDING)]
    at_end = {clock: better[column] for clock, column in CLOCKS.items()}
    return pd.DataFrame({"run": better.index, "cost": better["cost"], **at_end})
