"""A matrix that went wrong is an error of a line or two, or a right matrix: no traceback."""

import random
import tomllib
from functools import cache

import pytest

from suite.errors import MatrixError
from suite.harness import matrix as matrix_module
from suite.harness.matrix import load_matrix
from suite.harness.matrix_file import FOLDER, matrix_file, matrix_names
from suite.plugins.discovery import planner_info
from suite.scenes.catalogue import load_scene
from tests.mutations import as_toml, check_files, mutated_bytes, mutated_document

SAMPLE, ALL = 100, 1000
AT_A_TIME = 50
"""Mutations of one test."""

LONGEST = 800
"""Characters of an error: it may name all planners or all scenes that there are."""

CELLS = 20_000
"""Of a matrix whose cells are looked at; more would take the time of many mutations."""

LOTS = [
    pytest.param(first, marks=[pytest.mark.slow] if first >= SAMPLE else [])
    for first in range(0, ALL, AT_A_TIME)
]


@pytest.fixture(scope="module", autouse=True)
def _scenes_are_drawn_once():
    """The same few scenes and planners are asked for hundreds of times."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(matrix_module, "load_scene", cache(load_scene))
        patch.setattr(matrix_module, "planner_info", cache(planner_info))
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the scene files that the matrices of the suite name."""
    made = tmp_path_factory.mktemp("matrices")
    for file in FOLDER.glob("*.geojson"):
        (made / file.name).write_bytes(file.read_bytes())
    return made


OF_QUERIES = """
scenes = [
  "maze",
  { scene = "zigzag", queries = ["main", "6,38:94,36"], radius = 0.25, snap = true },
  { scene = "door@at=3", queries = { random = 3, seed = 2, connected = false } },
]
queries = { random = 5, seed = 1, min_distance = 20.0, connected = true }
radius = 0.5
seeds = 2

[[planner]]
planner = "visibility-graph"
"""


def mutation(seed: int) -> bytes:
    """A matrix that went wrong: every second one is a document, the others are bytes."""
    name = random.Random(seed).choice([*matrix_names(), OF_QUERIES])
    text = name if name == OF_QUERIES else _lighter(matrix_file(name).read_text())
    if seed % 2:
        return mutated_bytes(text, seed)
    return as_toml(mutated_document(tomllib.loads(text), seed)).encode()


def _lighter(text: str) -> str:
    """The same with scenes that are drawn in no time; of twins two are as good as ten."""
    return text.replace("twin=1..10", "twin=1..2").replace("000", "0")


@pytest.mark.parametrize("first", LOTS)
def test_a_matrix_that_went_wrong_is_an_error_or_a_right_matrix(first, folder):
    def files():
        for seed in range(first, first + AT_A_TIME):
            file = folder / f"{seed}.toml"
            file.write_bytes(mutation(seed))
            yield file, file

    check_files(files(), load_matrix, check_right, MatrixError, LONGEST)


def check_right(found: matrix_module.Matrix) -> None:
    """Its cells are as many as its parts say, each another one, and each can be named."""
    of_scenes = [
        len(queries) * max(len(worlds), 1) * len(seeds) * len(found.variants)
        for queries, worlds, seeds in zip(
            found.queries, found.worlds, found.scene_seeds, strict=True
        )
    ]
    if sum(of_scenes) <= CELLS:
        cells = found.cells()
        assert len(cells) == sum(of_scenes)
        assert len({cell.key for cell in cells}) == len(cells)
