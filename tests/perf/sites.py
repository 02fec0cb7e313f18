"""Whether it holds anywhere: random building sites at places on earth: `make sites`.

python -m tests.perf.sites results/sites [--draws 1000]

Each site is made at its place, and once more with its corner in the origin, moved without rounding.
What must hold: no traceback, nothing refused, no obstacle lost, the same optimum, and one verdict
by kernel, referee and shapely. Shapely judges in the coordinates of the origin, by the polygons as
they were drawn and not as our arrangement has them.
"""

import argparse
import sys
import traceback
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from zlib import crc32

import numpy as np
import pandas as pd
import shapely
from numpy.typing import NDArray

from suite.errors import SceneError
from suite.geometry.kernels import first_collision
from suite.planner import Budget, Planner, Recorder
from suite.plugins.discovery import load_planner, planner_names
from suite.referee.path import Referee
from suite.report.formats import render
from suite.report.kinds import TableFormat
from suite.report.table import Table
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Query, Scene, SceneWarning, make_scene
from tests.sites import PLACES, ROOMS, Site, draw_site, placed

SEGMENTS = 20
"""Random segments of each site on which kernel, referee and shapely must agree."""

TOO_COARSE = "Shift the scene towards (0, 0)."
"""What is said of a room that is too small for where it lies."""

PLANNED_CHECKS = 3000
"""Budget of a planner on a site."""

TRACEBACK = "traceback"

WORST_RELATIVE = 1e-6
"""How far the optimum at a place may lie from that at the origin."""


@dataclass(slots=True)
class Findings:
    """What was found of the sites of one place and one size.

    draws : sites.
    too_coarse : of them, refused because float64 can't tell their places apart where they lie.
    refused : of them, by any other error with words; each is one that should have been a scene.
    tracebacks : of them, by any other error.
    lost : sites in which a part of an obstacle is not closed.
    segments, disagreements : compared between kernel, referee and shapely; not the same.
    narrow : sites with a slit that is narrower than the grid of the place: it is closed there, as
        it need not be at the origin, so that their optima are not compared.
    worst : largest relative difference of an optimum from that at the origin.
    other : sites in which a query has a path here and none at the origin, or the other way round.
    messages : of what went wrong.
    """

    draws: int = 0
    too_coarse: int = 0
    refused: int = 0
    tracebacks: int = 0
    lost: int = 0
    segments: int = 0
    disagreements: int = 0
    narrow: int = 0
    worst: float = 0.0
    other: int = 0
    messages: list[str] = field(default_factory=list)

    @property
    def holds(self) -> bool:
        """Whether all is as it must be."""
        faults = (self.refused, self.tracebacks, self.lost, self.disagreements, self.other)
        return not any(faults) and self.worst <= WORST_RELATIVE


def sites(place: str, room: str, draws: int) -> Iterator[Site]:
    """The random sites of a place and a size, the same in each call."""
    return (placed(site, place, room) for site in drawn(place, room, draws))


def drawn(place: str, room: str, draws: int) -> Iterator[Site]:
    """The same, in whole units."""
    rng = np.random.default_rng([0, crc32(f"{place}/{room}".encode())])
    return (draw_site(rng) for _ in range(draws))


