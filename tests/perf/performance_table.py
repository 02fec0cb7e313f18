"""The goals of performance, and how far the benchmarks of one `make perf` are from them.

python -m tests.perf.performance_table out/performance.json results/performance
"""

import json
import math
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from statistics import mean, median
from typing import Any, NamedTuple

import pandas as pd

from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.table import Table
from tests.perf.performance_figure import draw
from tests.perf.series import OMPL_PLANNERS, OURS, RIVALS, SCENES

AHEAD = dict.fromkeys(SCENES, 1.0) | {
    "maze": 100.0, "zigzag": 100.0, "double_u": 100.0,
    "unstructured": 3.0, "obstacles_20": 3.0, "obstacles_30": 3.0, "obstacles_40": 3.0,
}  # fmt: skip
"""How many times sooner than the best of OMPL's planners each of ours is to come within 1 %."""

WHOLE_RUN_MS = 10.0
TIMES_EXACT = 100.0
CHECK_GROWTH, RUN_GROWTH = 3.0, 6.0
GAP_PERCENT = {
    100: dict.fromkeys(SCENES, 0.5) | {"clustered": 1.0},
    400: dict.fromkeys(SCENES, 0.2),
}
MEMORY_MB = 5.0
WARM_S, COLD_S = 1.5, 40.0

EVERYWHERE = "each of the eight"

EXACT = 1e-9
"""Lengths that are equal differ by rounding; so a gap may even lie below 0."""


class Series(NamedTuple):
    """Times until a planner was within 1 % on a scene; None where it did not come there.

    median_s : of all seeds, also of those that were not run because the median was settled;
        infinite if more than half did not come there.
    """

    near_s: list[float | None]
    seeds: int
    limit_s: float

    @property
    def median_s(self) -> float:
        missing = [math.inf] * (self.seeds - len(self.near_s))
        return median([math.inf if s is None else s for s in self.near_s] + missing)

    @property
    def came(self) -> int:
        return sum(s is not None for s in self.near_s)

    @property
    def share(self) -> str:
        return f"{self.came} of {len(self.near_s)}"


class Measured:
    """The benchmarks of one run of `make perf`, found by what they measure."""

    def __init__(self, record: Mapping[str, Any]) -> None:
        self.provenance: dict[str, Any] = record["machine_info"].get("provenance", {})
        self._found = {
            _key(b["extra_info"]): b for b in record["benchmarks"] if "measure" in b["extra_info"]
        }

    def median_s(self, measure: str, **of: Any) -> float | None:
        """Median of the rounds, seconds; None if it was not measured."""
        found = self._found.get(_key({"measure": measure, **of}))
        return None if found is None else float(found["stats"]["median"])

    def info(self, measure: str, **of: Any) -> dict[str, Any]:
        """What a benchmark kept beside its times; empty if it was not measured."""
        found = self._found.get(_key({"measure": measure, **of}))
        return {} if found is None else dict(found["extra_info"])

    def near(self, planner: str, scene: str) -> Series | None:
        info = self.info("time to 1 %", planner=planner, scene=scene)
        return Series(info["near_s"], info["seeds"], info["limit_s"]) if info else None


def _key(info: Mapping[str, Any]) -> tuple[Any, ...]:
    return tuple(info.get(k) for k in ("measure", "scene", "planner", "resolution", "obstacles"))


class Row(NamedTuple):
    """A goal on a scene.

    sign : "<=" or ">=": on which side of the goal the measured value must lie.
    measured : None if it was not measured; infinite if no run came there.
    is_bound : the true value lies beyond the measured one, on the side of the sign.
    """

    goal: str
    scene: str
    unit: str
    sign: str
    wanted: float
    measured: float | None
    remark: str = ""
    is_bound: bool = False

    @property
    def margin(self) -> float | None:
        """How many times better than wanted; below 1 the goal is not reached."""
        if self.measured is None:
            return None
        if self.sign == ">=":
            return self.measured / self.wanted
        if self.measured <= EXACT:
            return math.inf
        return self.wanted / self.measured

    @property
    def reached(self) -> str:
        margin = self.margin
        if margin is None:
            return "not measured"
        if margin >= 1.0:
            return "yes"
        if self.is_bound:
            return "undecided"
        if margin <= 0.0:
            return "no"
        off = 1.0 / margin
        return f"no, {off:,.0f} times off" if off >= 1000.0 else f"no, {off:.3g} times off"


