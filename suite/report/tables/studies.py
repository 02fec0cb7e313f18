"""Studies of one setting: what KBGA and the plain GA owe to it, beside the paper's figures.

A study is made when the runs hold a planner at several values of its setting, and otherwise alike.
"""

import re
from dataclasses import dataclass

import numpy as np
import pandas as pd

from suite.paper.reported import KBGA, KBGA_PLUS, PLAIN_GA, find
from suite.report.rows import feasible, places, settings_of
from suite.report.table import Kind, Table
from suite.report.tables.compared import (
    COLUMNS,
    KINDS,
    NOTE,
    PENALTIES_NOTE,
    RATIO_NOTE,
    compare,
    families,
    whole_where_whole,
)
from suite.report.tables.glance import at_a_glance

GLANCE_NOTE = (
    "Mean gap to the exact optimum in per cent, over the runs that found a path; how many these "
    "are stands beside it where some did not."
)
TIME_NOTE = (
    "The paper's times are from a Pentium III at 933 MHz: compare the ratios, not the seconds."
)

PAPER_KINDS = {"paper time (s)": Kind.PRINTED, "paper ratio": Kind.PRINTED}

RESAMPLES = 2000
"""Two digits of a per cent."""

BEST_RATE_SCENE = "zigzag"
"""Where the paper chose the plain GA's mutation rate (section IV: the environment of Fig. 8)."""


@dataclass(frozen=True, slots=True)
class Study:
    """A setting that varies, and how its tables and figure are made.

    name : of its files.
    title : of its tables.
    setting : what varies.
    symbol : its name in columns and on axes.
    planners : those whose variants are compared; with the paper's KBGA, ours as well.
    reference : the value that the others are compared with: the default of the planners, or of
        most of them.
    panels : columns of :func:`sweep` that the figure shows for each scene.
    logarithmic : whether the values stand on a logarithmic axis.
    """

    name: str
    title: str
    setting: str
    symbol: str
    planners: tuple[str, ...]
    reference: float
    panels: tuple[str, ...] = ("gap mean (%)", "gen to best mean")
    logarithmic: bool = False


MUTATION_RATE = Study(
    "mutation-rate",
    "The plain GA's mutation rate",
    "mutation_probability",
    "mutation rate",
    (PLAIN_GA,),
    0.5,
    panels=("feasible (%)", "cost with penalties over optimum"),
)
RESOLUTION = Study(
    "resolution",
    "The lattice's resolution",
    "resolution",
    "resolution",
    (KBGA,),
    100.0,
    logarithmic=True,
)
PENALTY = Study(
    "penalty",
    "The penalty constant C of Eq. (1)",
    "penalty",
    "C",
    (KBGA, PLAIN_GA),
    100.0,
    panels=("feasible (%)", "gap mean (%)"),
    logarithmic=True,
)
FIRST_POPULATION = Study(
    "first-population",
    "A first population built with domain knowledge",
    "informed_share",
    "informed share",
    (KBGA,),
    0.0,
)
TUNING = Study(
    "tuning",
    "On-line tuning of the operators' probabilities",
    "adaptation_rate",
    "adaptation rate",
    (KBGA,),
    0.0,
)
STUDIES = (MUTATION_RATE, RESOLUTION, PENALTY, FIRST_POPULATION, TUNING)


def sweep(runs: pd.DataFrame, study: Study, first: pd.DataFrame | None = None) -> pd.DataFrame:
    """The comparison of a study: a row for each scene, family and value.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    study : Study
    first : DataFrame, optional
        Measures of each run's first population, as :func:`suite.store.read.read_first_measures`
        gives them.

    Returns
    -------
    DataFrame
        Empty if the runs hold no planner at several values of the setting.
    """
    rows = _rows(runs, study)
    if rows.empty:
        return rows
    frame = compare(
        rows,
        by=["scene", "family", "variant", "value"],
        within=["scene", "family"],
        reference=study.reference,
    )
    frame["feasible (%)"] = 100.0 * frame["feasible"] / frame["runs"]
    if study is FIRST_POPULATION and first is not None and "feasible_share" in first:
        shares = 100.0 * rows["key"].map(first["feasible_share"])
        means = shares.groupby([rows["scene"], rows["variant"]]).mean()
        names = frame[["scene", "variant"]].itertuples(index=False, name=None)
        frame["first feasible (%)"] = [float(means[name]) for name in names]
    times = [
        _paper_time(study, scene, value)
        for scene, value in zip(frame["scene"], frame["value"], strict=True)
    ]
    papers = ~of_kbga_plus(frame)
    frame["paper time (s)"] = pd.Series(times, dtype="float64").where(papers)
    frame["paper ratio"] = frame["paper time (s)"] / [
        _paper_time(study, scene, study.reference) or float("nan") for scene in frame["scene"]
    ]
    return frame


def of_kbga_plus(frame: pd.DataFrame) -> "pd.Series[bool]":
    """Which rows of a comparison are of our own planner, of which the paper says nothing."""
    return frame["family"].str.match(f"{KBGA_PLUS}(?:,|$)")


