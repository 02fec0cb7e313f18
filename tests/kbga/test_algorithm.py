"""KBGA as a whole: reproducible, honest about what it found, and right by kernel and referee."""

import gc
import hashlib
import os
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import config

from kbga.algorithm import KBGA
from kbga.evolution import next_children
from kbga.settings import KBGAPlusSettings, KBGASettings
from kbga.tuning import rates_of
from suite.geometry.kernels import first_collision
from suite.referee.path import judge
from suite.scenes.catalogue import load_scene, scene_names
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Scene
from tests.kbga.laboratory import ENDS, random_scene, scene_of
from tests.suite.geometry.lattice import COMPILED, counts, pinches

SMALL = KBGAPlusSettings(population_size=12, resolution=20, max_generations=counts(12, 5))
WALL = scene_of(shapely.box(4, 0, 6, 8))
CLOSED = scene_of(shapely.box(8, 8, 10, 10).difference(shapely.box(8.5, 8.5, 9.5, 9.5)))


def evolve(scene: Scene, settings: KBGASettings = SMALL, seed: int = 0) -> KBGA:
    ga = KBGA(scene, scene.query(), settings, np.random.default_rng(seed))
    ga.run()
    return ga


def fingerprint(ga: KBGA) -> str:
    """Of everything that a run leaves behind, bit for bit."""
    digest = hashlib.sha256()
    for path in (*ga.paths(), ga.best_path):
        digest.update(b"none" if path is None else path.tobytes())
    digest.update(ga.population.chromosomes.tobytes())
    return f"{digest.hexdigest()} {ga.checks} {ga.best_cost!r}"


