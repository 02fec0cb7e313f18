"""The parameters of KBGA: those of the paper, and those that the paper leaves open."""

from dataclasses import dataclass
from math import isfinite
from numbers import Integral, Real
from typing import Any

FINEST = 20_000
"""Finest resolution. Lattice numbers are 32 bits wide, and a byte is kept for each: 400 MB."""


@dataclass(frozen=True, slots=True)
class KBGASettings:
    """Parameters of the algorithm. Those marked (ours) are choices where the paper is silent.

    population_size : individuals, at least 2 (paper III: 50).
    resolution : lattice units per side of the workspace (paper III: 100 x 100); nodes lie on the
        crossings of the grid lines, so there are (resolution + 1) ** 2 of them.
    max_nodes : N_max, the longest chromosome, start and goal included (ours: 48, nearly twice
        what the most winding optimum of the catalogue needs).
    initial_nodes : most intermediate nodes of a chromosome in the first population (ours: few,
        as each makes a collision likely; the operators insert what is missing).
    informed_share : share of the first population that is built with knowledge of the obstacles:
        of nodes next to them, and repaired at once (future work in paper V; 0: random, as in
        the paper).
    crossover_probability : per pair of parents (paper III: 0.9).
    mutation_probability : per chromosome (paper III: 0.2).
    change_mutation_probability : per chromosome, once, when the environment has changed (paper
        II-D: "mutation with high mutation rate", ours: that of the other operators. The best
        chromosome is spared, so that a change elsewhere leaves its path as it is).
    repair_probability : per infeasible chromosome (paper III: 0.9).
    deletion_probability : per chromosome (paper III: 0.9).
    improvement_probability : per feasible chromosome (paper III: 0.9).
    adaptation_rate : how fast the probabilities of the operators follow what each of them achieves,
        see :mod:`kbga.tuning` (future work in paper V; 0: they stay as they are, as in the paper).
    tournament_size : individuals that compete to be a parent (ours).
    penalty : the constant C of Eq. (1), metres of path per metre of collision depth (ours: KBGA
        comes out alike from 10 to 1000, the plain GA wants 100 or more; at 1 a short cut through a
        wall of `maze` costs less than the way around it).
    repair_candidates : nodes tried around the intersected obstacle in one repair (ours).
    repair_limit : a chromosome is repaired only while its length is below this many times the best
        feasible path's (ours: a repair makes a path longer, so one that is longer already is not
        worth the checks, which were most of all. ``inf`` repairs without regard to that).
    improvement_radius : longest step of the local search around a node, lattice units (ours).
    rounds : how often at most a child meets repair, deletion and improvement in one generation,
        each time by probability and heuristic; a round without effect is the last (ours: the
        paper has "one or more" operators work on a child. One round is the plainest reading, but
        then a child on a new route rarely lives until it is repaired, and the population settles
        on the first routes found).
    max_generations : first stop criterion (ours; the paper's plain GA ran beyond 444).
    stagnation : second stop criterion, generations without a better solution (ours). It counts
        only once there is a feasible path: before that, more generations are all that helps.
    """

    population_size: int = 50
    resolution: int = 100
    max_nodes: int = 48
    initial_nodes: int = 4
    informed_share: float = 0.0
    crossover_probability: float = 0.9
    mutation_probability: float = 0.2
    change_mutation_probability: float = 0.9
    repair_probability: float = 0.9
    deletion_probability: float = 0.9
    improvement_probability: float = 0.9
    adaptation_rate: float = 0.0
    tournament_size: int = 2
    penalty: float = 100.0
    repair_candidates: int = 12
    repair_limit: float = 1.0
    improvement_radius: int = 8
    rounds: int = 8
    max_generations: int = 500
    stagnation: int = 15

    def __post_init__(self) -> None:
        for name, low in (
            ("population_size", 2),
            ("resolution", 2),
            ("max_nodes", 2),
            ("initial_nodes", 1),
            ("tournament_size", 1),
            ("repair_candidates", 1),
            ("improvement_radius", 1),
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
        for name in (*shares, "informed_share", "adaptation_rate"):
            value = getattr(self, name)
            if not (_is_number(value) and 0.0 <= value <= 1.0):
                raise ValueError(f"{name} is {value!r}; it must lie in [0, 1]")
        if self.resolution > FINEST:
            raise ValueError(f"resolution is {self.resolution}; it must be at most {FINEST}")
        if not (_is_number(self.repair_limit) and self.repair_limit > 0.0):
            raise ValueError(f"repair_limit is {self.repair_limit!r}; it must be above 0")
        if not (_is_number(self.penalty) and isfinite(self.penalty) and self.penalty >= 0.0):
            raise ValueError(f"penalty is {self.penalty!r}; it must be 0 or more, and finite")


def _is_number(value: Any) -> bool:
    # To Python a bool is a number too; as a setting it is a mistake.
    return isinstance(value, Real) and not isinstance(value, bool)
