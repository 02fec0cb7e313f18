"""Instances of families: solvable, off any lattice, and the same for the same seed."""

import hashlib
import json
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
import shapely

from suite.errors import SceneError
from suite.scenes.catalogue import has_scene, load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.families.draft import SIDE
from suite.scenes.families.instance import FAMILIES, LEAST_DETOUR, instance

SEEDS = range(6)
KNOWN = json.loads((Path(__file__).parent / "hashes.json").read_text(encoding="utf-8"))
"""SHA-256 of the hashes of the first 4 and of the first 100 instances of each family."""


def digest(family: str, count: int) -> str:
    hashes = "\n".join(instance(family, seed).hash for seed in range(count))
    return hashlib.sha256(hashes.encode()).hexdigest()[:16]


@pytest.mark.parametrize("family", FAMILIES)
def test_each_instance_has_a_way_that_its_properties_know_and_that_is_not_straight(family):
    for seed in SEEDS:
        scene = instance(family, seed)
        query = scene.query()
        found = shortest_path(scene, query)
        straight = np.hypot(*(query.goal - query.start))
        assert found.length == pytest.approx(scene.stored_optimum(query), rel=1e-12)
        assert found.length >= LEAST_DETOUR * straight


@pytest.mark.parametrize("family", FAMILIES)
def test_the_room_is_turned_and_as_large_as_it_should_be(family):
    angles = set()
    for seed in SEEDS:
        room = instance(family, seed).workspace
        assert room.area == pytest.approx(SIDE**2, rel=1e-6)
        (ax, ay), (bx, by) = shapely.get_coordinates(shapely.minimum_rotated_rectangle(room))[:2]
        angles.add(round(np.degrees(np.arctan2(by - ay, bx - ax)) % 90.0, 3))
    assert len(angles) == len(SEEDS)
    assert not angles & {0.0, 45.0}


@pytest.mark.parametrize("family", FAMILIES)
def test_the_same_seed_gives_the_same_scene_on_any_machine(family):
    assert digest(family, 4) == KNOWN[family]["4"]


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_a_hundred_seeds_give_the_same_scenes_on_any_machine(family):
    assert digest(family, 100) == KNOWN[family]["100"]


def test_another_process_draws_the_same_scenes():
    code = (
        "from suite.scenes.families.instance import FAMILIES, instance\n"
        "print(*(instance(family, 5).hash for family in FAMILIES))"
    )
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.split() == [instance(family, 5).hash for family in FAMILIES]


@pytest.mark.parametrize("family", FAMILIES)
def test_other_seeds_give_other_scenes_of_other_parameters(family):
    scenes = [instance(family, seed) for seed in SEEDS]
    assert len({scene.hash for scene in scenes}) == len(scenes)
    named = {field.name for field in fields(FAMILIES[family])}
    for parameter in named:
        assert len({scene.properties["parameters"][parameter] for scene in scenes}) > 1, parameter
    assert named == set(scenes[0].properties["parameters"])


@pytest.mark.parametrize("family", FAMILIES)
def test_an_instance_is_named_like_any_scene_and_can_be_grown(family):
    assert has_scene(f"{family}-3")
    assert load_scene(f"{family}-3").hash == instance(family, 3).hash
    assert load_scene(f"{family}-3@radius=0.01").radius == 0.01


@pytest.mark.parametrize(("family", "seed"), [("mazes", 1), ("maze", -1)])
def test_what_is_no_instance_is_refused_in_words(family, seed):
    with pytest.raises(SceneError, match="give one of scattered, maze"):
        instance(family, seed)
