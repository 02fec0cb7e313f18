"""Which reading of the paper, where it is silent, brings its statements nearest.

python -m tests.perf.readings results/readings-search [--seeds 5] [--jobs 2]

The rule, written down before the first search (what was changed then is said in 4):

1. What the paper says stays as it says it. What it leaves open are the CHOICES below. The search
   begins at the plainest reading, which takes the first of each.
2. A reading is run on the paper's scenes with seeds that no table uses, whole and ablated as in
   section IV, and measured by STATEMENTS: what the paper reports that its own scenes, and not our
   drawing of them, decide. Costs count as the excess of the mean over the best run, for our scenes
   are drawn to the paper's best cost.
3. A statement is missed by 0 to 1: a number by the logarithm of ours over the paper's, a factor of
   two or more being 1; a success rate by its difference. The distance of a reading is the sum. Each
   statement counts the same, but that all runs of the whole algorithm find a path counts
   three times: without it, there is no algorithm to speak of.
4. Choice by choice, in the order below, the value of the least distance is taken; of equal ones,
   the earlier. So again until a whole round changes nothing, or ROUNDS are done; and once more from
   each of OTHER_STARTS. The nearest of all that were tried is the paper's algorithm here.
   Changed twice, and open to see: a first search without the corners, over 62 readings, found none
   that has a path in the maze; so the corners were let in, and a larger C. A second one, over 61,
   went away from the few that had, as the maze was one statement among 23; so success counts three
   times, and the third start was added, which has the corners.
5. Then the chosen one and the plainest run again, with twenty other seeds: the figures of these are
   what is reported, for the best of many is flattered by the seeds that it was chosen with.
"""

import argparse
import json
import math
import sys
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from statistics import mean, median, stdev
from typing import Any

import numpy as np
import pandas as pd

from kbga import KBGA, KBGASettings
from suite.scenes.catalogue import load_scene

CHOICES: Mapping[str, tuple[Any, ...]] = {
    "repair_reach": (1, 2, 0),
    # "Small-scale local search": so the plainest is no search round a whole wall.
    "repair_candidates": (64, 16),
    "repair_must_help": (False, True),
    "rounds": (1, 2),
    "one_operator": (False, True),
    "improvement_radius": (0, 8),
    "tournament_size": (2, 3, 5),
    "initial_nodes": (4, 8, 16),
    "penalty": (10.0, 1.0, 30.0, 140.0, 1000.0),
    "stagnation": (15, 30),
    "generations_counted": ("best", "stop"),
}
"""Each silent choice, the plainest value first. A reach of 0 are the grids next to an obstacle's
corners: the last of three, for the paper has those next to the obstacle. Memory is no choice: the
paper draws nodes at random."""

OTHER_STARTS: tuple[Mapping[str, Any], ...] = (
    {
        "repair_reach": 2,
        "repair_must_help": True,
        "one_operator": True,
        "tournament_size": 3,
        "initial_nodes": 16,
    },
    {
        "repair_reach": 0,
        "repair_candidates": 16,
        "one_operator": True,
        "improvement_radius": 8,
        "tournament_size": 3,
        "initial_nodes": 16,
        "penalty": 140.0,
    },
)
"""What was nearest to single statements when they were looked at one by one: the generations of the
zigzag, and a maze that needs crossover. The rest as in the plainest."""

ROUNDS = 2
FIRST_SEED, LAST_LOOK_SEED, LAST_LOOK_SEEDS = 1000, 2000, 20
"""Of the search, and of the last look: tables use the seeds from 0 on."""

# Two and a half times what the paper's runs need, and 1.7 times for the ablated ones: what has no
# path by then has none.
WHOLE: Mapping[str, Any] = {"max_generations": 150}
NO_CROSSOVER: Mapping[str, Any] = {
    "crossover_probability": 0.0,
    "mutation_probability": 0.0,
    "max_generations": 300,
}
# Section IV: only crossover and mutation, at the mutation rate that is best for it.
PLAIN: Mapping[str, Any] = {
    "repair_probability": 0.0,
    "deletion_probability": 0.0,
    "improvement_probability": 0.0,
    "mutation_probability": 0.5,
    "stagnation": 200,
}
ABLATIONS = {"whole": WHOLE, "no crossover": NO_CROSSOVER, "plain": PLAIN}
GROUPS = (
    ("unstructured", "whole"),
    ("maze", "whole"),
    ("zigzag", "whole"),
    ("double_u", "whole"),
    ("zigzag", "no crossover"),
    ("maze", "no crossover"),
    ("zigzag", "plain"),
    ("maze", "plain"),
)


