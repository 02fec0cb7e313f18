"""Tables and figures of the READMEs, made from results/ and the matrices: a test holds the pages.

python -m tests.readme writes them into the pages. A table stands behind ``<!-- table: NAME -->``; a
sentence is found by its words, and gets its figures. One whose words no longer stand anywhere is
named: it has to be put in by hand.
"""

import json
import re
import sys
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import fields
from importlib.metadata import entry_points
from pathlib import Path

import numpy as np
import pandas as pd

from suite.conformance.rules import RULES
from suite.report.statistics.inference import critical_difference

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "results"
PAGES = (
    ROOT / "README.md",
    *(
        page
        for top in ("baselines", "kbga", "results", "suite")
        for page in sorted((ROOT / top).rglob("README.md"))
    ),
)
EXACT = {"visibility-graph", "extremitypathfinder", "polyanya"}
OMPL = "ompl-"


def read(campaign: str, name: str) -> pd.DataFrame:
    """Return a table of a campaign."""
    return pd.read_csv(RESULTS / campaign / f"{name}.csv")


def rows(campaign: str) -> pd.DataFrame:
    """Return the runs of a campaign."""
    return pd.read_parquet(RESULTS / campaign / "rows" / "runs.parquet")


def markdown(head: Sequence[str], align: str, lines: Iterable[Sequence[str]]) -> str:
    """Return a table; ``align`` has a letter for each column."""
    rule = "|" + "|".join("---:" if a == "r" else "---" for a in align) + "|"
    first, *others = ["| " + " | ".join(cells) + " |" for cells in (head, *lines)]
    return "\n".join([first, rule, *others])


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
    for scene, here in frame.groupby("scene", sort=False):
        if str(scene).endswith("_aligned"):  # controls: they have columns of their own
            continue
        cells = [str(scene)]
        for planner in ("kbga", "kbga-plus"):
            (row,) = here[here["planner"] == planner].to_dict("records")
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
    ranked = read("all-planners", "ranking-rows")
    column = "time to 1 % median (ms)"
    lines = []
    for scene, here in ranked.groupby("scene", sort=False):
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


def settings() -> str:
    """The settings of the baselines: defaults, and what is called tuned."""
    matrix = ROOT / "suite" / "harness" / "matrices" / "all-planners.toml"
    variants = tomllib.loads(matrix.read_text(encoding="utf-8"))["planner"]
    tuned = {v["planner"]: v["settings"] for v in variants if v.get("name", "").endswith("-tuned")}
    lines = []
    for plugin in entry_points(group="kbga_bench.planners"):
        if plugin.module.startswith("baselines."):
            named = fields(plugin.load().Settings)
            # What has none of ours is left to the package, or off.
            defaults = (
                f.name if f.default is None else f"{f.name} = {json.dumps(f.default)}"
                for f in named
            )
            others = (f"{k} = {json.dumps(v)}" for k, v in tuned.get(plugin.name, {}).items())
            lines.append([f"`{plugin.name}`", ", ".join(defaults), ", ".join(others)])
    return markdown(("planner", "settings", "tuned"), "lll", sorted(lines))


def maps() -> str:
    """Real maps: KBGA-plus, the best of OMPL's planners and the exact ones."""
    lines = []
    for scene, here in read("real-maps", "maps-rows").groupby("scene", sort=False):
        rows_of = here.set_index("planner")
        ours, theirs = rows_of.loc["kbga-plus"], rows_of[rows_of.index.str.startswith("ompl-")]
        surest = theirs.sort_values(["success (%)", "gap mean (%)"], ascending=[False, True]).iloc[
            0
        ]
        soonest = theirs.loc[theirs["to 1 % (ms)"].idxmin()]
        exact = rows_of.loc[["visibility-graph", "polyanya"], "to 1 % (ms)"]
        lines.append(
            [
                str(scene),
                _fared(ours),
                _ms(ours["to 1 % (ms)"]),
                f"{_briefly(surest.name)}: {_fared(surest)}",
                f"{_briefly(soonest.name)}: {_ms(soonest['to 1 % (ms)'])}",
                f"{exact.idxmin()}: {_ms(exact.min())}",
            ]
        )
    head = ("map", "kbga-plus", "to 1 %", "OMPL, surest", "OMPL, soonest to 1 %", "exact")
    return markdown(head, "llrlll", lines)


def _fared(row: pd.Series) -> str:
    """Queries solved, and the median and the worst gap of a planner on a map."""
    median, worst = (percent(row[f"gap {which} (%)"]) for which in ("median", "worst"))
    return f"{row['solved']} solved, {median}, worst {worst}"


def _briefly(planner: object) -> str:
    return str(planner).removeprefix("ompl-").removesuffix("-tuned")


