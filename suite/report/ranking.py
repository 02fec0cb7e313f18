"""An overall ranking of the planners over scenes, and whether their ranks differ.

On each scene the planners are ranked twice: by success and then by the median gap of the paths
that they found; and by the median time to come within 1 % of the optimum, never being infinite.
Ties have the mean of their ranks. Only scenes that all planners ran count.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from scipy import stats

from suite.report.anytime import Array, Steps, final_gaps, first_within
from suite.report.clock import by_the_clock
from suite.report.statistics import critical_difference, friedman
from suite.report.summary import SUCCESSES
from suite.report.table import Table
from suite.report.targets import medians

TARGET = 0.01
"""Gap to the optimum, for the ranking by time."""

BY_GAP = "rank by gap"
BY_TIME = "rank by time"

NOTE = (
    "Rank by gap: by the share of successes, then by the median gap of the paths that were found. "
    "Rank by time: by the median time to come within 1 % of the optimum, over all runs, 'never' "
    "being infinite; then by the share of runs that came so near. Rank 1 is the best; ties have "
    "the mean of their ranks."
)


@dataclass(frozen=True, slots=True, eq=False)
class Ranking:
    """Ranks of the planners on each scene.

    name : of the criterion.
    ranks : DataFrame, (scenes, planners) float64. A rank 1 is the best.
    """

    name: str
    ranks: pd.DataFrame

    @property
    def mean(self) -> "pd.Series[float]":
        """Mean rank of each planner over the scenes."""
        return self.ranks.mean()

    @property
    def critical_difference(self) -> float:
        """How far mean ranks must be apart to differ, by Nemenyi's test at 5 %."""
        scenes, planners = self.ranks.shape
        return critical_difference(planners, scenes)


def scene_scores(steps: Steps) -> pd.DataFrame:
    """What the planners are ranked by.

    Parameters
    ----------
    steps : Steps

    Returns
    -------
    DataFrame
        A row for each scene that all planners ran and planner: success (%), gap median (%) of
        the paths found, time to 1 % median (ms), within 1 % (%).
    """
    runs = steps.runs
    gap = final_gaps(steps)
    time = first_within(steps, "wall_s", TARGET)
    measured = pd.DataFrame(
        {
            "place": runs["place"],
            "variant": runs["variant"],
            "success (%)": 100.0 * runs["status"].isin(SUCCESSES),
            "gap median (%)": 100.0 * np.where(np.isfinite(gap), gap, np.nan),
            "within 1 % (%)": 100.0 * np.where(np.isnan(time), np.nan, np.isfinite(time)),
        }
    )
    groups = measured.groupby(["place", "variant"], sort=False)
    scores = groups[["success (%)", "within 1 % (%)"]].mean()
    scores["gap median (%)"] = groups["gap median (%)"].median()
    times = pd.DataFrame({"time": 1e3 * time}, index=runs.index)[by_the_clock(runs)]
    names = runs.loc[times.index, ["place", "variant"]]
    scores["time to 1 % median (ms)"] = medians(times, names)["time"]
    planners = scores.groupby(level="place").size()
    shared = planners.index[planners == runs["variant"].nunique()]
    scores = scores[scores.index.get_level_values("place").isin(shared)]
    return scores.rename_axis(["scene", "planner"]).reset_index()


def rankings(scores: pd.DataFrame) -> list[Ranking]:
    """Rank the planners by gap and by time.

    Parameters
    ----------
    scores : DataFrame
        Of :func:`scene_scores`.

    Returns
    -------
    list of Ranking
        Those with a scene; the one by time needs an optimum.
    """
    keys = {
        BY_GAP: [-scores["success (%)"], scores["gap median (%)"].fillna(np.inf)],
        BY_TIME: [scores["time to 1 % median (ms)"], -scores["within 1 % (%)"]],
    }
    found = [Ranking(name, _ranks(scores, columns)) for name, columns in keys.items()]
    return [ranking for ranking in found if len(ranking.ranks)]


def _ranks(scores: pd.DataFrame, keys: "list[pd.Series[Any]]") -> pd.DataFrame:
    """Ranks by the first key, among equals by the second."""
    wanted = pd.concat(keys, axis=1).notna().all(axis=1)
    wanted = wanted.groupby(scores["scene"]).transform("all")
    # Places among the sorted rows of keys: equal rows, equal places.
    rows = np.column_stack(keys)[wanted]
    order = np.unique(rows, axis=0, return_inverse=True)[1].ravel()
    ordered = scores.loc[wanted, ["scene", "planner"]].assign(order=order)
    ranks = ordered.groupby("scene", sort=False)["order"].transform(_mean_ranks)
    table = ordered.assign(rank=ranks).pivot(index="scene", columns="planner", values="rank")  # noqa: PD010
    scenes, planners = (dict.fromkeys(ordered[name]) for name in ("scene", "planner"))
    return table.reindex(index=list(scenes), columns=list(planners)).astype("float64")


def _mean_ranks(values: "pd.Series[Any]") -> Array:
    return np.asarray(stats.rankdata(values, method="average"), dtype=np.float64)


def ranking_tables(steps: Steps) -> list[Table]:
    """The overall ranking, and the ranks on each scene with what they come from."""
    scores = scene_scores(steps)
    found = rankings(scores)
    if not found or len(found[0].ranks.columns) < 2:
        return []
    frame = pd.DataFrame({ranking.name: ranking.mean for ranking in found})
    frame = frame.sort_values(found[0].name, kind="stable").rename_axis("planner").reset_index()
    title = f"Mean ranks over {_scenes(len(found[0].ranks))}"
    note = " ".join([NOTE, *(_verdict(ranking) for ranking in found)])
    detailed = scores.assign(**{r.name: _of_rows(scores, r.ranks) for r in found})
    return [
        Table("ranking", title, frame, note),
        Table("ranking-rows", "Ranks on each scene", detailed, NOTE, "never", detail=True),
    ]


def _of_rows(scores: pd.DataFrame, ranks: pd.DataFrame) -> list[float]:
    """The rank of each row of scores; nan on a scene that is not ranked."""
    everywhere = ranks.reindex(scores["scene"].unique())
    names = zip(scores["scene"], scores["planner"], strict=True)
    return [float(everywhere.loc[scene, planner]) for scene, planner in names]


def _verdict(ranking: Ranking) -> str:
    """What the tests say of the mean ranks."""
    statistic, p_value = friedman(ranking.ranks.to_numpy())
    scenes = _scenes(len(ranking.ranks))
    if np.isnan(p_value):
        return f"{ranking.name}, {scenes}: too few ranks for a test."
    freedom = len(ranking.ranks.columns) - 1
    return (
        f"{ranking.name}, {scenes}: Friedman's chi-square {statistic:.2f} with {freedom} degrees "
        f"of freedom, {p_text(p_value)}; two planners differ (Nemenyi, 5 %) if their mean ranks "
        f"are more than {ranking.critical_difference:.2f} apart."
    )


def _scenes(count: int) -> str:
    return f"{count} scene{'s' if count != 1 else ''}"


def p_text(p_value: float) -> str:
    """A p-value in words.

    Examples
    --------
    >>> p_text(0.0004), p_text(0.0123)
    ('p < 0.001', 'p = 0.012')
    """
    return "p < 0.001" if p_value < 0.001 else f"p = {p_value:.3f}"