@dataclass(frozen=True, slots=True)
class Statement:
    """Something that the paper reports, and how it is read off our runs.

    group : scene and ablation.
    paper : its figure.
    ours : from the runs of the group and the reading to ours.
    is_share : a rate between 0 and 1 is missed by a difference, any other number by a ratio.
    weight : how often it counts.
    """

    name: str
    group: tuple[str, str]
    paper: float
    ours: Callable[[Sequence[dict[str, float]], Mapping[str, Any]], float]
    is_share: bool = False
    weight: float = 1.0


def feasible(runs: Sequence[dict[str, float]], _: Mapping[str, Any]) -> float:
    """Share of runs that found a path."""
    return mean(run["feasible"] for run in runs)


def generations(runs: Sequence[dict[str, float]], reading: Mapping[str, Any]) -> float:
    """Mean of generations needed, as the reading counts them."""
    return mean(counted(runs, reading))


def spread(runs: Sequence[dict[str, float]], reading: Mapping[str, Any]) -> float:
    """Standard deviation of generations needed."""
    return stdev(counted(runs, reading))


def counted(runs: Sequence[dict[str, float]], reading: Mapping[str, Any]) -> list[float]:
    return [run[reading["generations_counted"]] for run in runs]


def excess(runs: Sequence[dict[str, float]], _: Mapping[str, Any]) -> float:
    """Mean cost above that of the best run, percent, and a tenth: less is nothing to the paper."""
    costs = [run["cost"] for run in runs if run["feasible"]]
    return 0.1 + 100.0 * (mean(costs) / min(costs) - 1.0) if costs else math.inf


def cost(runs: Sequence[dict[str, float]], _: Mapping[str, Any]) -> float:
    """Mean cost over all runs, penalties included."""
    return mean(run["cost"] for run in runs)


def first(runs: Sequence[dict[str, float]], _: Mapping[str, Any]) -> float:
    """Best cost of the first population, median run."""
    return median(run["first"] for run in runs)


def above(typical: float, best: float) -> float:
    """As :func:`excess` of the paper's figures."""
    return 0.1 + 100.0 * (typical / best - 1.0)


STATEMENTS = (
    *(
        Statement(f"{scene}: all runs find a path", (scene, "whole"), 1.0, feasible, True, 3.0)
        for scene in ("unstructured", "maze", "zigzag", "double_u")
    ),
    Statement("unstructured: generations", ("unstructured", "whole"), 51, generations),
    Statement("unstructured: generations, sd", ("unstructured", "whole"), 16, spread),
    Statement("maze: generations", ("maze", "whole"), 43, generations),
    Statement("zigzag: generations", ("zigzag", "whole"), 52, generations),
    Statement("zigzag: generations, sd", ("zigzag", "whole"), 12, spread),
    Statement("double_u: generations", ("double_u", "whole"), 56, generations),
    Statement("unstructured: excess", ("unstructured", "whole"), above(117.91, 117.56), excess),
    Statement("maze: excess", ("maze", "whole"), above(418.65, 411.67), excess),
    Statement("zigzag: excess", ("zigzag", "whole"), above(156.31, 155.89), excess),
    Statement("double_u: excess", ("double_u", "whole"), above(152.44, 152.01), excess),
    Statement("unstructured: first best", ("unstructured", "whole"), 1043.25, first),
    Statement("maze: first best", ("maze", "whole"), 176.96, first),
    Statement("zigzag without crossover: a path", ("zigzag", "no crossover"), 1.0, feasible, True),
    Statement("zigzag without crossover: cost", ("zigzag", "no crossover"), 251.56, cost),
    Statement(
        "zigzag without crossover: generations", ("zigzag", "no crossover"), 174, generations
    ),
    Statement("maze without crossover: no path", ("maze", "no crossover"), 0.0, feasible, True),
    Statement("zigzag plain: cost", ("zigzag", "plain"), 352.35, cost),
    Statement("zigzag plain: generations", ("zigzag", "plain"), 346, generations),
    Statement("maze plain: no path", ("maze", "plain"), 0.0, feasible, True),
)


