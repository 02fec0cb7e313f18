"""The plain GA is KBGA without knowledge, and nothing else."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import shapely

from baselines.plain_ga import PlainGAPlanner, PlainGASettings
from kbga.plugin import KBGAPlanner
from kbga.settings import KBGASettings
from suite.planner import Budget, Plan, Planner, PlanStatus, Recorder
from suite.referee.path import judge
from suite.report.tables.studies import MUTATION_RATE, best_value, sweep
from suite.scenes.catalogue import load_scene
from tests.kbga.laboratory import scene_of

AS_PLAIN_GA = {
    "mutation_probability": PlainGASettings().mutation_probability,
    "initial_nodes": PlainGASettings().initial_nodes,
    "stagnation": PlainGASettings().stagnation,
}
WITHOUT_KNOWLEDGE = {
    "repair_probability": 0.0,
    "deletion_probability": 0.0,
    "improvement_probability": 0.0,
}
ROWS = Path(__file__).parents[2] / "results/mutation-rate/rows/runs.parquet"
FEW = Budget(generations=25)


def run(planner: Planner, scene_name: str = "double_u", seed: int = 2) -> tuple[Plan, Recorder]:
    scene = load_scene(scene_name)
    recorder = Recorder(snapshot_of=lambda generation: generation == 0)
    made = planner.plan(scene, scene.query(), FEW, np.random.default_rng(seed), recorder)
    return made, recorder


def test_its_default_mutation_rate_is_the_best_of_those_tried():
    runs = pd.read_parquet(ROWS)
    assert len(runs) == 9 * 8 * 20
    best = best_value(sweep(runs, MUTATION_RATE), "zigzag")
    assert PlainGASettings().mutation_probability == best


@pytest.mark.parametrize("scene_name", ["double_u", "zigzag"])
def test_it_equals_kbga_with_the_knowledge_switched_off_bit_for_bit(scene_name):
    kbga = KBGAPlanner(KBGASettings(**AS_PLAIN_GA, **WITHOUT_KNOWLEDGE))
    (ours, our_trace), (theirs, their_trace) = (
        run(p, scene_name) for p in (PlainGAPlanner(), kbga)
    )
    assert our_trace.trace == their_trace.trace
    assert np.array_equal(ours.path, theirs.path) or ours.path is theirs.path is None
    assert (ours.checks, ours.claimed_cost) == (theirs.checks, theirs.claimed_cost)


def test_it_makes_no_use_of_knowledge():
    settings = PlainGASettings().as_kbga()
    assert {name: getattr(settings, name) for name in WITHOUT_KNOWLEDGE} == WITHOUT_KNOWLEDGE
    # What only the specialised operators read changes nothing; but for repair_limit, on which it
    # hangs whether a number is drawn for a repair at all.
    other = KBGASettings(
        **AS_PLAIN_GA,
        **WITHOUT_KNOWLEDGE,
        repair_candidates=3,
        improvement_radius=2,
        rounds=1,
    )
    rows = run(KBGAPlanner(other))[1].trace
    # But for the draws that a longer row of rounds would make: none, as no round has an effect.
    assert rows == run(PlainGAPlanner())[1].trace


def test_it_starts_from_the_first_population_of_a_kbga_with_as_many_nodes():
    kbga = KBGAPlanner(KBGASettings(initial_nodes=PlainGASettings().initial_nodes))
    ours, theirs = (run(p)[1].snapshots for p in (PlainGAPlanner(), kbga))
    for a, b in zip(ours[0].paths, theirs[0].paths, strict=True):
        assert np.array_equal(a, b)


def test_its_settings_reach_the_engine():
    chosen = PlainGASettings(
        mutation_probability=0.1, crossover_probability=0.2, max_generations=3, stagnation=2
    ).as_kbga()
    assert (chosen.mutation_probability, chosen.crossover_probability) == (0.1, 0.2)
    assert (chosen.max_generations, chosen.stagnation) == (3, 2)


@pytest.mark.parametrize("name", ["mutation_probability", "crossover_probability"])
def test_a_bad_probability_is_refused_by_name(name):
    with pytest.raises(ValueError, match=rf"{name} is 1.5; it must lie in \[0, 1\]"):
        PlainGASettings(**{name: 1.5})


def test_a_knob_of_the_knowledge_is_not_a_setting():
    with pytest.raises(TypeError, match="repair_probability"):
        PlainGASettings(repair_probability=0.5)  # type: ignore[call-arg]


def test_the_referee_accepts_its_path_and_without_one_it_is_exhausted():
    easy = scene_of(shapely.box(4, 0, 6, 8))
    planner = PlainGAPlanner(PlainGASettings(max_generations=60))
    planner.warm_up()
    made = planner.plan(easy, easy.query(), Budget(), np.random.default_rng(0), Recorder())
    assert made.status is PlanStatus.SOLVED
    assert judge(easy, easy.query(), made.path).valid
    closed = scene_of(shapely.box(8, 8, 10, 10).difference(shapely.box(8.5, 8.5, 9.5, 9.5)))
    made = planner.plan(closed, closed.query(), FEW, np.random.default_rng(0), Recorder())
    assert (made.status, made.path) == (PlanStatus.EXHAUSTED, None)