def goals(measured: Measured) -> list[Row]:
    """Every goal on every scene."""
    return [
        *_ahead(measured), *_whole_runs(measured), *_limit(measured), *_growth(measured),
        *_quality(measured), *_memory(measured), *_start_up(measured),
    ]  # fmt: skip


def _ahead(measured: Measured) -> Iterator[Row]:
    for planner in OURS:
        for scene in SCENES:
            yield _ahead_on(measured, planner, scene)


def _ahead_on(measured: Measured, planner: str, scene: str) -> Row:
    goal = f"time to 1 %: the best of OMPL's planners over {planner}"
    ours = measured.near(planner, scene)
    series = {p: s for p in RIVALS if (s := measured.near(p, scene))}
    if ours is None or not series:
        return Row(goal, scene, "times", ">=", AHEAD[scene], None)
    best = min(series, key=lambda p: (series[p].median_s, -series[p].came / series[p].seeds))
    theirs = min(series[best].median_s, series[best].limit_s)
    none = math.isinf(series[best].median_s)
    remark = (
        f"none within {series[best].limit_s:g} s in the median: at least"
        if none
        else f"{best}: {_ms(theirs)} ms, {series[best].share} runs"
    )
    if math.isinf(ours.median_s):
        remark += f"; more than half of {planner}'s runs never come there: {ours.share} do"
        return Row(goal, scene, "times", ">=", AHEAD[scene], 0.0, remark)
    remark += f"; {planner}: {_ms(ours.median_s)} ms, {ours.share}"
    row = Row(goal, scene, "times", ">=", AHEAD[scene], theirs / ours.median_s, remark, none)
    first = measured.median_s("first generation", planner=planner, scene=scene)
    if row.reached == "yes" or not first:
        return row
    return row._replace(
        remark=f"{remark}; its set-up and one generation alone take {_ms(first)} ms"
    )


def _whole_runs(measured: Measured) -> Iterator[Row]:
    for planner in OURS:
        for scene in SCENES:
            of = {"planner": planner, "scene": scene}
            took, info = measured.median_s("whole run", **of), measured.info("whole run", **of)
            best_s = info.get("best_s")
            remark = f"best path after {_ms(best_s)} ms; the rest confirms it" if best_s else ""
            goal = f"whole default run of {planner}, median"
            yield Row(goal, scene, "ms", "<=", WHOLE_RUN_MS, _in_ms(took), remark)


def _limit(measured: Measured) -> Iterator[Row]:
    for planner in OURS:
        for scene in SCENES:
            ours = measured.near(planner, scene)
            exact = measured.median_s("exact solver", scene=scene)
            first = measured.median_s("first generation", planner=planner, scene=scene)
            ratio = ours.median_s / exact if ours and exact else None
            remark = f"exact solver: {_ms(exact)} ms" if exact else ""
            remark += f"; set-up and one generation of {planner}: {_ms(first)} ms" if first else ""
            goal = f"time to 1 % of {planner} over the exact solver's time"
            yield Row(goal, scene, "times", "<=", TIMES_EXACT, ratio, remark)