QUARTER, SHARE = math.log2(1.25), 0.15
"""A number comes out if it is missed by no more than a quarter, a share of runs by three of 20."""


def comes_out(statement: Statement, ours: float) -> bool:
    """Whether ours says what the paper says."""
    return missed(statement, ours) <= (SHARE if statement.is_share else QUARTER)


def missed(statement: Statement, ours: float) -> float:
    """How far ours is from the paper's, 0 to 1."""
    if statement.is_share:
        return abs(ours - statement.paper)
    if not 0.0 < ours < math.inf:
        return 1.0
    return min(1.0, abs(math.log2(ours / statement.paper)))


def run_group(
    reading: Mapping[str, Any], group: tuple[str, str], seeds: range
) -> list[dict[str, float]]:
    """Run one scene with one ablation of a reading."""
    scene_name, ablation = group
    scene = load_scene(scene_name)
    settings = KBGASettings(**{**reading, **ABLATIONS[ablation]})
    runs = []
    for seed in seeds:
        ga = KBGA(scene, settings=settings, rng=np.random.default_rng([seed, 0]))
        first_cost = ga.lowest_cost
        found = ga.run() is not None
        runs.append(
            {
                "feasible": float(found),
                "cost": ga.best_cost if found else ga.lowest_cost,
                "best": float(ga.generation_of_best if found else ga.generation_of_lowest),
                "stop": float(ga.generation),
                "first": first_cost,
            }
        )
    return runs


class Search:
    """Readings that were tried, each once, and how far they are from the paper.

    seeds : of the runs.
    pool : where they run.
    kept : file that keeps runs from one search to the next; None to keep none.
    """

    def __init__(self, seeds: range, pool: Executor, kept: Path | None) -> None:
        self.seeds = seeds
        self.pool = pool
        self.kept = kept
        self.rows: dict[str, dict[str, Any]] = {}
        self.runs: dict[str, list[list[dict[str, float]]]] = {}
        if kept is not None and kept.exists():
            for line in kept.read_text(encoding="utf-8").splitlines():
                self.runs |= json.loads(line)

    def figures(self, reading: Mapping[str, Any]) -> dict[str, float]:
        """Ours of each statement."""
        runs = dict(zip(GROUPS, self._runs_of(reading), strict=True))
        return {s.name: s.ours(runs[s.group], reading) for s in STATEMENTS}

    def distance(self, reading: Mapping[str, Any]) -> float:
        """Sum of what the statements are missed by."""
        key = json.dumps(reading)
        if key not in self.rows:
            ours = self.figures(reading)
            gaps = [s.weight * missed(s, ours[s.name]) for s in STATEMENTS]
            out = sum(comes_out(s, ours[s.name]) for s in STATEMENTS)
            self.rows[key] = {**reading, "distance": sum(gaps), "come out": out, **ours}
            sys.stderr.write(f"{sum(gaps):6.3f} {out:2d}  {reading}\n")
        return float(self.rows[key]["distance"])

    def _runs_of(self, reading: Mapping[str, Any]) -> list[list[dict[str, float]]]:
        # What is counted changes no run.
        key = json.dumps({k: v for k, v in reading.items() if k != "generations_counted"})
        if key not in self.runs:
            tasks = [self.pool.submit(run_group, reading, g, self.seeds) for g in GROUPS]
            self.runs[key] = [task.result() for task in tasks]
            if self.kept is not None:
                with self.kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps({key: self.runs[key]}) + "\n")
        return self.runs[key]

    def descend(self, reading: dict[str, Any]) -> dict[str, Any]:
        """Take the best value of each choice in turn until nothing changes."""
        for _ in range(ROUNDS):
            before = dict(reading)
            for name, values in CHOICES.items():
                tried = [{**reading, name: value} for value in values]
                reading = min(tried, key=self.distance)
            if reading == before:
                break
        return reading

    def table(self) -> pd.DataFrame:
        """All that were tried, the nearest first."""
        return pd.DataFrame(self.rows.values()).sort_values("distance", kind="stable")

    def nearest(self) -> dict[str, Any]:
        """The reading of the least distance."""
        key = min(self.rows, key=lambda k: self.rows[k]["distance"])
        return dict(json.loads(key))


