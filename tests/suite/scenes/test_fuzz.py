"""A scene file that went wrong is an error of a line or two, or a right scene: no traceback."""

import json
import random
from functools import partial
from pathlib import Path

import numpy as np
import pytest
import shapely

from suite.errors import SceneError
from suite.harness.matrix_file import FOLDER as MATRICES
from suite.referee.path import Referee
from suite.scenes.catalogue import aligned_names, dynamic_names, scene_file, scene_names
from suite.scenes.exact import shortest_path
from suite.scenes.geojson import read_scene, write_scene
from suite.scenes.scene import Scene, scene_at
from tests.mutations import as_json, check_files, mutated_bytes, mutated_document

SAMPLE, ALL = 100, 2000
AT_A_TIME = 50
"""Mutations of one test."""

LONGEST = 600
"""Characters of an error: it names a file, a place, what stands there, and how to mend it."""

FILES = [
    *(scene_file(name) for name in (*scene_names(), *dynamic_names(), *aligned_names())),
    *sorted(MATRICES.glob("*.geojson")),
]

EVERYTHING = {
    "type": "FeatureCollection",
    "name": "everything",
    "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}},
    "properties": {
        "optimum": {"main": 8.5, "b": None},
        "world": {"speed": 2.0},
        "gates": {"left": [[0, 5], [4, 5]]},
    },
    "features": [
        {"type": "Feature", "properties": {"role": role, **own}, "geometry": geometry}
        for role, own, geometry in [
            ("workspace", {}, {"type": "Polygon", "coordinates": [
                [[0, 0], [20, 0], [20, 20], [0, 20], [0, 0]],
                [[15, 15], [17, 15], [17, 17], [15, 15]]]}),
            ("obstacle", {"name": "two"}, {"type": "MultiPolygon", "coordinates": [
                [[[4, 4], [6, 4], [6, 6], [4, 4]]], [[[6, 6], [8, 6], [8, 9], [6, 6]]]]}),
            ("obstacle", {"motion": {"waypoints": [[0, 0, 0], [5, 1, 2]]}, "appears": 1.0},
             {"type": "Polygon", "coordinates": [[[10, 2], [12, 2], [12, 3], [10, 2]]]}),
            ("obstacle", {"motion": {"velocity": [1, 0], "start": 1, "stop": 4},
                          "detection": {"range": 3}, "removal": {"time": 9}},
             {"type": "Polygon", "coordinates": [[[2, 12], [4, 12], [4, 13], [2, 12]]]}),
            ("obstacle", {"removal": {"place": [1, 1], "distance": 2}, "detection": {}},
             {"type": "Polygon", "coordinates": [[[12, 12], [14, 12], [14, 13], [12, 12]]]}),
            ("start", {}, {"type": "Point", "coordinates": [1, 1]}),
            ("goal", {}, {"type": "Point", "coordinates": [19, 19]}),
            ("start", {"query": "b"}, {"type": "Point", "coordinates": [1, 2]}),
            ("goal", {"query": "b"}, {"type": "Point", "coordinates": [18, 3]}),
        ]
    ],
}  # fmt: skip
"""With everything that the format has: the others leave most of it out."""


LOTS = [
    pytest.param(first, marks=[pytest.mark.slow] if first >= SAMPLE else [])
    for first in range(0, ALL, AT_A_TIME)
]


def mutation(seed: int) -> bytes:
    """A scene file that went wrong: every second one is a document, every third of everything."""
    rng = random.Random(seed)
    text = rng.choice(FILES).read_text() if seed % 3 else json.dumps(EVERYTHING)
    if seed % 2:
        return mutated_bytes(text, seed)
    return as_json(mutated_document(json.loads(text), seed)).encode()


@pytest.mark.parametrize("first", LOTS)
def test_a_scene_file_that_went_wrong_is_an_error_or_a_right_scene(first, tmp_path):
    def files():
        for seed in range(first, first + AT_A_TIME):
            file = tmp_path / f"{seed}.geojson"
            file.write_bytes(mutation(seed))
            yield file, file

    again = tmp_path / "again.geojson"
    check_files(files(), read_scene, partial(check_right, file=again), SceneError, LONGEST)


def check_right(scene: Scene, file: Path) -> None:
    """It is the same when it is written and read, and solver and referee agree on it."""
    write_scene(scene, file)
    again = read_scene(file)
    assert (again.name, again.hash) == (scene.name, scene.hash)
    assert _sorted(again.properties) == _sorted(scene.properties)
    assert [_ends(query) for query in again.queries] == [_ends(query) for query in scene.queries]
    now = scene_at(scene, 0.0) if scene.is_dynamic else scene
    referee = Referee(now)
    for query in now.queries:
        found = shortest_path(now, query)
        straight = float(np.hypot(*(query.goal - query.start)))
        if found.path is None:
            assert straight > 0.0
            continue
        verdict = referee.judge(query, found.path)
        assert verdict.valid, verdict.reason
        assert verdict.length == pytest.approx(found.length, rel=1e-9, abs=1e-9)
        assert found.length >= straight * (1.0 - 1e-9)
        free = shapely.LineString([query.start, query.goal]) if straight else None
        if free is not None and referee.judge(query, [query.start, query.goal]).valid:
            assert found.length == pytest.approx(straight, rel=1e-9)


def _sorted(properties):
    return json.dumps(dict(properties), sort_keys=True)


def _ends(query):
    return query.name, query.start.tolist(), query.goal.tolist()