def rivals() -> str:
    """Mean gaps, and times to 1 %, over turned twins of each scene."""
    frame = read("rivals", "ranking-rows")
    frame["of"] = frame["scene"].str.partition("@")[0]
    lines = []
    for scene, here in frame.groupby("of", sort=False):
        gaps = here.groupby("planner")["gap median (%)"].mean()
        times = here.groupby("planner")["time to 1 % median (ms)"].median()
        ours, others = "kbga-plus", [p for p in gaps.index if p not in (*EXACT, "kbga-plus")]
        nearest, soonest = gaps[others].idxmin(), times[others].idxmin()
        exact = times[[p for p in EXACT if p in times]].min()
        lines.append(
            [
                str(scene),
                percent(gaps[ours]),
                f"{_briefly(nearest)}: {percent(gaps[nearest])}",
                _ms(times[ours]),
                f"{_briefly(soonest)}: {_ms(times[soonest])}"
                if np.isfinite(times[soonest])
                else "never",
                _ms(exact),
            ]
        )
    head = ("scene", "kbga-plus", "nearest rival", "to 1 %", "soonest rival", "exact")
    return markdown(head, "lrlrlr", lines)


def off_lattice() -> str:
    """What each thing that leads KBGA-plus off the lattice brings, over scenes and over maps."""
    on_scenes, on_maps = rows("kbga-plus"), rows("kbga-plus-maps")
    lines = []
    for planner in on_scenes["variant"].unique():
        cells = [planner.removeprefix("kbga-plus-").replace("kbga-plus", "as it is")]
        for runs in (on_scenes, on_maps):
            here = runs[runs["variant"] == planner]
            gap = 100.0 * (here["cost"] / here["optimum"] - 1.0).dropna()
            cells += [f"{len(gap)} of {len(here)}", percent(gap.mean()), percent(gap.max())]
        lines.append(cells)
    on = ("solved", "gap", "worst")
    head = ("kbga-plus", *(f"{w}, {c}" for w in ("scenes", "maps") for c in on))
    return markdown(head, "lrrrrrr", lines)


TABLES: Mapping[str, Callable[[], str]] = {
    "gaps": gaps,
    "table 1": table_1,
    "contrasts": contrasts,
    "alignment": alignment,
    "times": times,
    "dynamic": dynamic,
    "differences": differences,
    "settings": settings,
    "maps": maps,
    "rivals": rivals,
    "off the lattice": off_lattice,
}


def shares() -> str:
    """How much of RRT*'s time goes into answering it in Python."""
    runs = rows("paper-static")
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


def bench() -> str:
    """How many runs `make bench` makes."""
    return f"paper-static ({len(rows('paper-static'))} runs)"


def ranks() -> str:
    """How far apart mean ranks must be."""
    planners = len(read("all-planners", "ranking"))
    scenes = rows("all-planners")["scene"].nunique()
    apart = critical_difference(planners, scenes)
    return (
        f"Among the {planners} planners and settings of `all-planners`, mean ranks must be "
        f"{apart:.1f} of {planners - 1} apart to differ"
    )


def nearer() -> str:
    """On how many scenes OMPL's best end nearer to the optimum than kbga-plus."""
    summary = read("all-planners", "summary")
    gaps = summary.pivot_table("gap median (%)", index="scene", columns="planner")
    shortcut, informed, tuned = (
        int((gaps[f"ompl-{name}"] < gaps["kbga-plus"]).sum())
        for name in ("shortcut", "informedrrtstar-tuned", "rrtstar-tuned")
    )
    return (
        f"`ompl-shortcut` ends nearer to the optimum than `kbga-plus` on {shortcut} of {len(gaps)} "
        f"scenes, tuned Informed RRT* on {informed}, tuned RRT* on {tuned}"
    )


def sooner() -> str:
    """On how many scenes kbga-plus is the soonest within 1 %, but for the exact ones."""
    ranked = read("all-planners", "ranking-rows").query("planner not in @EXACT")
    times = ranked.pivot_table("time to 1 % median (ms)", index="scene", columns="planner")
    first = times[np.isfinite(times).any(axis=1)].idxmin(axis=1)
    number = int((first == "kbga-plus").sum())
    return f"`kbga-plus` comes first but for the exact solvers on {number} of {len(times)} scenes"


def every_planner() -> str:
    """How many planners come with the suite."""
    return f"runs the {rows('all-planners')['planner'].nunique()} planners that come with the suite"


def rules() -> str:
    """How many rules a planner is checked by."""
    return f"# {len(RULES)} rules; how to mend"


def simulated() -> str:
    """How many robots drove."""
    return f"In all {read('paper-dynamic', 'simulations')['runs'].sum()} runs of all planners"


def experiments() -> str:
    """How often an obstacle that has no impact changes the path all the same."""
    frame = read("paper-dynamic", "paper-dynamic")
    (row,) = frame[frame["what it shows"].str.startswith("B is detected")].to_dict("records")
    return f"shorter in {row['runs'] - row['ours so']} of {row['runs']}"


def answers() -> str:
    """How fast robots were answered among the unknown obstacles, and how far one went for it."""
    answered, fared = (
        read("paper-dynamic", name).query("world == 'section III-E'").set_index("planner")
        for name in ("replanning", "simulations")
    )
    latency = answered["latency median (ms)"]
    soonest, exact = latency["ompl-rrtconnect"], latency["visibility-graph"]
    way = 1.0 + fared["above exact (%)"]["ompl-rrtconnect"] / 100.0
    return (
        f"`kbga-plus` takes {latency['kbga-plus'] / soonest:.1f} times as long to answer as "
        f"RRT-Connect, and {latency['kbga-plus'] / exact:.0f} times as long as the exact solver; "
        f"RRT-Connect's robot goes {way:.1f} times the exact way"
    )


