"""The parameters of KBGA: those of the paper, and those that the paper leaves open.

:class:`KBGASettings` are the paper's algorithm: what it says, and where it is silent the reading
that the study `readings` came to. :class:`KBGAPlusSettings` are ours.
"""

from dataclasses import dataclass
from math import isfinite
from numbers import Integral, Real
from typing import Any, Literal

from kbga.encoding import FINEST


@dataclass(frozen=True, slots=True)
class KBGASettings:
    """Parameters of the paper's algorithm. Where the paper is silent, a reading (see `readings`).

    population_size : individuals, at least 2 (paper III: 50).
    resolution : lattice units per side of the workspace (paper III: 100 x 100); nodes lie on the
        crossings of the grid lines. See :func:`kbga.encoding.make_lattice`.
    max_nodes : N_max, the longest chromosome, start and goal included (the paper names no number:
        48, nearly twice what the most winding optimum of the catalogue needs).
    initial_nodes : most intermediate nodes of a chromosome in the first population (a reading).
    informed_share : share of the first population that is built with knowledge of the obstacles:
        of nodes next to them, and repaired at once (future work in paper V; 0: random, as in
        the paper).
    crossover_probability : per pair of parents (paper III: 0.9).
    mutation_probability : per chromosome (paper III: 0.2).
    change_mutation_probability : per chromosome, once, when the environment has changed (paper
        II-D: "mutation with high mutation rate"; that of the other operators. The best chromosome
        is spared, so that a change elsewhere leaves its path as it is).
    repair_probability : per infeasible chromosome (paper III: 0.9).
    deletion_probability : per chromosome (paper III: 0.9).
    improvement_probability : per feasible chromosome (paper III: 0.9).
    adaptation_rate : how fast the probabilities of the operators follow what each of them achieves,
        see :mod:`kbga.tuning` (future work in paper V; 0: they stay as they are, as in the paper).
    tournament_size : individuals that compete to be a parent (a reading).
    penalty : the constant C of Eq. (1), metres of path per metre of collision depth (a reading).
    repair_reach : "the neighboring grids of the intersected obstacle" (paper II-C) are the free
        lattice nodes within so many units of its boundary; 0: those next to its corners, where
        shortest paths bend (a reading: with all of the boundary, none that was tried finds a way
        through the maze).
    repair_candidates : how many of them are tried in one repair, spread evenly; 0: all (a reading).
    repair_must_help : whether a repair that costs more than the segment did is taken back (a
        reading: "the best node available" may be worse than none).
    repair_limit : a chromosome is repaired only while its length is below this many times the best
        feasible path's. ``inf`` repairs without regard to that, as the paper does.
    improvement_radius : longest step of the local search around a node, lattice units; 0: one step
        to the best of the eight neighbours, and no more (the plainest reading).
    rounds : how often at most a child meets the specialised operators in one generation, each time
        by probability and heuristic; a round without effect is the last (a reading: the paper has
        "one or more genetic operators" work on a child).
    one_operator : whether a round fires one of the specialised operators that suit the child, or
        all of them in turn (a reading).
    remembers : whether nodes that improvement or deletion found settled are not drawn again until
        a neighbour changes (not in the paper, which draws "randomly").
    corner_nodes : whether sharp corners of obstacles, where shortest paths bend, are nodes too; a
        repair tries these, and lattice nodes next to round ones (not in the paper, whose nodes are
        grids).
    taut : feasible paths up to so many times as long as the best are pulled taut, so that they bend
        at corners, not at lattice nodes; 0: none (not in the paper, see :mod:`kbga.taut`).
    immigrants : share of the population that gives way to new random chromosomes in each generation
        after one without a better path (not in the paper; Grefenstette 1992).
    proves : whether a run ends at once where no part of free space holds both start and goal, with
        that as the proof that there is no path (not in the paper, which searches on).
    lattice_over : the lattice covers the bounds of the "room", or of the "region" of free space
        that the query lies in, as far as that is known when the run begins (the paper's rooms are
        one region each). A robot that plans again and again has the room's.
    generations_counted : what "generations needed" counts: those until the "best" was found, or
        until the "stop" (a reading; it changes tables, not runs).
    max_generations : first stop criterion (the paper's plain GA ran beyond 444).
    stagnation : second stop criterion, generations without a better solution (a reading). It counts
        only once there is a feasible path: before that, more generations are all that helps.
    """

    population_size: int = 50
    resolution: int = 100
    max_nodes: int = 48
    initial_nodes: int = 8
    informed_share: float = 0.0
    crossover_probability: float = 0.9
    mutation_probability: float = 0.2
    change_mutation_probability: float = 0.9
    repair_probability: float = 0.9
    deletion_probability: float = 0.9
    improvement_probability: float = 0.9
    adaptation_rate: float = 0.0
    tournament_size: int = 5
    penalty: float = 140.0
    repair_reach: int = 0
    repair_candidates: int = 16
    repair_must_help: bool = False
    repair_limit: float = float("inf")
    improvement_radius: int = 0
    rounds: int = 2
    one_operator: bool = False
    remembers: bool = False
    corner_nodes: bool = False
    taut: float = 0.0
    immigrants: float = 0.0
    proves: bool = False
    lattice_over: Literal["room", "region"] = "room"
    generations_counted: Literal["best", "stop"] = "stop"
    max_generations: int = 500
    stagnation: int = 30

    def __post_init__(self) -> None:
        for name, low in (
            ("population_size", 2),
            ("resolution", 2),
            ("max_nodes", 2),
            ("initial_nodes", 1),
            ("tournament_size", 1),
            ("repair_reach", 0),
            ("repair_candidates", 0),
            ("improvement_radius", 0),
            ("rounds", 1),
            ("max_generations", 1),
            ("stagnation", 1),
        ):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, Integral) or int(value) < low:
                raise ValueError(f"{name} is {value!r}; it must be a whole number, {low} or more")
        operators = (
            "crossover",
            "mutation",
            "change_mutation",
            "repair",
            "deletion",
            "improvement",
        )
        shares = [f"{operator}_probability" for operator in operators]
        for name in (*shares, "informed_share", "immigrants", "adaptation_rate"):
            value = getattr(self, name)
            if not (_is_number(value) and 0.0 <= value <= 1.0):
                raise ValueError(f"{name} is {value!r}; it must lie in [0, 1]")
        if self.resolution > FINEST:
            raise ValueError(f"resolution is {self.resolution}; it must be at most {FINEST}")
        if not (_is_number(self.repair_limit) and self.repair_limit > 0.0):
            raise ValueError(f"repair_limit is {self.repair_limit!r}; it must be above 0")
        for name in ("repair_must_help", "one_operator", "remembers", "corner_nodes", "proves"):
            if not isinstance(getattr(self, name), bool):
                raise ValueError(f"{name} is {getattr(self, name)!r}; it must be true or false")
        if not (_is_number(self.taut) and (self.taut == 0.0 or self.taut >= 1.0)):
            raise ValueError(f"taut is {self.taut!r}; it must be 0, or 1 or more")
        if self.lattice_over not in ("room", "region"):
            raise ValueError(
                f"lattice_over is {self.lattice_over!r}; it must be 'room' or 'region'"
            )
        if self.generations_counted not in ("best", "stop"):
            raise ValueError(
                f"generations_counted is {self.generations_counted!r}; it must be 'best' or 'stop'"
            )
        if not (_is_number(self.penalty) and isfinite(self.penalty) and self.penalty >= 0.0):
            raise ValueError(f"penalty is {self.penalty!r}; it must be 0 or more, and finite")


