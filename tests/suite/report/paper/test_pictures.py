"""The paper's pictures: which there are, and that routes are told apart by what they go round."""

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
import shapely

from suite.planner import Snapshot
from suite.report.paper.pictures import (
    best_of_routes,
    least_inside,
    paper_pictures,
    plot_evolution,
)
from suite.scenes.scene import make_scene

BOX = shapely.box(4, 4, 6, 6)
ABOVE = np.array([[1.0, 5.0], [5.0, 8.0], [9.0, 5.0]])
HIGHER = np.array([[1.0, 5.0], [5.0, 9.0], [9.0, 5.0]])
BELOW = np.array([[1.0, 5.0], [5.0, 2.0], [9.0, 5.0]])
THROUGH = np.array([[1.0, 5.0], [9.0, 5.0]])


def scene_called(name):
    return make_scene(name, shapely.box(0, 0, 10, 10), [BOX], {"main": ((1, 5), (9, 5))})


def runs_of(scene, variants=("kbga",) * 3):
    return pd.DataFrame(
        {
            "key": [f"k{i}" for i in range(len(variants))],
            "scene": scene,
            "query": "main",
            "variant": variants,
            "status": "solved",
            "cost": [10.0, 11.0, 9.5][: len(variants)],
        }
    )


PATHS = {"k0": ABOVE, "k1": HIGHER, "k2": BELOW}
GENERATIONS = [
    Snapshot(0, (THROUGH, BELOW)),
    Snapshot(1, (ABOVE,), HIGHER),
    Snapshot(2, (ABOVE,), HIGHER),
    Snapshot(7, (ABOVE,), ABOVE),
]


def pictures(name, runs=None, snapshots=None):
    scene = scene_called(name)
    runs = runs_of(name) if runs is None else runs
    made = paper_pictures(runs, PATHS, snapshots or {}, [(scene, scene.query())])
    for figure in made.values():
        plt.close(figure)
    return made


def test_paths_on_both_sides_of_an_obstacle_are_two_routes_and_the_shortest_of_each_is_shown():
    best = best_of_routes(scene_called("clustered"), runs_of("clustered"), PATHS)
    assert list(best) == ["(a), 1 of 3 runs", "(b), 2 of 3 runs"]
    assert [cost for _, cost in best.values()] == [9.5, 10.0]
    assert [path.tolist() for path, _ in best.values()] == [BELOW.tolist(), ABOVE.tolist()]


@pytest.mark.parametrize(
    ("scene", "name"), [("unstructured", "paper-fig-6-unstructured"), ("maze", "paper-fig-7-maze")]
)
def test_there_is_an_evolution_where_the_population_was_kept(scene, name):
    assert list(pictures(scene, snapshots={"k1": GENERATIONS})) == [name]
    assert pictures(scene) == {}


def test_clustered_shows_its_routes_and_zigzag_what_lacks_operators():
    assert list(pictures("clustered")) == ["paper-fig-10-clustered"]
    crippled = runs_of("zigzag", ("plain-ga", "kbga-without-crossover-and-mutation"))
    assert list(pictures("zigzag", crippled)) == ["paper-fig-13-zigzag"]
    assert pictures("zigzag") == {}


def test_an_evolution_shows_each_better_path_once():
    scene = scene_called("maze")
    figure = plot_evolution(scene, scene.query(), GENERATIONS, ABOVE, 10.0)
    titles = [axes.get_title() for axes in figure.axes]
    assert titles[0] == "(a) first population, 2 paths"
    assert titles[3] == "(d) final path: 10.00 m"
    legend = figure.axes[2].get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["1", "7"]
    plt.close(figure)


def test_the_path_least_in_obstacles_is_the_shortest_of_those_that_avoid_them():
    assert least_inside(scene_called("maze"), (THROUGH, HIGHER, ABOVE)) is ABOVE