def _rows(runs: pd.DataFrame, study: Study) -> pd.DataFrame:
    """The runs of families in which the setting takes several values, with these beside them."""
    settings = settings_of(runs)
    has_it = pd.Series([study.setting in s for s in settings], index=runs.index, dtype=bool)
    planners = [*study.planners, *([KBGA_PLUS] if KBGA in study.planners else [])]
    answers = runs["planner"].isin(planners) & has_it
    runs, settings = runs[answers], settings[answers]
    if runs.empty:
        return runs
    rows = runs.assign(
        value=settings.map(lambda s: float(s[study.setting])),
        family=families(runs, settings, [study.setting]),
        scene=places(runs),
    )
    return rows[rows.groupby("family")["value"].transform("nunique") > 1]


def _paper_time(study: Study, scene: str, value: float) -> float | None:
    if KBGA not in study.planners:
        return None
    found = find(scene=scene, planner=KBGA, quantity="time_s", statistic="mean")
    times = [r.value for r in found if r.setting == {study.setting: value}]
    return times[0] if times else None


def best_value(frame: pd.DataFrame, scene: str) -> float:
    """The best value of a study's setting on a scene.

    The one with the most feasible runs; of several, the one with the lowest mean cost, penalties
    included. Of equals, the first.

    Parameters
    ----------
    frame : DataFrame
        Of :func:`sweep`.
    scene : str
    """
    here = frame[frame["scene"] == scene]
    ranked = here.sort_values(
        ["feasible", "cost with penalties mean"], ascending=[False, True], kind="stable"
    )
    return float(ranked["value"].iloc[0])


def picked_again(
    runs: pd.DataFrame, study: Study, scene: str, rng: np.random.Generator
) -> "pd.Series[float]":
    """How often each value of a setting would be the best on a scene, if the runs came out anew.

    The runs of each value are drawn again from themselves, with replacement (bootstrap).

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    study : Study
    scene : str
    rng : numpy.random.Generator

    Returns
    -------
    Series of float
        Shares of :data:`RESAMPLES` draws, by value; they sum to 1.
    """
    rows = _rows(runs, study)
    rows = rows[rows["scene"] == scene]
    dearest = float(rows["claimed_cost"].max())
    costs = rows["claimed_cost"].fillna(dearest)  # a run that crashed has none
    found = rows.index.isin(feasible(rows).index)
    values, ranks = [], []
    for value in sorted(set(rows["value"])):
        mine = np.flatnonzero(rows["value"] == value)
        drawn = rng.choice(mine, size=(RESAMPLES, len(mine)))
        values.append(value)
        # One number that sorts as the rule does: costs count only among equal numbers of runs.
        cost = costs.to_numpy()[drawn].mean(axis=1)
        ranks.append(-found[drawn].sum(axis=1) + cost / (1.0 + dearest))
    best = np.argmin(ranks, axis=0)
    return pd.Series(np.bincount(best, minlength=len(values)) / RESAMPLES, index=values)


def study_tables(runs: pd.DataFrame, first: pd.DataFrame | None = None) -> list[Table]:
    """The studies that these runs can answer, two tables each: at a glance, and in all rows.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    first : DataFrame, optional
        As for :func:`sweep`.
    """
    tables = []
    for study in STUDIES:
        frame = sweep(runs, study, first)
        if frame.empty:
            continue
        tables.append(_glance_table(study, frame))
        if study is MUTATION_RATE and BEST_RATE_SCENE in set(frame["scene"]):
            tables.append(_best_table(runs, study, frame))
        tables.append(_rows_table(study, frame))
    counted = [obstacles(runs, name) for name in (KBGA, KBGA_PLUS)]
    if not all(frame.empty for frame in counted):
        tables.append(_obstacles_table(pd.concat(frame for frame in counted if len(frame))))
    return tables


def _glance_table(study: Study, frame: pd.DataFrame) -> Table:
    seen = frame.assign(**{"planner": frame["family"], study.symbol: _values(frame)})
    return Table(
        f"study-{study.name}",
        f"{study.title}: mean gap (%)",
        at_a_glance(seen, ["planner", study.symbol]),
        GLANCE_NOTE,
    )


def _rows_table(study: Study, frame: pd.DataFrame) -> Table:
    shown = frame.assign(**{study.symbol: _values(frame)}).rename(columns={"family": "planner"})
    columns = [
        "scene", "planner", study.symbol, "runs", "feasible", "first feasible (%)", *COLUMNS,
        "paper time (s)", "paper ratio",
    ]  # fmt: skip
    notes = [NOTE, RATIO_NOTE.format(reference=f"{study.symbol} {study.reference:g}")]
    if (frame["feasible"] == frame["runs"]).all():
        # Then it is the cost.
        columns.remove("cost with penalties mean")
    else:
        notes.insert(1, PENALTIES_NOTE)
    if frame["paper time (s)"].isna().all():
        columns = [c for c in columns if not c.startswith("paper")]
    else:
        notes.append(TIME_NOTE)
    if "first feasible (%)" in frame:
        notes.append("first feasible: chromosomes of the first population.")
    return Table(
        f"study-{study.name}-rows",
        f"{study.title}: all measures",
        shown[[c for c in columns if c in shown]],
        " ".join(notes),
        kinds=KINDS | PAPER_KINDS,
    )


