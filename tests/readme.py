"""The tables of the README, made from results/: a test holds them to what stands there.

python -m tests.readme prints them all.
"""

import json
import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "results"
EXACT = {"visibility-graph", "extremitypathfinder"}
OMPL = "ompl-"


def read(campaign: str, name: str) -> pd.DataFrame:
    """Return a table of a campaign."""
    return pd.read_csv(RESULTS / campaign / f"{name}.csv")


def markdown(head: Sequence[str], align: str, lines: Iterable[Sequence[str]]) -> str:
    """Return a table; ``align`` has a letter for each column."""
    rule = "|" + "|".join("---:" if a == "r" else "---" for a in align) + "|"
    rows = ["| " + " | ".join(cells) + " |" for cells in (head, *lines)]
    return "\n".join([rows[0], rule, *rows[1:]])


def percent(value: float) -> str:
    # Rounding may leave a zero with a sign.
    return f"{round(value, 2) + 0.0:.2f} %"


def gaps() -> str:
    """Mean gap of each planner of paper-static on each scene."""
    planners = (
        "kbga",
        "kbga-plus",
        "plain-ga",
        "ompl-rrtstar",
        "ompl-rrtstar-tuned",
        "ompl-shortcut",
        "visibility-graph",
    )
    summary = read("paper-static", "summary").set_index(["scene", "planner"])
    lines = []
    for scene in summary.index.get_level_values("scene").unique():
        cells = [scene, f"{summary.loc[(scene, 'visibility-graph')]['cost mean']:.2f} m"]
        for planner in planners:
            row = summary.loc[(scene, planner)]
            solved, runs = int(row["solved"]), int(row["runs"])
            some = "" if solved == runs else f", {solved} of {runs} runs"
            found = percent(row["gap mean (%)"]) + some
            cells.append(found if solved else "no path")
        lines.append(cells)
    return markdown(("scene", "optimum", *planners), "lr" + "l" * len(planners), lines)


TABLE_1 = ("number of runs", "feasible runs", "best found path cost", "generations needed")


def table_1() -> str:
    """The paper's Table 1 and ours."""
    frame = read("paper-static", "paper-table-1")
    frame = frame[frame["quantity"].isin((*TABLE_1, "time needed (s)"))]
    lines = []
    for row in frame.itertuples(index=False):
        digits = 3 if "time" in row[0] else 2
        numbers = ["" if np.isnan(v) else f"{v:.{digits}f}" for v in row[2:]]
        if row[0] in TABLE_1[:2]:
            numbers = [n.removesuffix(".00") for n in numbers]
        lines.append([row[0], "" if isinstance(row[1], float) else row[1], *numbers])
    return markdown([c if c else "" for c in frame.columns], "ll" + "r" * 5, lines)


def alignment() -> str:
    """Mean gaps as drawn, moved and aligned, of both planners of ours."""
    frame = read("alignment", "alignment")
    lines = []
    for scene, rows in frame.groupby("scene", sort=False):
        if str(scene).endswith("_aligned"):  # controls: they have columns of their own
            continue
        cells = [str(scene)]
        for planner in ("kbga", "kbga-plus"):
            (row,) = rows[rows["planner"] == planner].to_dict("records")
            drawn, moved, aligned = (
                "" if np.isnan(row[name]) else f"{round(row[name], 2) + 0.0:.2f}"
                for name in ("as drawn (%)", "moved (%)", "aligned (%)")
            )
            cells += [drawn, moved, aligned, str(row["verdict"])]
        lines.append(cells)
    of_one = ("drawn", "moved", "aligned", "")
    head = ("scene", *(f"{p} {c}".strip() for p in ("kbga", "kbga-plus") for c in of_one))
    return markdown(head, "lrrrlrrrl", lines)


def times() -> str:
    """Median time to 1 % of ours, and of the soonest of OMPL's: plain, tuned, with shortcuts."""
    rows = read("all-planners", "ranking-rows")
    column = "time to 1 % median (ms)"
    lines = []
    for scene, here in rows.groupby("scene", sort=False):
        time = here.set_index("planner")[column]
        ompl = time[time.index.str.startswith(OMPL)]
        shortcut = ompl.index.str.startswith("ompl-shortcut")
        tuned = ompl.index.str.endswith("-tuned")
        cells = [str(scene), *(_ms(time[name]) for name in ("kbga", "kbga-plus"))]
        for some in (ompl[~tuned & ~shortcut], ompl[tuned & ~shortcut], ompl[shortcut]):
            soonest = str(some.idxmin()).removeprefix(OMPL).removesuffix("-tuned")
            name = "" if soonest == "shortcut" or np.isinf(some.min()) else f"{soonest}: "
            cells.append(name + _ms(some.min()))
        cells.append(_ms(time["visibility-graph"]))
        lines.append(cells)
    head = ("scene", "kbga", "kbga-plus", "OMPL, soonest", "tuned", "ompl-shortcut", "exact")
    return markdown(head, "lrrlllr", lines)