def as_scene(site: Site) -> Scene:
    """Make a scene of a site; what crosses the border is cut there."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SceneWarning)
        return make_scene("site", site.room, site.buildings, site.queries)


def examined(place: str, room: str, draws: int) -> Findings:
    """What is found of so many sites."""
    found = Findings()
    for number, units in enumerate(drawn(place, room, draws)):
        found.draws += 1
        site = placed(units, place, room)
        # At the origin itself, what can differ is the size.
        other = placed(units, place, "100 m") if place == "the origin" else site.at_origin()
        try:
            _examine(site, other, found, np.random.default_rng(number))
        except SceneError as error:
            if TOO_COARSE in str(error):
                found.too_coarse += 1
                continue
            found.refused += 1
            found.messages.append(f"{place}, {room}, site {number}: {error}")
        except Exception as error:
            where = traceback.extract_tb(error.__traceback__)[-1]
            found.tracebacks += 1
            found.messages.append(
                f"{place}, {room}, site {number}: {type(error).__name__}: {error} "
                f"in {where.name}, {Path(where.filename).name}"
            )
    return found


def _examine(site: Site, other: Site, found: Findings, rng: np.random.Generator) -> None:
    scene, origin = as_scene(site), as_scene(other)
    scale = site.unit / other.unit
    judges = Judges(scene, site, site.at_origin())
    if judges.has_lost():
        found.lost += 1
        found.messages.append(f"lost an obstacle of {site.buildings}")
    is_narrow = judges.sees_slit()
    found.narrow += is_narrow
    paths = []
    for query, same in zip(scene.queries, origin.queries, strict=True):
        here, there = shortest_path(scene, query), shortest_path(origin, same)
        if here.path is not None:
            paths.append(here.path)
        if is_narrow:
            continue
        if (here.path is None) != (there.path is None):
            found.other += 1
        elif here.path is not None:
            found.worst = max(found.worst, abs(here.length / (scale * there.length) - 1.0))
    for path in (*paths, *_segments(scene, site, rng)):
        found.segments += 1
        found.disagreements += not judges.agree(path)


def _segments(scene: Scene, site: Site, rng: np.random.Generator) -> list[NDArray[np.float64]]:
    """Random segments: half of them from anywhere, half of them from corners of buildings."""
    low, high = np.reshape(scene.bounds, (2, 2))
    corners = shapely.get_coordinates(site.buildings)
    ends = rng.uniform(low, high, (SEGMENTS, 2, 2))
    ends[::2, 0] = corners[rng.integers(len(corners), size=len(ends[::2]))]
    return [segment for segment in ends if np.all((low <= segment) & (segment <= high))]


class Judges:
    """Kernel, referee and shapely, on one site.

    Shapely knows what is surely closed and what is surely free, but for the width by which the
    arrangement may move a wall; in between it has no opinion.
    """

    def __init__(self, scene: Scene, site: Site, twin: Site) -> None:
        self._scene = scene
        self._corner = site.corner
        self._twin = twin
        self._referee = Referee(scene)
        self._width = 2.0 * scene.coordinates.grid
        around = twin.room.buffer(0.2 * twin.room.length).difference(twin.room)
        drawn = shapely.union_all([p.intersection(twin.room) for p in twin.buildings])
        self._drawn = drawn
        # Not as one: their union may lose a building, in 3 of 42,000 sites.
        self._closed = (drawn, around)
        shapely.prepare(self._closed)

    def has_lost(self) -> bool:
        """Whether something that was drawn, and lies in the room, is not closed."""
        solid = shapely.transform(self._scene.arrangement.solid, lambda xy: xy - self._corner)
        left = self._drawn.difference(solid.buffer(0.0))
        return not left.buffer(-self._width).is_empty

    def sees_slit(self) -> bool:
        """Whether two buildings, or one and the border, are nearer than the grid, and apart."""
        border, *buildings = (self._twin.room.boundary, *self._twin.buildings)
        tree = shapely.STRtree([border, *buildings])
        pairs = tree.query([border, *buildings], predicate="dwithin", distance=self._width)
        return any(
            i < j and not tree.geometries[i].intersects(tree.geometries[j]) for i, j in pairs.T
        )

    def _is_deep(self, line: shapely.LineString) -> bool:
        """Whether the middle of a stretch in what is closed lies deeper than the width."""
        for closed in self._closed:
            stretches = shapely.get_parts(line.intersection(closed))
            stretches = stretches[shapely.get_dimensions(stretches) == 1]
            middles = shapely.line_interpolate_point(stretches, 0.5, normalized=True)
            if np.any(shapely.distance(middles, closed.boundary) > self._width):
                return True
        return False

    def agree(self, path: NDArray[np.float64]) -> bool:
        """Whether all have one opinion of a path, but for those that have none."""
        query = Query("drawn", path[0], path[-1])
        by_kernel = bool(first_collision(path, self._scene.arrays) < 0)
        by_referee = self._referee.judge(query, path).valid
        line = shapely.LineString(path - self._corner)
        if self._is_deep(line):
            return not by_kernel and not by_referee
        if np.min(shapely.distance(self._closed, line)) > self._width:
            return by_kernel and by_referee
        # The kernel, exact, may see an entry that is shallower than GEOS rounds; never the other.
        return by_referee or not by_kernel


@dataclass(slots=True)
class Planned:
    """How a planner fared on a sample: one site of each place and size.

    statuses : how often it ended how; refusals and tracebacks are counted too.
    invalid : paths that the referee rejects.
    better : paths shorter than the optimum, beyond rounding.
    messages : of tracebacks and of rejected paths.
    """

    statuses: Counter[str] = field(default_factory=Counter)
    invalid: int = 0
    better: int = 0
    gaps: list[float] = field(default_factory=list)
    messages: list[str] = field(default_factory=list)

    @property
    def holds(self) -> bool:
        """Whether each run ended in words, and each path is one."""
        return not (self.invalid or self.better or self.statuses[TRACEBACK])


def planned(planner: Planner, scenes: Iterable[Scene]) -> Planned:
    """Let a planner plan on scenes: to its end, or within a few thousand checks."""
    abilities = planner.abilities
    is_limited = "checks" in abilities.budgets and not abilities.deterministic
    budget = Budget(checks=PLANNED_CHECKS) if is_limited else Budget()
    made = Planned()
    planner.warm_up()
    for number, scene in enumerate(scenes):
        if planner.refuse(scene, scene.query(), budget) is not None:
            made.statuses["refused"] += 1
            continue
        rng = np.random.default_rng(number)
        try:
            plan = planner.plan(scene, scene.query(), budget, rng, Recorder())
        except Exception as error:
            made.statuses[TRACEBACK] += 1
            made.messages.append(f"{planner.name}: {type(error).__name__}: {error}")
            continue
        made.statuses[plan.status.value] += 1
        optimum = shortest_path(scene, scene.query()).length
        if plan.path is not None:
            verdict = Referee(scene).judge(scene.query(), plan.path)
            made.invalid += not verdict.valid
            made.messages += [] if verdict.valid else [f"{planner.name}: {verdict.reason}"]
            if verdict.length is not None:
                made.gaps.append(verdict.length / optimum - 1.0)
                made.better += made.gaps[-1] < -1e-9
        if planner.abilities.exact and plan.status.value in ("solved", "infeasible"):
            right = made.gaps[-1] < 1e-9 if plan.path is not None else np.isinf(optimum)
            made.invalid += not right
    return made


def sample() -> list[Scene]:
    """One scene of each place and size, but for those that are too coarse."""
    found = []
    for place in PLACES:
        for room in ROOMS:
            try:
                found += [as_scene(site) for site in sites(place, room, 1)]
            except SceneError as error:
                if TOO_COARSE not in str(error):
                    raise
    return found


def planner_table(made: dict[str, Planned]) -> Table:
    """A row for each planner."""
    hold = sum(planned.holds for planned in made.values())
    words = ("solved", "infeasible", "exhausted", "refused", TRACEBACK)
    rows = [
        {
            "planner": name,
            **{word: planned.statuses[word] for word in words},
            "invalid": planned.invalid,
            "shorter than optimal": planned.better,
            "median gap, %": 100.0 * float(np.median(planned.gaps)) if planned.gaps else None,
        }
        for name, planned in made.items()
    ]
    return Table(
        "planners",
        f"Planners on one site of each place and size: {hold} of {len(made)} hold",
        pd.DataFrame(rows),
        f"Within {PLANNED_CHECKS} checks; the deterministic ones to their end. Invalid: paths that "
        "the referee rejects, and, of a planner that claims to be exact, answers that are not.",
    )


def table(findings: dict[tuple[str, str], Findings]) -> Table:
    """A row for each place and size."""
    hold = sum(found.holds for found in findings.values())
    rows = [
        {
            "place": place,
            "room": room,
            "draws": found.draws,
            "too coarse": found.too_coarse,
            "refused": found.refused,
            "tracebacks": found.tracebacks,
            "obstacle lost": found.lost,
            "slit": found.narrow,
            "path or none": found.other,
            "worst error of an optimum": f"{found.worst:.1e}",
            "paths and segments": found.segments,
            "disagreements": found.disagreements,
        }
        for (place, room), found in findings.items()
    ]
    return Table(
        "sites",
        f"Random building sites: {hold} of {len(findings)} places and sizes hold",
        pd.DataFrame(rows),
        "Each site is made at its place and, moved without rounding, at the origin; one at the "
        "origin in a room of 100 m, too. Too coarse: refused, for float64 can't tell its places "
        "apart there. Refused and tracebacks: sites that could not be made. Slit: sites with one "
        "narrower than the grid of the place, which closes it; their optima are not compared. Path "
        "or none: queries with a path at one of the two only. Error: relative, of the optimum, to "
        "that at the origin. Disagreements: paths and random segments on which kernel, referee and "
        "shapely (in the origin's coordinates, by the "
        "polygons as drawn) have two opinions.",
    )


def main(arguments: list[str] | None = None) -> None:
    """Examine, write the tables and print them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--draws", type=int, default=1000, help="of each place and size")
    given = parser.parse_args(arguments)
    findings = {}
    for place in PLACES:
        for room in ROOMS:
            findings[place, room] = found = examined(place, room, given.draws)
            sys.stderr.write(f"{len(findings)} of {len(PLACES) * len(ROOMS)}: {place}, {room}\n")
            for message in found.messages[:3]:
                sys.stderr.write(f"{message}\n")
    scenes = sample()
    made = {name: planned(load_planner(name)(), scenes) for name in planner_names()}
    for message in (message for planned in made.values() for message in planned.messages[:3]):
        sys.stderr.write(f"{message}\n")
    tables = (table(findings), planner_table(made))
    text = "\n".join(render(t, TableFormat.MARKDOWN) for t in tables)
    given.folder.mkdir(parents=True, exist_ok=True)
    (given.folder / "sites.md").write_text(text, encoding="utf-8")
    sys.stdout.write(text)


if __name__ == "__main__":
    main()
