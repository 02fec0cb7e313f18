"""An overall ranking of the planners over scenes, and whether their ranks differ.

On each scene the planners are ranked twice: by success and then by the median gap of the paths
that they found; and by the median time to come within 1 % of the optimum, never being infinite.
Ties have the mean of their ranks. Only scenes that all planners ran count.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np
import pandas as pd
from scipy import stats

from suite.planner import PlanStatus
from suite.report.rows import maps_note
from suite.report.statistics.anytime import Steps, final_gaps, first_within
from suite.report.statistics.clock import by_the_clock
from suite.report.statistics.inference import (
    LEVEL,
    Array,
    critical_difference,
    friedman,
    holm,
    nemenyi,
    signed_rank,
)
from suite.report.table import INFINITE, Kind, Table
from suite.report.tables.targets import medians
from suite.report.words import counted, joined

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


REFERENCE = "kbga"

TEST_NOTE = (
    "p: that a planner's ranks are {one}'s, by Nemenyi's test of mean ranks, which looks at all "
    "planners of the table, and by Wilcoxon's signed-rank test of the two planners' medians over "
    "the scenes, corrected by Holm for all pairs. Planners that are not told apart may be equal or "
    "not: so many scenes do not say."
)


@dataclass(frozen=True, eq=False)
class Ranking:
    """Ranks of the planners on each scene.

    name : of the criterion.
    ranks : DataFrame, (scenes, planners) float64. A rank 1 is the best.
    scores : DataFrame, (scenes, planners) float64. What the pairwise test compares; less is
        better, infinite where a planner never got there.
    """

    name: str
    ranks: pd.DataFrame
    scores: pd.DataFrame

    @property
    def mean(self) -> "pd.Series[float]":
        """Mean rank of each planner over the scenes."""
        return self.ranks.mean()

    @property
    def critical_difference(self) -> float:
        """How far mean ranks must be apart to differ, by Nemenyi's test at 5 %."""
        scenes, planners = self.ranks.shape
        return critical_difference(planners, scenes)

    @cached_property
    def _pairs(self) -> dict[frozenset[str], float]:
        """Wilcoxon's p-value of each pair, corrected by Holm for all pairs."""
        pairs = list(combinations(map(str, self.ranks.columns), 2))
        found = np.array([signed_rank(self._differences(one, other)) for one, other in pairs])
        return dict(zip(map(frozenset, pairs), holm(found).tolist(), strict=True))

    def wilcoxon(self, one: str, other: str) -> float:
        """Wilcoxon's p-value of two planners over the scenes, corrected by Holm for all pairs."""
        return self._pairs.get(frozenset((one, other)), 1.0)

    def _differences(self, one: str, other: str) -> Array:
        mine, others = (self.scores[name].to_numpy() for name in (one, other))
        # Never and never are equal.
        same = mine == others
        return np.subtract(mine, others, out=np.zeros(len(mine)), where=~same)

    def nemenyi(self, one: str, other: str) -> float:
        """Nemenyi's p-value of two planners."""
        scenes, planners = self.ranks.shape
        return nemenyi(float(self.mean[one] - self.mean[other]), planners, scenes)


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
    found = np.isin(np.arange(len(runs)), steps.run)
    time = first_within(steps, "wall_s", TARGET)
    measured = pd.DataFrame(
        {
            "place": runs["place"],
            "variant": runs["variant"],
            "success (%)": 100.0 * runs["status"].isin(PlanStatus.SUCCESSES),
            "gap median (%)": 100.0 * np.where(found, gap, np.nan),
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
    compared = {
        # A planner without a path in any run is worse than any path.
        BY_GAP: scores["gap median (%)"].fillna(np.inf),
        BY_TIME: scores["time to 1 % median (ms)"],
    }
    found = [
        _ranking(name, scores, columns, compared[name].rename("score"))
        for name, columns in keys.items()
    ]
    return [ranking for ranking in found if len(ranking.ranks)]


def _ranking(
    name: str, scores: pd.DataFrame, keys: "list[pd.Series[Any]]", compared: "pd.Series[Any]"
) -> Ranking:
    ranks = _ranks(scores, keys)
    table = scores[["scene", "planner"]].join(compared)
    pivoted = table.pivot(index="scene", columns="planner", values="score")  # noqa: PD010
    return Ranking(name, ranks, pivoted.reindex(index=ranks.index, columns=ranks.columns))


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


def ranking_tables(steps: Steps, reference: str | None = None) -> list[Table]:
    """The overall ranking, and the ranks on each scene with what they come from.

    Parameters
    ----------
    steps : Steps
    reference : str, optional
        The planner from which the others are told, or not; default: :data:`REFERENCE`, if it is
        there, or else the best.
    """
    scores = scene_scores(steps)
    found = rankings(scores)
    if not found or len(found[0].ranks.columns) < 2:
        return []
    names = list(found[0].ranks.columns)
    one = reference or (REFERENCE if REFERENCE in names else str(found[0].mean.idxmin()))
    frame = pd.concat([_columns(ranking, one) for ranking in found], axis=1)
    frame = frame.sort_values(found[0].name, kind="stable").rename_axis("planner").reset_index()
    kinds = {name: Kind.P_VALUE for name in map(str, frame) if name.endswith(" p")}  # see _columns
    title = f"Mean ranks over {counted(len(found[0].ranks), 'scene')}"
    told = [NOTE, maps_note(steps.runs), TEST_NOTE.format(one=one)]
    note = joined(*told, *(_verdict(r, one) for r in found))
    detailed = scores.assign(**{r.name: _of_rows(scores, r.ranks) for r in found})
    return [
        Table("ranking", title, frame, note, kinds=kinds),
        Table("ranking-rows", "Ranks on each scene", detailed, NOTE, "never", detail=True,
              infinite_in={"gap median (%)": INFINITE}),
    ]  # fmt: skip


def _columns(ranking: Ranking, one: str) -> pd.DataFrame:
    """Mean ranks, and whether they are told from one planner's by either test."""
    columns: dict[str, Any] = {ranking.name: ranking.mean}
    if _can_be_tested(ranking):
        what = ranking.name.removeprefix("rank ")
        names = [str(name) for name in ranking.ranks.columns]
        for test, p_values in (
            ("Nemenyi", [ranking.nemenyi(name, one) for name in names]),
            ("Wilcoxon-Holm", [ranking.wilcoxon(name, one) for name in names]),
        ):
            columns[f"{what}, {test} p"] = pd.Series(p_values, names).where(np.array(names) != one)
    return pd.DataFrame(columns)


def _can_be_tested(ranking: Ranking) -> bool:
    return not np.isnan(friedman(ranking.ranks.to_numpy())[1])


def _of_rows(scores: pd.DataFrame, ranks: pd.DataFrame) -> list[float]:
    """The rank of each row of scores; nan on a scene that is not ranked."""
    everywhere = ranks.reindex(scores["scene"].unique())
    names = zip(scores["scene"], scores["planner"], strict=True)
    return [float(everywhere.loc[scene, planner]) for scene, planner in names]


def _verdict(ranking: Ranking, one: str) -> str:
    """What the tests say of the mean ranks, and for how much so many scenes speak."""
    statistic, p_value = friedman(ranking.ranks.to_numpy())
    tasks, planners = ranking.ranks.shape
    scenes = counted(tasks, "scene")
    if np.isnan(p_value):
        return f"{ranking.name}, {scenes}: too few ranks for a test."
    best = str(ranking.mean.idxmin())
    lines = [
        f"{ranking.name}, {scenes}: Friedman's chi-square {statistic:.2f} with {planners - 1} "
        f"degrees of freedom, {p_text(p_value)}; two planners differ (Nemenyi, 5 %) if their mean "
        f"ranks are more than {ranking.critical_difference:.2f} of at most {planners - 1} apart."
    ]
    lines += [_told(ranking, name) for name in dict.fromkeys([one, best])]
    pairs = planners * (planners - 1) // 2
    least = signed_rank(np.arange(1.0, tasks + 1.0))
    if pairs * least >= 1.0 - LEVEL:
        lines.append(
            f"Wilcoxon's test can tell none of {pairs} pairs apart over {scenes}: its smallest p "
            f"is {least:.2g}, before Holm's correction."
        )
    return " ".join(lines)


def _told(ranking: Ranking, one: str) -> str:
    """Which planners are told from one, by either test."""
    others = [str(name) for name in ranking.mean.sort_values(kind="stable").index if name != one]
    by_test = {
        "Nemenyi": [name for name in others if ranking.nemenyi(name, one) < 1.0 - LEVEL],
        "Wilcoxon-Holm": [name for name in others if ranking.wilcoxon(name, one) < 1.0 - LEVEL],
    }
    told = ", and ".join(f"{test} {_these(names, others)}" for test, names in by_test.items())
    return f"From {one} {told}."


def _these(names: list[str], others: list[str]) -> str:
    """The planners that are told, or those that are not if they are fewer."""
    rest = [name for name in others if name not in names]
    if not names:
        return f"tells none of the {len(others)} others"
    if len(names) <= len(rest):
        untold = "the other" if len(rest) == 1 else f"the {len(rest)} others"
        return f"tells {', '.join(names)}, and not {untold}"
    return f"tells all {len(others)}" if not rest else f"does not tell {', '.join(rest)}"


def p_text(p_value: float) -> str:
    """A p-value in words.

    Examples
    --------
    >>> p_text(0.0004), p_text(0.0123)
    ('p < 0.001', 'p = 0.012')
    """
    return "p < 0.001" if p_value < 0.001 else f"p = {p_value:.3f}"