def _growth(measured: Measured) -> Iterator[Row]:
    few, many = (measured.median_s("1000 checks", obstacles=n) for n in (20, 3000))
    ratio = many / few if few and many else None
    remark = f"{few * 1e6:.0f} and {many * 1e6:.0f} ns a check" if few and many else ""
    scene = "3,000 obstacles over 20"
    yield Row("growth of a collision check", scene, "times", "<=", CHECK_GROWTH, ratio, remark)
    measure = "whole run among scattered"
    scenes = [f"scattered_{n}" for n in (20, 3000)]
    few, many = (measured.median_s(measure, planner="kbga-plus", scene=s) for s in scenes)
    ratio = many / few if few and many else None
    remark = f"{_ms(few)} and {_ms(many)} ms" if few and many else ""
    infos = [measured.info(measure, planner="kbga-plus", scene=s) for s in scenes]
    for count in ("generations", "checks"):
        counts = [info.get(count) for info in infos]
        if None not in counts:
            remark += f"; {counts[0]:,.0f} and {counts[1]:,.0f} {count}"
    yield Row("growth of a whole run", scene, "times", "<=", RUN_GROWTH, ratio, remark)


def _quality(measured: Measured) -> Iterator[Row]:
    for resolution, wanted in sorted(GAP_PERCENT.items(), reverse=True):
        for scene in SCENES:
            info = measured.info("gap", scene=scene, resolution=resolution)
            gaps = [100.0 * gap for gap in info.get("gaps", [])]
            goal = f"mean gap at resolution {resolution}"
            gap = mean(gaps) if gaps else None
            remark = f"from {abs(min(gaps)):.3f} to {abs(max(gaps)):.3f} %" if gaps else ""
            yield Row(goal, scene, "%", "<=", wanted[scene], gap, remark)
    for resolution in sorted(GAP_PERCENT, reverse=True):
        infos = [measured.info("gap", scene=s, resolution=resolution) for s in SCENES]
        found = {s: float(len(i["gaps"])) for s, i in zip(SCENES, infos, strict=True) if i}
        goal = f"feasible runs of 20 at resolution {resolution}, fewest"
        yield _everywhere(goal, "runs", ">=", 20.0, found)


def _memory(measured: Measured) -> Iterator[Row]:
    peaks = {s: measured.info("memory", scene=s).get("peak_bytes") for s in SCENES}
    megabytes = {s: peak / 1e6 for s, peak in peaks.items() if peak is not None}
    yield _everywhere("memory of a whole run, most", "MB", "<=", MEMORY_MB, megabytes)
    counts = {s: measured.info("allocations", scene=s).get("per_generation") for s in SCENES}
    made = {s: count for s, count in counts.items() if count is not None}
    row = _everywhere("allocations of compiled code per generation, most", "", "<=", 0.0, made)
    if row.reached == "no":
        remark = "of compiled code, also where Python calls it"
        row = row._replace(remark=f"{row.remark}; {remark}")
    yield row


def _everywhere(goal: str, unit: str, sign: str, wanted: float, found: Mapping[str, float]) -> Row:
    """One row for all scenes: that of the worst."""
    if set(found) < set(SCENES):
        return Row(goal, EVERYWHERE, unit, sign, wanted, None)
    worst = (min if sign == ">=" else max)(found, key=lambda scene: found[scene])
    row = Row(goal, EVERYWHERE, unit, sign, wanted, found[worst])
    return row if row.reached == "yes" else row._replace(remark=worst)


def _start_up(measured: Measured) -> Iterator[Row]:
    warm = measured.median_s("start-up, warm cache")
    cold = measured.median_s("start-up, first compilation")
    yield Row("kbga-bench plan, warm cache", "zigzag", "s", "<=", WARM_S, warm)
    yield Row("kbga-bench plan, empty cache", "zigzag", "s", "<=", COLD_S, cold)


def _in_ms(seconds: float | None) -> float | None:
    return None if seconds is None else 1e3 * seconds


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.3g}"