def _ms(value: float) -> str:
    return "never" if np.isinf(value) else f"{float(f'{value:.2g}'):g} ms"


def contrasts() -> str:
    """The paper's ablations as contrasts."""
    frame = read("paper", "paper-contrasts")
    lines = []
    for row in frame[frame["one"] == "kbga"].to_dict("records"):
        if row["scene"] not in ("zigzag", "maze") or row["other"] == row["one"]:
            continue
        low, high = row["ours low"], row["ours high"]
        interval = "" if np.isnan(low) else f" [{low:.1f}, {high:.1f}]"
        paper, ours = f"{row['paper']:+.1f}", f"{row['ours']:+.1f}{interval}"
        other = str(row["other"]).removeprefix("kbga-")
        lines.append([row["scene"], other, row["measure"], paper, ours, row["verdict"], row["why"]])
    head = ("scene", "kbga against", "measure", "paper", "ours", "verdict", "why")
    return markdown(head, "lllrrll", lines)


def dynamic() -> str:
    """Latencies and ways of the replanners."""
    answered, fared = read("paper-dynamic", "replanning"), read("paper-dynamic", "simulations")
    both = answered.merge(fared, on=["scene", "world", "planner"])
    lines = []
    for planner in both["planner"].unique():
        cells = [planner]
        for world in ("Fig. 11", "section III-E"):
            (row,) = both[(both["planner"] == planner) & (both["world"] == world)].to_dict(
                "records"
            )
            above = round(row["above exact (%)"], 1) + 0.0
            cells += [
                f"{row['latency median (ms)']:.2f} ms",
                f"{row['latency worst (ms)']:.0f} ms",
                f"{above:+.1f} %" if above else "0.0 %",
            ]
        lines.append(cells)
    of_one = ("median", "worst", "way")
    head = ("planner", *(f"{w}, {c}" for w in ("door", "unknown") for c in of_one))
    return markdown(head, "lrrrrrr", lines)


def differences() -> str:
    """What separates the two planners, both ways."""
    lines = [
        [
            row["planner"],
            str(row["setting"]),
            "" if isinstance(row["value"], float) else str(row["value"]),
            f"{row['found']:.0f} of {row['runs']:.0f}",
            percent(row["gap mean (%)"]),
            f"{row['checks mean'] / 1000:.1f}",
            f"{row['cpu mean (ms)']:.0f} ms",
        ]
        for row in read("plus", "differences").to_dict("records")
    ]
    head = ("planner", "setting", "value", "found", "gap", "thousand checks", "cpu")
    return markdown(head, "lllrrrr", lines)


TABLES: Mapping[str, Callable[[], str]] = {
    "gaps": gaps,
    "table 1": table_1,
    "contrasts": contrasts,
    "alignment": alignment,
    "times": times,
    "dynamic": dynamic,
    "differences": differences,
}


def shares() -> str:
    """How much of RRT*'s time goes into answering it in Python."""
    runs = pd.read_parquet(RESULTS / "paper-static" / "rows" / "runs.parquet")
    details = runs.loc[runs["variant"] == "ompl-rrtstar", "details"].map(json.loads)
    low, high = pd.Series([d["callback_share"] for d in details]).quantile([0.05, 0.95])
    return f"{low:.2f} to {high:.2f} of RRT*'s time"


def statements() -> str:
    """How many of the paper's statements come out of the reading, and of the plainest."""
    frame = read("readings-search", "statements")
    chosen, plain = (
        int((frame[f"{name}: comes out"] == "yes").sum()) for name in ("chosen", "plainest")
    )
    return f"{chosen} of {len(frame)} statements come out of it, {plain} of the plainest reading"


def verdicts() -> str:
    """How the paper's figures came out, in numbers."""
    words = read("paper", "paper-figures")["verdict"].value_counts()
    told = ("agrees", "better", "worse", "differs", "not comparable")
    counts = ", ".join(f"{words[w]} {w}" for w in told if w in words)
    return f"of {sum(words[w] for w in told if w in words)} figures {counts}"


SENTENCES: Mapping[str, Callable[[], str]] = {
    "shares": shares,
    "statements": statements,
    "verdicts": verdicts,
}


def folded(text: str) -> str:
    """Text without its line breaks."""
    return re.sub(r"\s+", " ", text)


if __name__ == "__main__":
    for name, make in (TABLES | SENTENCES).items():
        sys.stdout.write(f"## {name}\n\n{make()}\n\n")