def ablation() -> str:
    """What KBGA owes to crossover and mutation on zigzag."""
    frame = read("ablation", "study-ablation-rows").query("settings == 'kbga'")
    gap = frame[frame["scene"] == "zigzag"].set_index("switched off")["gap mean (%)"]
    return f"comes to {gap['crossover, mutation']:.2f} % on `zigzag`, not {gap['nothing']:.2f} %"


def resolution() -> str:
    """What finer lattices bring, and cost."""
    frame = read("resolution", "study-resolution-rows").set_index(["planner", "scene"])
    gaps = ", ".join(f"{v:.2f}" for v in frame.loc[("kbga", "zigzag"), "gap mean (%)"])
    times = frame.loc[("kbga", "unstructured")]
    return (
        f"`kbga` comes to {gaps} % on `zigzag`, which is what the lattice allows; times "
        f"hardly rise (the paper's go as {_ratio(times['paper ratio'])} on `unstructured`, "
        f"`kbga`'s as {_ratio(times['ratio total'])})"
    )


def obstacles() -> str:
    """What more obstacles cost."""
    frame = read("obstacles", "study-obstacles").set_index(["planner", "obstacles"])
    of_ours, of_plus = frame.loc["kbga"], frame.loc["kbga-plus"]
    few, most = of_ours.loc[[20, 30, 40]], 3000
    return (
        f"`kbga`'s times go as {_ratio(few['ratio total'])}, the paper's as "
        f"{_ratio(few['paper ratio'])}; among 3,000 they are "
        f"{of_ours['ratio total'][most]:.0f} times those among 20, `kbga-plus`'s "
        f"{of_plus['ratio total'][most]:.0f} times, at gaps of "
        f"{of_ours['gap mean (%)'][most]:.1f} and {of_plus['gap mean (%)'][most]:.1f} %"
    )


def _ratio(values: Iterable[float]) -> str:
    return " : ".join(f"{value:.2f}".removesuffix(".00") for value in values)


def mutation_rate() -> str:
    """The plain GA's best mutation rate by the paper's way of choosing."""
    row = read("mutation-rate", "study-mutation-rate-best").set_index("scene").loc["zigzag"]
    best, theirs = row["best mutation rate"], row["paper's best"]
    found = f"{row['feasible, best']:.0f} of 20 paths"
    return f"on `zigzag`, {best:g} is best here ({found}) and {theirs:g} there"


def one_round() -> str:
    """What one round of the specialised operators does in the maze."""
    found = read("readings", "summary").set_index(["scene", "planner"])["solved"]
    whole, without = (
        found[("maze", f"kbga-plain-rounds{end}")]
        for end in ("", "-without-crossover-and-mutation")
    )
    return (
        f"{whole} of 20 ways through the `maze`, and {without} of 20 without crossover and mutation"
    )


SENTENCES: Mapping[str, Callable[[], str]] = {
    make.__name__: make
    for make in (
        shares,
        statements,
        verdicts,
        bench,
        ranks,
        nearer,
        sooner,
        every_planner,
        rules,
        simulated,
        experiments,
        answers,
        ablation,
        resolution,
        obstacles,
        mutation_rate,
        one_round,
    )
}

TABLE = re.compile(r"<!-- table: (.+?) -->\n\n(?:\|.*\n)*\n?")
FIGURE = re.compile(r"\d+(?:[.,]\d+)*")


def rewritten(page: str) -> str:
    """A page with its tables and the figures of its sentences as results/ has them."""
    page = TABLE.sub(lambda found: f"<!-- table: {found[1]} -->\n\n{TABLES[found[1]]()}\n\n", page)
    for make in SENTENCES.values():
        page = with_figures(page, make())
    return page


def with_figures(page: str, sentence: str) -> str:
    """A page with the figures of a sentence, where its words stand, however they are wrapped."""
    words = [r"\s+".join(map(re.escape, re.split(r"\s+", w))) for w in FIGURE.split(sentence)]

    def filled(found: re.Match[str]) -> str:
        figures = iter(FIGURE.findall(sentence))
        return FIGURE.sub(lambda _: next(figures), found[0])

    return re.sub(FIGURE.pattern.join(words), filled, page)


def pages() -> str:
    """All pages, one after the other."""
    return "\n".join(page.read_text(encoding="utf-8") for page in PAGES)


def folded(text: str) -> str:
    """Text without its line breaks."""
    return re.sub(r"\s+", " ", text)


if __name__ == "__main__":
    for file in PAGES:
        before = file.read_text(encoding="utf-8")
        after = rewritten(before)
        file.write_text(after, encoding="utf-8")
        sys.stdout.write(f"{file.relative_to(ROOT)}: {'same' if after == before else 'changed'}\n")
    for name, make in SENTENCES.items():
        if make() not in folded(pages()):
            sys.stdout.write(f"{name} stands nowhere: {make()}\n")