def goals_table(measured: Measured) -> Table:
    """A row per goal and scene."""
    rows = goals(measured)
    met = sum(row.reached == "yes" for row in rows)
    frame = pd.DataFrame(
        {
            "goal": [row.goal for row in rows],
            "scene": [row.scene for row in rows],
            "unit": [row.unit for row in rows],
            "wanted": [f"{row.sign} {row.wanted:g}" for row in rows],
            "measured": [row.measured for row in rows],
            "times better": [None if row.margin == math.inf else row.margin for row in rows],
            "reached": [row.reached for row in rows],
            "remark": [row.remark for row in rows],
        }
    )
    return Table(
        "performance",
        f"Goals of performance: {met} of {len(rows)} reached",
        frame,
        "Measured in one process on one machine: ratios say more than milliseconds. "
        "`times better` than wanted: below 1 the goal is not reached. Memory is the peak of what "
        "numpy and Python allocate; compiled code owns no arrays. "
        "`undecided`: no OMPL planner came within 1 % before its time was up, and that is not "
        "long enough to show the factor.",
    )


def times_table(measured: Measured) -> Table:
    """A row per scene and planner: when it was within 1 % of the optimum."""
    rows = []
    for scene in SCENES:
        for planner in (*OURS, *RIVALS):
            series = measured.near(planner, scene)
            if series is None:
                continue
            time_s = min(series.median_s, series.limit_s)
            rows.append(
                {
                    "scene": scene,
                    "planner": planner,
                    "sign": ">" if math.isinf(series.median_s) else "=",
                    "time to 1 % (ms)": 1e3 * time_s,
                    **{f"over {o}": _over(time_s, measured.near(o, scene)) for o in OURS},
                    "runs within 1 %": series.share,
                }
            )
    return Table(
        "time_to_1_percent",
        "Time until the best path is within 1 % of the exact optimum",
        pd.DataFrame(rows),
        "Median of 20 seeds. `>`: more than half of the runs did not come there within the time "
        "that stands there, or ended before; then the ratio is the least that it can be. A series "
        "ends when 11 of its runs have failed, because that settles the median. No ratio stands "
        "beside a planner of ours that did not come there itself. `-tuned`: with the settings that "
        "did best in the matrix ompl-tuning, on other scenes. OMPL's planners call the suite's "
        "collision check through Python: `callback_share` in the rows of a run.",
    )


def _over(time_s: float, ours: Series | None) -> float | None:
    """How many times as long as ours; None where ours did not come there in the median."""
    return None if ours is None or math.isinf(ours.median_s) else time_s / ours.median_s


def write(measured: Measured, folder: Path) -> list[Path]:
    """Write the tables, the figure and the manifest."""
    folder.mkdir(parents=True, exist_ok=True)
    tables = [goals_table(measured), times_table(measured)]
    texts = {
        "performance.md": "\n".join(render(table, TableFormat.MARKDOWN) for table in tables),
        **{f"{table.name}.csv": render(table, TableFormat.CSV) for table in tables},
        "manifest.json": json.dumps(measured.provenance, indent=2) + "\n",
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    picture = folder / "time_to_1_percent.png"
    draw(
        {
            (planner, scene): (series.near_s, series.median_s, series.limit_s)
            for planner in (*OURS, *OMPL_PLANNERS)
            for scene in SCENES
            if (series := _better(measured, planner, scene))
        },
        {s: t for s in SCENES if (t := measured.median_s("exact solver", scene=s))},
        picture,
    )
    return [*(folder / name for name in texts), picture]


def _better(measured: Measured, planner: str, scene: str) -> Series | None:
    """The series of a planner as it is or as it is tuned, whichever comes sooner."""
    found = [measured.near(name, scene) for name in (planner, f"{planner}-tuned")]
    return min((s for s in found if s), key=lambda s: s.median_s, default=None)


def main(record: str, folder: str) -> None:
    """Read pytest-benchmark's JSON, write the results and print the tables."""
    measured = Measured(json.loads(Path(record).read_text(encoding="utf-8")))
    for path in write(measured, Path(folder)):
        sys.stdout.write(f"{path}\n")
    for table in (times_table(measured), goals_table(measured)):
        sys.stdout.write("\n" + render(table, TableFormat.TABLE))


if __name__ == "__main__":
    main(*sys.argv[1:])