@dataclass(frozen=True, slots=True)
class KBGAPlusSettings(KBGASettings):
    """Parameters of KBGA-plus: the paper's algorithm, and what we found to make it better.

    Each of these differs from the paper's, and what each brings is measured (matrices `plus` and
    `kbga-plus`); the others are those of :class:`KBGASettings`.

    resolution : 150; around round obstacles, as grown ones are, 100 misses routes.
    initial_nodes : 4, as each makes a collision likely; the operators insert what is missing.
    tournament_size : 2, the mildest choice.
    penalty : 100; it comes out alike from 10 to 1000.
    repair_candidates : 200, most often all: the one way through may be at any of them.
    repair_limit : 1.1: a repair makes a path longer, so one that is longer already than the best
        feasible one is seldom worth the checks. With 1 some routes are never laid.
    improvement_radius : 8: the search goes on from each better place, its steps doubled or halved.
    rounds : 8: a child on a new route lives until it is repaired.
    remembers : no node is tried again that can't have changed.
    corner_nodes : shortest paths bend at corners, and passages may be narrower than the lattice.
    taut : 1.1: what is longer is seldom the best route's.
    immigrants : 0.3: a population that has converged finds no other route by itself.
    proves : no run searches for what there is not.
    lattice_over : the region; most of a map that a robot has drawn can't be reached.
    """

    resolution: int = 150
    initial_nodes: int = 4
    tournament_size: int = 2
    penalty: float = 100.0
    repair_candidates: int = 200
    repair_limit: float = 1.1
    improvement_radius: int = 8
    rounds: int = 8
    remembers: bool = True
    corner_nodes: bool = True
    taut: float = 1.1
    immigrants: float = 0.3
    proves: bool = True
    lattice_over: Literal["room", "region"] = "region"


def _is_number(value: Any) -> bool:
    # To Python a bool is a number too; as a setting it is a mistake.
    return isinstance(value, Real) and not isinstance(value, bool)