PLAINEST = {name: values[0] for name, values in CHOICES.items()}


def last_look(readings: Mapping[str, Mapping[str, Any]], pool: Executor) -> pd.DataFrame:
    """Each statement, the paper's figure and those of some readings with seeds of their own."""
    seeds = range(LAST_LOOK_SEED, LAST_LOOK_SEED + LAST_LOOK_SEEDS)
    fresh = Search(seeds, pool, None)
    frame = pd.DataFrame(
        {"statement": [s.name for s in STATEMENTS], "paper": [s.paper for s in STATEMENTS]}
    )
    for name, reading in readings.items():
        ours = fresh.figures(reading)
        frame[name] = list(ours.values())
        frame[f"{name}: comes out"] = [
            "yes" if comes_out(s, ours[s.name]) else "no" for s in STATEMENTS
        ]
    return frame


def page(search: Search, statements: pd.DataFrame) -> str:
    """What was searched, what was chosen and what comes out, in Markdown."""
    chosen = search.nearest()
    choices = pd.DataFrame(
        {
            "choice": list(CHOICES),
            "plainest": [str(PLAINEST[name]) for name in CHOICES],
            "tried": [", ".join(map(str, values)) for values in CHOICES.values()],
            "chosen": [str(chosen[name]) for name in CHOICES],
        }
    )
    tried = search.table()
    here, plain = tried["distance"].iloc[0], search.rows[json.dumps(PLAINEST)]["distance"]
    rule = (__doc__ or "").split(" in 4):\n\n", 1)[1].strip()
    out = {
        name: int((statements[f"{name}: comes out"] == "yes").sum())
        for name in ("plainest", "chosen")
    }
    tried_note = (
        f"{len(tried)} readings were tried with {len(search.seeds)} seeds each. The plainest is "
        f"{plain:.2f} away from the paper, the chosen one {here:.2f}, of "
        f"{sum(s.weight for s in STATEMENTS):g}."
    )
    note = (
        f"With {LAST_LOOK_SEEDS} fresh seeds {out['chosen']} of {len(STATEMENTS)} statements come "
        f"out of the chosen reading, and {out['plainest']} of the plainest. A number comes out if "
        f"ours is within a quarter of the paper's, a share of runs within {SHARE}. Excess is the "
        "mean cost above the best run in per cent, plus 0.1; costs of ablated runs hold penalties."
    )
    parts = [
        "# Readings of the paper",
        "The rule of `tests/perf/readings.py`, and what was changed of it on the way:",
        rule,
        tried_note,
        choices.to_markdown(index=False, disable_numparse=True),
        note,
        statements.to_markdown(index=False, floatfmt=".4g"),
    ]
    return "\n\n".join(parts) + "\n"


def main() -> None:
    """Search, and write what was tried."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--kept", type=Path, default=Path("out/readings.jsonl"))
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    given.kept.parent.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(given.jobs) as pool:
        search = Search(range(FIRST_SEED, FIRST_SEED + given.seeds), pool, given.kept)
        for start in (PLAINEST, *({**PLAINEST, **other} for other in OTHER_STARTS)):
            search.descend(dict(start))
            search.table().to_csv(given.folder / "search.csv", index=False, float_format="%.6g")
        both = {"plainest": PLAINEST, "chosen": search.nearest()}
        statements = last_look(both, pool)
    statements.to_csv(given.folder / "statements.csv", index=False, float_format="%.6g")
    (given.folder / "README.md").write_text(page(search, statements), encoding="utf-8")


if __name__ == "__main__":
    main()
