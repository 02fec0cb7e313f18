import matplotlib.pyplot as plt
import numpy as np
import pytest
import shapely

from suite.errors import KbgaBenchError
from suite.report.figures.files import check_figure_file, save
from suite.report.figures.scene import plot_run, plot_scene_results
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from suite.scenes.scene import make_scene


@pytest.fixture(scope="module")
def scene():
    return load_scene("zigzag")


@pytest.fixture(scope="module")
def path(scene):
    return shortest_path(scene, scene.query()).path


def labels(figure):
    (legend,) = figure.legends
    return [text.get_text() for text in legend.get_texts()]


def test_a_run_shows_population_path_optimum_start_and_goal(scene, path):
    figure = plot_run(
        scene,
        scene.query(),
        path,
        path_label="kbga: 155.8 m",
        first_population=[path, path[::2]],
        optimum=path,
    )
    assert labels(figure) == [
        "first population (2 paths)", "kbga: 155.8 m", "optimum", "start", "goal",
    ]  # fmt: skip
    assert figure.axes[0].get_aspect() == 1.0
    plt.close(figure)


def test_a_run_without_a_path_is_drawn_too(scene):
    figure = plot_run(scene, scene.query(), None, path_label="kbga: exhausted")
    assert labels(figure) == ["start", "goal"]
    plt.close(figure)


def test_planners_differ_in_colour_and_in_line(scene, path):
    figure = plot_scene_results(scene, scene.query(), dict.fromkeys("abcdef", path))
    lines = [line for line in figure.axes[0].lines if len(line.get_xdata()) > 1]
    assert len({line.get_color() for line in lines}) == 6
    assert len({line.get_linewidth() for line in lines}) == 6
    plt.close(figure)


@pytest.mark.parametrize("suffix", [".png", ".pdf", ".svg"])
def test_the_same_figure_gives_the_same_bytes(scene, path, tmp_path, suffix):
    for name in ("a", "b"):
        figure = plot_scene_results(scene, scene.query(), {"kbga": path})
        save(figure, tmp_path / f"{name}{suffix}")
    first, second = ((tmp_path / f"{name}{suffix}").read_bytes() for name in ("a", "b"))
    assert first == second
    assert not plt.get_fignums()


def test_a_picture_is_small_enough_to_be_kept(scene, path, tmp_path):
    save(
        plot_scene_results(scene, scene.query(), dict.fromkeys("abcdef", path)), tmp_path / "a.png"
    )
    assert (tmp_path / "a.png").stat().st_size < 100_000


def test_a_file_that_cannot_be_a_figure_is_refused_beforehand(tmp_path):
    check_figure_file(tmp_path / "x.PNG")
    with pytest.raises(KbgaBenchError, match=r"figures are \.png"):
        check_figure_file(tmp_path / "x.txt")
    with pytest.raises(KbgaBenchError, match="there is no folder"):
        check_figure_file(tmp_path / "none" / "x.png")


def test_a_scene_with_holes_and_another_shape_is_drawn(tmp_path):
    ring = shapely.box(2, 1, 8, 4).difference(shapely.box(4, 2, 6, 3))
    scene = make_scene("ring", shapely.box(0, 0, 30, 5), [ring], {"main": ((1, 1), (29, 4))})
    figure = plot_run(
        scene, scene.query(), np.array([[1.0, 1.0], [29.0, 4.0]]), path_label="straight"
    )
    save(figure, tmp_path / "ring.png")
    assert (tmp_path / "ring.png").stat().st_size > 1000
