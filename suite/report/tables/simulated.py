"""The tables of simulated runs: how robots fared, how fast planners answered, the paper's figures.

Rows come from the runs, the simulations and the replans of a store, joined by their key.
"""

import json
from collections.abc import Iterator
from typing import Any

import pandas as pd

from suite.paper.reported import KBGA, find
from suite.report.optima import check_replans
from suite.report.rows import NAME, feasible, with_queries_together
from suite.report.statistics.clock import by_the_clock, untimed_note
from suite.report.table import Kind, Table
from suite.report.tables.summary import spread
from suite.report.words import joined
from suite.store.gap import gaps

SIMULATION_NOTE = (
    "unhurt: runs in which the robot came to the goal and no obstacle ever hit it, judged in "
    "continuous time. Lengths and times are simulated, over these runs. above exact: the length "
    "of the way above that of a robot that follows the exact shortest path of each update; a robot "
    "that is led astray less can be below. passed: the last opening, of how many runs."
)
REPLANNING_NOTE = (
    "latency: wall time of one call of the planner, over all updates of all runs. x kbga: its "
    "median over that of kbga, which goes on from the population that it has. gap: cost of the "
    "planned path above the exact optimum of what was known at that update; no path: updates that "
    "had one, and for which the planner gave none that was free."
)
PAPER_NOTE = (
    "Ours are kbga's runs. A reaction is the planner's median wall time at the update at which the "
    "change was seen; the paper's times are from a Pentium III at 933 MHz and can't be compared as "
    "such. detour: cost of the new path above what was left of the old one, median."
)

OPENINGS = {
    "Fig. 11": ("left", "the right opening shuts; a completely new path through the left one"),
    "Fig. 12 (a) interval 1 s": ("left", "the same, with shorter steps"),
    "Fig. 12 (b) obstacle 2.5 m/s": ("left", "the same, earlier"),
    "Fig. 12 (c, d) robot 5 m/s": ("right", "passes the right opening before it is closed"),
}
"""What the paper says of each world of the scene door: the opening that the robot passes."""

DOOR, UNKNOWN = "door", "unknown_obstacles"

CHANGES = (
    "A is detected and blocks the path: a new path",
    "B is detected and has no impact: the path stays",
    "C is removed: a better path",
)
"""What the paper says of the changes in unknown_obstacles, in the order of time."""

UNCHANGED_M = 0.01
"""A path that stays may still be polished by so much, metres."""


def simulated_tables(
    runs: pd.DataFrame, simulations: pd.DataFrame, replans: pd.DataFrame
) -> list[Table]:
    """All tables of simulated runs; none without any.

    Parameters
    ----------
    runs : DataFrame
        The simulated ones, as :func:`suite.store.read.read_runs` gives them.
    simulations, replans : DataFrame
        As :func:`suite.store.read.read_simulations` and :func:`suite.store.read.read_replans` give
        them.
    """
    if runs.empty:
        return []
    check_replans(replans)
    runs = with_queries_together(runs)
    fared = runs.merge(simulations, on="key", how="left", validate="one_to_one")
    asked = runs[["key", "world_settings", "contended", *NAME]].merge(replans, on="key")
    note = joined(REPLANNING_NOTE, untimed_note(runs))
    tables = [
        Table("simulations", "How the robots fared", how_they_fared(fared), SIMULATION_NOTE),
        Table(
            "replanning",
            "How the planners answered",
            how_they_answered(asked),
            note,
            kinds={"gen per replan": Kind.COUNT},
        ),
    ]
    timed = asked["latency_s"].where(by_the_clock(asked))
    ours = paper_dynamic(fared, asked.assign(latency_s=timed))
    if not ours.empty:
        title = "The paper's dynamic environments (sections III-D and III-E)"
        kinds = {"paper reaction (s)": Kind.PRINTED, "ours reaction (s)": Kind.MIXED}
        tables.append(Table("paper-dynamic", title, ours, PAPER_NOTE, kinds=kinds))
    return tables


def how_they_fared(runs: pd.DataFrame) -> pd.DataFrame:
    """Success, hits and ways of each planner in each world.

    Parameters
    ----------
    runs : DataFrame
        Simulated runs, with the columns of :func:`suite.store.read.read_simulations`.
    """
    rows = []
    for name, group in runs.groupby(NAME, sort=False):
        good = feasible(group)
        rows.append(
            {
                **_names(name),
                "runs": len(group),
                "unhurt (%)": 100.0 * len(good) / len(group),
                "hit": int((group["hits"] > 0).sum()),
                "passed": _counted(group["opening"]),
                **spread(good["cost"], "length", "m"),
                "above exact (%)": 100.0 * float(good["gap"].mean()),
                "time mean (s)": float(good["end_s"].mean()),
                "waiting mean (s)": float(good["waiting_s"].mean()),
                "otherwise": _counted(group.loc[group["status"] != "solved", "status"]),
            }
        )
    return pd.DataFrame(rows)


