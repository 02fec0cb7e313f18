"""As a library: three lines from arrays to a path, a callback, and the trace as a table."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import shapely

import kbga
from kbga import KBGA, KBGASettings, make_scene
from suite.errors import SceneError
from tests.suite.geometry.lattice import counts

SMALL = KBGASettings(population_size=12, resolution=20, max_generations=counts(12, 5))
ROOM = np.array([(0, 0), (10, 0), (10, 10), (0, 10)])
WALL = np.array([(4, 0), (6, 0), (6, 8), (4, 8)])
ENDS = ((1, 1), (9, 1))
SCENE = make_scene("one wall", ROOM, [WALL], ENDS)
TWO = make_scene("two queries", ROOM, [WALL], {"there": ENDS, "back": ENDS[::-1]})


def in_a_new_process(code: str, **environment: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, **environment},
        cwd=Path(__file__).parents[2],
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip()


# To a path


def test_three_lines_lead_from_arrays_to_a_path():
    scene = make_scene("one wall", ROOM, [WALL], ENDS)
    ga = KBGA(scene, settings=SMALL, rng=1)
    path = ga.run()
    assert path is not None
    assert (tuple(path[0]), tuple(path[-1])) == ENDS
    assert np.hypot(*np.diff(path, axis=0).T).sum() == pytest.approx(ga.best_cost)


def test_arrays_and_polygons_make_the_same_scene_and_the_same_path():
    drawn = make_scene("drawn", shapely.Polygon(ROOM), [shapely.Polygon(WALL)], {"main": ENDS})
    assert drawn.hash == SCENE.hash
    paths = [KBGA(scene, settings=SMALL, rng=1).run() for scene in (drawn, SCENE)]
    assert np.array_equal(*paths)


def test_everything_that_the_face_promises_is_there():
    assert all(hasattr(kbga, name) for name in kbga.__all__)


def test_what_is_not_given_is_the_first_query_the_papers_settings_and_a_fresh_generator():
    ga = KBGA(TWO)
    assert ga.settings == KBGASettings()
    assert ga.paths()[0][0].tolist() == [1, 1]
    others = KBGA(TWO).paths()
    assert any(not np.array_equal(a, b) for a, b in zip(ga.paths(), others, strict=True))


@pytest.mark.parametrize("query", ["back", TWO.query("back")])
def test_a_query_is_given_by_itself_or_by_its_name(query):
    assert KBGA(TWO, query, SMALL).paths()[0][0].tolist() == [9, 1]


def test_a_seed_stands_for_its_generator():
    seeded, given = KBGA(SCENE, None, SMALL, 5), KBGA(SCENE, None, SMALL, np.random.default_rng(5))
    assert np.array_equal(seeded.run(), given.run())
    assert seeded.checks == given.checks


def test_a_query_that_the_scene_has_not_is_answered_with_those_it_has():
    with pytest.raises(SceneError, match=r"two queries: no query 'home'\. It has: there, back\."):
        KBGA(TWO, "home")


def test_what_is_no_scene_and_what_are_no_settings_are_refused_by_name():
    with pytest.raises(TypeError, match="scene is a str; make a Scene with make_scene"):
        KBGA("zigzag")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="settings is a dict; give a KBGASettings"):
        KBGA(SCENE, settings={"rounds": 1})  # type: ignore[arg-type]


# Following the generations


def test_a_callback_that_only_looks_on_does_not_end_the_run():
    heard: list[int] = []

    def look(ga: KBGA, _improved: bool) -> None:
        heard.append(ga.generation)

    watched, alone = KBGA(SCENE, None, SMALL, 1), KBGA(SCENE, None, SMALL, 1)
    assert np.array_equal(watched.run(look), alone.run())
    assert heard == list(range(alone.generation + 1))


@pytest.mark.parametrize("no", [False, np.False_])
def test_it_ends_when_the_callback_says_no(no):
    ga = KBGA(SCENE, None, SMALL, 1)
    ga.run(lambda ga, _improved: no if ga.generation == 2 else True)
    assert ga.generation == 2


def test_the_callback_hears_of_each_improvement():
    costs: list[float] = []

    def note(ga: KBGA, improved: bool) -> None:
        if improved:
            costs.append(ga.best_cost)

    ga = KBGA(SCENE, None, SMALL, 1)
    ga.run(note)
    assert costs == sorted(set(costs), reverse=True)
    assert costs[-1] == ga.best_cost


def test_a_run_that_was_ended_goes_on_where_it_was():
    halted, whole = KBGA(SCENE, None, SMALL, 1), KBGA(SCENE, None, SMALL, 1)
    halted.run(lambda ga, _improved: ga.generation < 2)
    assert np.array_equal(halted.run(), whole.run())
    assert (halted.generation, halted.checks) == (whole.generation, whole.checks)


# The trace


def test_the_trace_has_a_row_for_each_generation_with_what_its_report_says():
    reports = []
    ga = KBGA(SCENE, None, SMALL, 1)
    ga.run(lambda ga, _improved: reports.append(ga.report()), trace=True)
    trace = ga.trace()
    names = ["generation", "best", "mean", "feasible_share", "diversity", "checks"]
    assert list(trace.columns) == names
    assert trace["generation"].tolist() == list(range(ga.generation + 1))
    for name in names:
        assert trace[name].tolist() == [getattr(report, name) for report in reports]
    assert trace["best"].is_monotonic_decreasing
    assert trace["checks"].iloc[-1] == ga.checks


def test_to_trace_a_run_does_not_change_it():
    traced, plain = KBGA(SCENE, None, SMALL, 1), KBGA(SCENE, None, SMALL, 1)
    assert np.array_equal(traced.run(trace=True), plain.run())
    assert traced.population.chromosomes.tobytes() == plain.population.chromosomes.tobytes()
    assert traced.checks == plain.checks


def test_a_trace_in_two_parts_has_no_generation_twice():
    ga = KBGA(SCENE, None, SMALL, 1)
    ga.run(lambda ga, _improved: ga.generation < 2, trace=True)
    assert len(ga.trace()) == 3
    ga.run(trace=True)
    assert ga.trace()["generation"].tolist() == list(range(ga.generation + 1))


def test_a_run_that_was_not_traced_says_how_to():
    ga = KBGA(SCENE, None, SMALL, 1)
    ga.run()
    with pytest.raises(RuntimeError, match=r"run\(trace=True\)"):
        ga.trace()


# What an import brings


def test_the_face_does_not_load_pandas():
    assert in_a_new_process("import kbga, sys; print('pandas' in sys.modules)") == "False"


def test_kernels_are_kept_with_these_sources_when_the_face_is_imported_first(tmp_path):
    code = (
        "from kbga import KBGA\n"
        "from kbga.evolution import next_children\n"
        "print(next_children._cache.cache_path)"
    )
    where = in_a_new_process(code, NUMBA_CACHE_DIR=str(tmp_path), NUMBA_DISABLE_JIT="0")
    code = "from suite.jit import cache_folder; print(cache_folder())"
    assert Path(where).is_relative_to(in_a_new_process(code, NUMBA_CACHE_DIR=str(tmp_path)))
    assert Path(where).is_relative_to(tmp_path)