def best_values(runs: pd.DataFrame, study: Study) -> pd.DataFrame:
    """The best value of a setting on each scene, beside the reference.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    study : Study
        Of one family.
    """
    frame = sweep(runs, study)
    paper = find(planner=study.planners[0], statistic="setting", quantity=study.setting)
    rows = []
    for scene, here in frame.groupby("scene", sort=False):
        best = best_value(frame, str(scene))
        has_papers = scene == BEST_RATE_SCENE and len(paper) > 0
        row = {
            "scene": scene,
            f"best {study.symbol}": best,
            "paper's best": paper[0].value if has_papers else float("nan"),
        }
        # The same draws whichever scenes were run.
        again = picked_again(runs, study, str(scene), np.random.default_rng(0))
        for name, value in (("best", best), (f"{study.reference:g}", study.reference)):
            measured = here[here["value"] == value]
            if len(measured):
                row[f"picked again, {name} (%)"] = 100.0 * float(again[value])
                row[f"feasible, {name}"] = int(measured["feasible"].iloc[0])
                row[f"cost with penalties, {name}"] = float(
                    measured["cost with penalties mean"].iloc[0]
                )
        rows.append(row)
    return pd.DataFrame(rows)


def _best_table(runs: pd.DataFrame, study: Study, frame: pd.DataFrame) -> Table:
    best = best_value(frame, BEST_RATE_SCENE)
    found = find(planner=study.planners[0], statistic="setting", quantity=study.setting)
    papers = f"; the paper's is {found[0].value:g}" if found else ""
    note = (
        "best: the most feasible runs, then the lowest mean cost, penalties included. The paper "
        f"chose on {BEST_RATE_SCENE}: there our best is {best:g}{papers}. picked again: how often "
        "the same rule would pick that rate if the runs were drawn again from themselves "
        f"({RESAMPLES} bootstrap draws). {PENALTIES_NOTE}"
    )
    return Table(
        f"study-{study.name}-best",
        f"{study.title}: the best",
        best_values(runs, study),
        note,
        kinds={"paper's best": Kind.PRINTED},
    )


def _values(frame: pd.DataFrame) -> "pd.Series[float]":
    return whole_where_whole(frame["value"])


COUNTED = re.compile(r"(?:obstacles|scattered)_(\d+)")
"""Scenes that say in their names how many obstacles they hold."""

FEWEST = 20.0
"""Of the paper, Fig. 14a."""


def obstacles(runs: pd.DataFrame, planner: str = KBGA) -> pd.DataFrame:
    """Section IV: KBGA among more and more obstacles, compared with 20.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    planner : str
        Name of the variant; only the paper's has the paper's times beside it.

    Returns
    -------
    DataFrame
        A row for each scene that counts its obstacles in its name; empty if there is but one.
    """
    counts = runs["scene"].str.extract(f"^{COUNTED.pattern}$", expand=False)
    wanted = counts.notna() & (runs["variant"] == planner)
    rows = runs[wanted].assign(value=counts[wanted].astype("float64"))
    if rows["value"].nunique() < 2:
        return rows.iloc[:0]
    rows = rows.sort_values("value", kind="stable")
    frame = compare(rows, by=["scene", "value"], within=[], reference=FEWEST)
    # A check's price is of the whole run: measures of the operators and of the harness are in it.
    frame["cpu per check (us)"] = [
        1e6 * float((group["cpu_s"] / group["checks"].astype("float64")).median())
        for _, group in rows.groupby("scene", sort=False)
    ]
    frame.insert(1, "planner", planner)
    paper = {r.scene: r.value for r in find(planner=planner, quantity="time_s", statistic="mean")}
    frame["paper time (s)"] = [paper.get(scene) for scene in frame["scene"]]
    frame["paper time (s)"] = frame["paper time (s)"].astype("float64")
    least = frame.loc[frame["value"] == FEWEST, "paper time (s)"]
    frame["paper ratio"] = frame["paper time (s)"] / float(least.mean())
    return frame


def _obstacles_table(frame: pd.DataFrame) -> Table:
    columns = [
        "scene", "planner", "obstacles", "runs", "feasible", *COLUMNS, "paper time (s)",
        "paper ratio",
    ]  # fmt: skip
    columns.remove("cost with penalties mean")
    columns.insert(columns.index("checks mean") + 1, "cpu per check (us)")
    shown = frame.assign(obstacles=_values(frame))
    if len(set(frame["planner"])) == 1:
        columns.remove("planner")
    note = (
        "obstacles: as many as the scene's name says; a concave one counts as its convex parts. "
        f"{NOTE} cpu per check: that of a whole run by its checks, median. "
        f"{RATIO_NOTE.format(reference='20 obstacles')} {TIME_NOTE}"
    )
    title = "Paper's section IV: the number of obstacles"
    return Table("study-obstacles", title, shown[columns], note, kinds=KINDS | PAPER_KINDS)
