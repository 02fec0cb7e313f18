"""A map that went wrong is an error of a line or two, or a right scene: no traceback."""

import io
import random
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
import yaml
from PIL import Image

from suite.errors import SceneError
from suite.referee.path import Referee
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.scene import Scene
from tests.mutations import check_files, mutated_bytes, mutated_document
from tests.suite.scenes.maps.files import ROOM, ROS, grid_text, scen_text, write_grid, write_ros

SAMPLE, ALL = 50, 2000
AT_A_TIME = 50
"""Mutations of one test."""

LONGEST = 600
"""Characters of an error."""

LOTS = [
    pytest.param(first, marks=[pytest.mark.slow] if first >= SAMPLE else [])
    for first in range(0, ALL, AT_A_TIME)
]


def encoded(kind: str, pixels: np.ndarray = ROOM) -> bytes:
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, kind)
    return file.getvalue()


def spoiled(folder: Path, seed: int) -> tuple[Path, Path]:
    """A map of which one file went wrong: what to load, and the file."""
    rng = random.Random(seed)
    own = rng.getrandbits(32)  # or a kind of file would always go wrong in the same way
    which = rng.choice(["map", "scen", "yaml", "yaml", "image", "grid image"])
    if which in ("map", "scen"):
        named = write_grid(folder)
        bad = named if which == "map" else named.with_name("cave.map.scen")
        bad.write_bytes(mutated_bytes(bad.read_text(), own))
        return rng.choice([named, named.with_name("cave.map.scen")]), bad
    if which == "yaml":
        named = write_ros(folder)
        document = yaml.safe_dump(mutated_document(ROS, own), default_flow_style=None)
        named.write_bytes(document.encode() if rng.random() < 0.7 else mutated_bytes(document, own))
        return named, named
    kind, suffix = rng.choice([("PNG", "png"), ("PPM", "pgm"), ("BMP", "bmp"), ("TIFF", "tif")])
    named = write_ros(folder, image=f"room.{suffix}")
    bad = folder / f"room.{suffix}"
    bad.write_bytes(mutated_bytes(encoded(kind), own))
    return (named if which == "grid image" else bad), bad


def spoiled_maps(
    place: Path, first: int, spoil: Callable[[Path, int], tuple[Path, Path]]
) -> Iterator[tuple[Path, Path]]:
    """The maps of a test, each in a folder of its own."""
    for seed in range(first, first + AT_A_TIME):
        folder = place / str(seed)
        folder.mkdir()
        yield spoil(folder, seed)


@pytest.mark.parametrize("first", LOTS)
def test_a_map_that_went_wrong_is_an_error_or_a_right_scene(first, tmp_path):
    files = spoiled_maps(tmp_path, first, spoiled)
    check_files(files, load_scene, check_right, SceneError, LONGEST)


def check_right(scene: Scene) -> None:
    """Solver and referee agree on it."""
    referee = Referee(scene)
    for query in scene.queries:
        if query.blocked is not None:
            continue
        found = shortest_path(scene, query)
        if found.path is not None:
            verdict = referee.judge(query, found.path)
            assert verdict.valid, verdict.reason
            assert verdict.length == pytest.approx(found.length, rel=1e-9, abs=1e-9)


def test_what_is_spoiled_is_right_before(tmp_path):
    for name in (write_grid(tmp_path), write_ros(tmp_path)):
        check_right(load_scene(str(name)))
    assert (tmp_path / "cave.map").read_text() == grid_text()
    assert (tmp_path / "cave.map.scen").read_text() == scen_text()