def how_they_answered(replans: pd.DataFrame) -> pd.DataFrame:
    """Latency, work and quality of the single plans of each planner in each world.

    Parameters
    ----------
    replans : DataFrame
        Joined with the columns NAME of their runs.
    """
    rows = []
    for name, group in replans.groupby(NAME, sort=False):
        latency = 1e3 * group.loc[by_the_clock(group), "latency_s"].dropna()
        above = 100.0 * pd.Series(gaps(group["cost"], group["optimum"])).dropna()
        missed = group["optimum"].notna() & group["cost"].isna() & group["latency_s"].notna()
        rows.append(
            {
                **_names(name),
                "replans per run": len(group) / group["key"].nunique(),
                "latency median (ms)": float(latency.median()),
                "latency 95 % (ms)": float(latency.quantile(0.95)),
                "latency worst (ms)": float(latency.max()),
                "gen per replan": float(group["generations"].astype("float64").mean()),
                "gap median (%)": float(above.median()),
                "gap worst (%)": float(above.max()),
                "no path": int(missed.sum()),
            }
        )
    frame = pd.DataFrame(rows)
    if not frame.empty:
        place = list(frame.columns).index("gen per replan")
        frame.insert(place, "x kbga", _over_kbga(frame))
    return frame


def paper_dynamic(runs: pd.DataFrame, replans: pd.DataFrame) -> pd.DataFrame:
    """What the paper says of its dynamic environments, and kbga's runs beside it."""
    ours = runs[runs["variant"] == KBGA]
    asked = replans[replans["variant"] == KBGA]
    rows = [*_openings(ours), *_reactions(asked[asked["scene"] == UNKNOWN])]
    return pd.DataFrame(rows)


def _openings(runs: pd.DataFrame) -> Iterator[dict[str, Any]]:
    for world, (opening, words) in OPENINGS.items():
        group = runs[(runs["scene"] == DOOR) & (runs["world"] == world)]
        if group.empty:
            continue
        good = (group["status"] == "solved") & (group["opening"] == opening)
        yield {
            "of the paper": world,
            "what it shows": f"{words} ({opening})",
            "runs": len(group),
            "ours so": int(good.sum()),
        }


def _reactions(replans: pd.DataFrame) -> Iterator[dict[str, Any]]:
    if replans.empty:
        return
    paper = [r.value for r in find(scene=UNKNOWN, quantity="reaction_s")]
    stated = (paper[0], None, paper[1])
    news = reactions(replans)
    for number, words in enumerate(CHANGES):
        here = news[news["number"] == number] if len(news) else news
        if here.empty:
            continue
        yield {
            "of the paper": "section III-E",
            "what it shows": words,
            "runs": len(here),
            "ours so": int(here["as stated"].sum()),
            "detour (m)": float(here["detour"].median()),
            "paper reaction (s)": stated[number],
            "ours reaction (s)": float(here["latency_s"].median()),
        }


def reactions(replans: pd.DataFrame) -> pd.DataFrame:
    """The updates at which robots saw something new, and what the planner made of it.

    Parameters
    ----------
    replans : DataFrame
        With the column ``world_settings`` of their runs.

    Returns
    -------
    DataFrame
        number (from 0, in the order of time), detour (cost of the new path above what was left of
        the old one, metres), as stated (whether that is what the paper says of this change),
        latency_s.
    """
    rows = [row for _, run in replans.groupby("key") for row in _changes(run)]
    return pd.DataFrame(rows, columns=["number", "detour", "as stated", "latency_s"])


def _changes(run: pd.DataFrame) -> Iterator[dict[str, Any]]:
    """The updates of one run at which the robot saw something new, in the order of time."""
    speed = json.loads(run["world_settings"].iloc[0])["speed"]
    run = run.sort_values("number")
    left = run["cost"].shift() - speed * run["time"].diff()
    detours = (run["cost"] - left)[run["changed"].fillna(False)]
    for number, (index, detour) in enumerate(detours.items()):
        expected = (detour > UNCHANGED_M, abs(detour) <= UNCHANGED_M, detour < -UNCHANGED_M)
        yield {
            "number": number,
            "detour": detour,
            "as stated": number < len(CHANGES) and expected[number],
            "latency_s": run.loc[index, "latency_s"],
        }


def _over_kbga(frame: pd.DataFrame) -> "pd.Series[Any]":
    """Median latencies over kbga's in the same world; missing where it did not run."""
    place = ["scene", "world"]
    column = "latency median (ms)"
    own = frame.loc[frame["planner"] == KBGA, [*place, column]]
    return frame[column] / frame[place].merge(own, on=place, how="left")[column]


def _names(name: Any) -> dict[str, str]:
    scene, _, world, variant = (str(part) for part in name)
    return {"scene": scene, "world": world, "planner": variant}


def _counted(words: "pd.Series[Any]") -> str:
    counts = words.dropna().value_counts().sort_index()
    return ", ".join(f"{word} {count}" for word, count in counts.items())