def fingerprint_elsewhere(**environment: str) -> str:
    """The fingerprint of a small run on the zigzag, from a process of its own."""
    code = (
        "from tests.kbga.test_algorithm import SMALL, evolve, fingerprint, load_scene\n"
        "from dataclasses import replace\n"
        "print(fingerprint(evolve(load_scene('zigzag'), replace(SMALL, max_generations=6), 7)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, **environment},
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


# Randomness


def test_the_same_seed_gives_the_same_population_bit_for_bit():
    scene = load_scene("unstructured")
    assert fingerprint(evolve(scene, seed=3)) == fingerprint(evolve(scene, seed=3))


def test_another_seed_gives_another_population():
    first, second = (KBGA(WALL, WALL.query(), SMALL, np.random.default_rng(s)) for s in (1, 2))
    assert fingerprint(first) != fingerprint(second)


@pytest.mark.skipif(not COMPILED, reason="it runs both ways whichever way it is run")
def test_another_process_gives_the_same_compiled_and_interpreted():
    compiled = fingerprint_elsewhere(NUMBA_DISABLE_JIT="0")
    assert fingerprint_elsewhere(NUMBA_DISABLE_JIT="0", PYTHONHASHSEED="5") == compiled
    assert fingerprint_elsewhere(NUMBA_DISABLE_JIT="1") == compiled


# Ends


def test_it_stops_at_the_last_generation():
    ga = evolve(CLOSED)
    assert ga.generation == SMALL.max_generations


def test_it_stops_when_the_best_path_has_stood_long_enough():
    ga = evolve(WALL, KBGASettings(population_size=12, resolution=20, stagnation=4))
    assert ga.generation == ga.generation_of_best + 4
    assert ga.stagnant


def test_stagnation_does_not_count_before_there_is_a_path():
    ga = evolve(
        CLOSED, KBGASettings(population_size=4, resolution=10, max_generations=8, stagnation=1)
    )
    assert ga.generation == 8
    assert not ga.stagnant


def test_without_a_path_there_is_none_to_return():
    ga = KBGA(CLOSED, CLOSED.query(), SMALL, np.random.default_rng(0))
    assert ga.run() is None
    assert (ga.best_path, ga.best_cost) == (None, np.inf)
    assert 0 < ga.lowest_cost < np.inf


def test_a_callback_can_end_it_and_hears_of_each_generation_once():
    heard: list[tuple[int, bool]] = []

    def listen(ga: KBGA, improved: bool) -> bool:
        heard.append((ga.generation, improved))
        return ga.generation < 3

    ga = KBGA(CLOSED, CLOSED.query(), SMALL, np.random.default_rng(0))
    ga.run(listen)
    assert heard == [(0, False), (1, False), (2, False), (3, False)]


def test_it_can_be_ended_before_the_first_generation():
    ga = KBGA(WALL, WALL.query(), SMALL, np.random.default_rng(0))
    ga.run(lambda _ga, _improved: False)
    assert ga.generation == 0


# Easy and degenerate queries


@pytest.mark.parametrize("max_nodes", [2, 3, 48])
@pytest.mark.parametrize("resolution", [2, 7])
def test_without_obstacles_it_finds_the_straight_line(max_nodes, resolution):
    settings = KBGAPlusSettings(population_size=6, resolution=resolution, max_nodes=max_nodes)
    ga = evolve(scene_of(), settings)
    assert ga.best_cost == pytest.approx(8 * np.sqrt(2))
    assert ga.best_path is not None
    assert len(ga.best_path) <= 3  # a node on the line makes it no longer
    assert (np.abs(ga.best_path[:, 0] - ga.best_path[:, 1]) <= 1e-9).all()


def test_from_the_start_to_the_start_it_stays():
    ga = evolve(scene_of(shapely.box(4, 0, 6, 8), ends=((1, 1), (1, 1))))
    assert ga.best_cost == 0.0
    assert ga.best_path is not None
    assert ga.best_path.tolist() == [[1, 1], [1, 1]]


def test_start_and_goal_on_the_border_do_not_tempt_it_under_the_wall():
    ga = evolve(scene_of(shapely.box(4, 0, 6, 8), ends=((1, 0), (9, 0))))
    assert ga.lowest_cost == ga.best_cost
    assert ga.best_cost == pytest.approx(2 + 2 * np.hypot(3, 8), rel=0.02 if COMPILED else 0.3)


def test_it_does_not_bend_at_a_pinch_point_or_slip_through_one():
    # Two boxes from border to border that meet in the lattice node (5, 5) alone.
    walls = scene_of(shapely.box(0, 4, 5, 5), shapely.box(5, 5, 10, 6), ends=((5, 1), (5, 9)))
    assert (
        evolve(walls, KBGASettings(resolution=10, population_size=10, max_generations=10)).best_path
        is None
    )


@settings(max_examples=counts(120, 6))
@given(st.integers(0, 2**32), st.sampled_from([4, 8, 16]))
def test_the_referee_accepts_every_path_among_touching_obstacles(seed, resolution):
    scene = random_scene(np.random.default_rng(seed))
    ga = evolve(scene, KBGASettings(population_size=10, resolution=resolution, max_generations=8))
    if ga.best_path is None:
        return
    verdict = judge(scene, scene.query(), ga.best_path)
    assert verdict.valid, verdict.reason
    assert verdict.length == pytest.approx(ga.best_cost)
    assert first_collision(ga.best_path, scene.arrays) == -1
    pinched = {(p.x, p.y) for p, _ in pinches(scene.arrangement.solid)}
    assert not pinched & set(map(tuple, ga.best_path[1:-1].tolist()))


def test_among_few_obstacles_it_finds_the_optimum_or_that_there_is_no_path():
    found = 0
    for seed in range(counts(400, 20)):
        scene = random_scene(np.random.default_rng(seed))
        # All corners of these scenes lie on quarters of a metre; where the room's area is that of a
        # square of whole metres, so do the nodes.
        side = np.sqrt(scene.workspace.area)
        if side != round(side):
            continue
        resolution = 4 * int(side)
        optimum = shortest_path(scene, scene.query()).length
        ga = evolve(scene, KBGAPlusSettings(resolution=resolution, max_generations=counts(60, 25)))
        assert ga.best_cost == pytest.approx(optimum, rel=1e-9), f"seed {seed}"
        found += ga.best_path is not None
    assert found > 0


@pytest.mark.parametrize("name", scene_names() if COMPILED else ["zigzag"])
def test_the_referee_accepts_its_paths_in_the_catalogue(name):
    scene = load_scene(name)
    for seed in range(counts(3, 1)):
        ga = evolve(scene, KBGAPlusSettings() if COMPILED else SMALL, seed)
        assert ga.best_path is not None
        assert first_collision(ga.best_path, scene.arrays) == -1
        verdict = judge(scene, scene.query(), ga.best_path)
        assert verdict.valid, verdict.reason
        assert verdict.length == pytest.approx(ga.best_cost)


# What it says of itself


def test_its_report_describes_the_population():
    ga = evolve(WALL)
    report = ga.report()
    costs = ga.population.chromosomes["cost"]
    infeasible = ga.population.chromosomes["infeasible"]
    paths = {path.tobytes() for path in ga.paths()}
    assert (report.generation, report.checks) == (ga.generation, ga.checks)
    assert (report.best, report.mean) == (costs.min(), pytest.approx(costs.mean(), rel=1e-12))
    assert report.feasible_share == (infeasible == 0).mean()
    assert report.diversity == len(paths) / 12


def test_the_best_is_remembered_with_its_generation():
    ga = KBGA(WALL, WALL.query(), SMALL, np.random.default_rng(0))
    best, found = ga.best_cost, 0
    while ga.generation < SMALL.max_generations:
        improved = ga.step()
        assert improved == (ga.best_cost < best)
        found = ga.generation if improved else found
        best = ga.best_cost
        assert ga.generation_of_best == found
        assert ga.lowest_cost <= ga.population.chromosomes["cost"].min()
    assert ga.best_path is not None
    assert np.hypot(*np.diff(ga.best_path, axis=0).T).sum() == pytest.approx(best)


@settings(max_examples=counts(40, 4))
@given(st.integers(0, 2**32), st.sampled_from([2, 3, 12]), st.sampled_from([0.0, 0.1, 100.0]))
def test_it_tells_of_each_better_path_once_and_last_of_the_best(seed, population_size, penalty):
    told: list[tuple[float, int, int]] = []
    chosen = KBGASettings(
        population_size=population_size, resolution=10, penalty=penalty, max_generations=12
    )
    ga = KBGA(random_scene(np.random.default_rng(seed)), settings=chosen, rng=seed)
    if ga.best_path is not None:
        assert ga.generation_of_best == 0
    now = ga.generation

    def improved(ga: KBGA) -> None:
        assert ga.best_path is not None
        assert ga.generation_of_best == ga.generation
        assert ga.generation in (now, now + 1)
        told.append((ga.best_cost, ga.generation, ga.checks))

    def follow(ga: KBGA, better: bool) -> None:
        nonlocal now
        now = ga.generation
        assert better == (len(told) > 0 and told[-1][1] == now)

    ga.run(follow, improved)
    costs, generations, checks = zip(*told, strict=True) if told else ((), (), ())
    assert all(before > after for before, after in pairwise(costs))
    assert list(generations) == sorted(generations)
    assert list(checks) == sorted(checks)
    assert (costs[-1] if told else np.inf) == ga.best_cost
    assert (generations[-1] if told else 0) == ga.generation_of_best


def test_a_feasible_child_is_known_though_the_elite_takes_its_place():
    # Without a penalty a path through the wall costs less: the feasible child is the worst.
    kept = 0
    for seed in range(40):
        ga = KBGA(WALL, None, KBGASettings(population_size=2, resolution=10, penalty=0.0), seed)
        while ga.best_path is None and ga.generation < 10:
            ga.step()
        gone = (ga.population.chromosomes["infeasible"] > 0).all()
        kept += ga.best_path is not None and gone
    assert kept > 0


@pytest.mark.skipif(not COMPILED, reason="nothing is compiled")
def test_generations_give_the_generator_and_the_tables_back():
    rng = np.random.default_rng(0)
    ga = KBGA(WALL, None, SMALL, rng)
    for _ in range(3):
        ga.step()
    held = rng, rng.bit_generator, ga.population.nodes, ga._problem.usable, ga._counter
    gc.collect()
    before = [sys.getrefcount(thing) for thing in held]
    for _ in range(50):
        ga.step()
    gc.collect()
    assert [sys.getrefcount(thing) for thing in held] == before


def test_the_path_that_it_returns_is_not_touched_by_later_generations():
    ga = KBGA(WALL, WALL.query(), SMALL, np.random.default_rng(0))
    while ga.best_path is None:
        ga.step()
    path, before = ga.best_path, ga.best_path.copy()
    ga.step()
    assert np.array_equal(path, before)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")
def test_whole_numbers_for_probabilities_do_not_compile_it_again():
    evolve(scene_of(ends=ENDS))
    compiled = len(next_children.signatures)
    evolve(
        scene_of(),
        KBGASettings(
            mutation_probability=0, crossover_probability=1, penalty=20, tournament_size=np.int64(2)
        ),
    )
    assert len(next_children.signatures) == compiled


# Probabilities that are tuned


def test_tuned_probabilities_are_the_same_for_the_same_seed_and_leave_those_of_the_settings():
    adaptive = replace(SMALL, adaptation_rate=0.3)
    first, second, fixed = (evolve(WALL, s, seed=3) for s in (adaptive, adaptive, SMALL))
    assert fingerprint(first) == fingerprint(second)
    assert first._rates == second._rates != rates_of(adaptive)
    assert fixed._rates == rates_of(SMALL)
