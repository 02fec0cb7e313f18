"""What each family promises of its shapes: mazes without loops, passages as wide as they say."""

import numpy as np
import pytest
import shapely

from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.families.instance import instance
from suite.scenes.reach import no_way
from suite.scenes.scene import Scene

SEEDS = range(30)


def parameters(scene: Scene) -> dict:
    return scene.properties["parameters"]


def is_passable(name: str, radius: float) -> bool:
    """Whether a robot of a radius gets through."""
    scene = load_scene(f"{name}@radius={radius:.6f}")
    return no_way(scene, scene.query()) is None


def bends(scene: Scene) -> int:
    return len(shortest_path(scene, scene.query()).path) - 2


def loops(scene: Scene) -> int:
    """Obstacles that free space leads around: holes in it."""
    return sum(len(region.interiors) for region in scene.regions.geoms)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_perfect_maze_has_no_loop_and_a_braided_one_has(seed):
    scene = instance("maze", seed)
    assert len(scene.regions.geoms) == 1
    assert (loops(scene) == 0) == (parameters(scene)["braid"] == 0.0)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_passage_of_narrow_is_the_only_one_and_as_wide_as_it_says(seed):
    width = parameters(instance("narrow", seed))["width"]
    assert is_passable(f"narrow-{seed}", 0.49 * width)
    assert not is_passable(f"narrow-{seed}", 0.51 * width)


@pytest.mark.parametrize("seed", SEEDS)
def test_nothing_wider_than_its_mouth_leaves_a_bug_trap(seed):
    mouth = parameters(instance("bug_trap", seed))["mouth"]
    assert is_passable(f"bug_trap-{seed}", 0.1 * mouth)
    assert not is_passable(f"bug_trap-{seed}", 0.51 * mouth)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_way_out_of_a_spiral_winds_with_its_wall(seed):
    scene = instance("spiral", seed)
    path = shortest_path(scene, scene.query()).path
    steps = np.diff(path, axis=0)
    headings = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    turned = abs(headings[-1] - headings[0]) / (2.0 * np.pi)
    # The corridor begins where the wall has a second turn, and the path is taut.
    assert turned >= parameters(scene)["turns"] - 1.75


@pytest.mark.parametrize("seed", SEEDS)
def test_a_zigzag_bends_at_each_wall_and_a_comb_need_not(seed):
    scene = instance("zigzag", seed)
    if not parameters(scene)["comb"]:
        assert bends(scene) >= parameters(scene)["walls"]


@pytest.mark.parametrize("seed", SEEDS)
def test_an_office_is_one_floor_and_its_way_leads_through_two_doors(seed):
    scene = instance("office", seed)
    assert len(scene.regions.geoms) == 1
    door = parameters(scene)["door"]
    assert not is_passable(f"office-{seed}", 0.51 * door)


@pytest.mark.parametrize("seed", SEEDS)
def test_all_of_a_city_can_be_reached_yards_included(seed):
    assert len(instance("city", seed).regions.geoms) == 1


@pytest.mark.parametrize("seed", SEEDS)
def test_all_rooms_with_clutter_can_be_reached(seed):
    scene = instance("rooms_with_clutter", seed)
    count = parameters(scene)["rooms"] ** 2 * parameters(scene)["pieces"]
    inner = shapely.union_all([o.polygon for o in scene.obstacles])
    assert len(scene.regions.geoms) == 1
    assert shapely.get_num_geometries(inner) >= count


@pytest.mark.parametrize("family", ["forest", "clutter", "scattered"])
def test_what_is_thrown_stands_apart(family):
    for seed in range(6):
        scene = instance(family, seed)
        polygons = [obstacle.polygon for obstacle in scene.obstacles]
        gap = parameters(scene).get("gap", 0.1)
        tree = shapely.STRtree(polygons)
        pairs = tree.query(polygons, predicate="dwithin", distance=gap - 0.01)
        assert (pairs[0] == pairs[1]).all()


def test_trees_have_12_to_24_sides():
    sides = {len(o.polygon.exterior.coords) - 1 for o in instance("forest", 2).obstacles}
    assert sides <= set(range(12, 25))
    assert len(sides) > 5
