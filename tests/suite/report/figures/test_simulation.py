import matplotlib.pyplot as plt
import numpy as np
import PIL.Image
import pytest
from matplotlib.animation import FFMpegWriter
from shapely.geometry import box

from baselines.visibility_graph import VisibilityGraphPlanner
from suite.errors import KbgaBenchError
from suite.report.figures import simulation
from suite.report.figures.files import save
from suite.report.figures.simulation import (
    animate,
    check_animation_file,
    frame_times,
    plot_snapshots,
    snapshot_times,
)
from suite.scenes.dynamics import Detection, Dynamics, constant_speed
from suite.scenes.scene import Obstacle, make_scene
from suite.simulation.run import simulate
from suite.simulation.settings import Charge, WorldSettings

DOOR = Obstacle("door", box(8, 0, 12, 5), Dynamics(constant_speed((0, 0.5), 0, 4)))
HIDDEN = Obstacle("hidden", box(13, 9, 14, 20), Dynamics(detection=Detection(2.0)))
RAM = Obstacle("ram", box(0, 12, 5, 14), Dynamics(constant_speed((0, -4), 0, 1)))


def run_among(*obstacles, interval=1.0):
    scene = make_scene("hall", box(0, 0, 20, 20), obstacles, ((1, 10), (19, 10)))
    replanner = VisibilityGraphPlanner().replanner(np.random.default_rng(0))
    world = WorldSettings(2.0, interval, 4.0, 20.0, charge=Charge.ZERO)
    return simulate(scene, scene.query(), replanner, world)


@pytest.fixture(scope="module")
def run():
    return run_among(DOOR, HIDDEN)


@pytest.fixture
def sheet(run):
    figure = plot_snapshots(run)
    yield figure
    plt.close(figure)


def panels(figure):
    return [axes for axes in figure.axes if axes.get_visible()]


def labels(figure):
    (legend,) = figure.legends
    return [text.get_text() for text in legend.get_texts()]


def test_a_sheet_has_a_panel_for_each_update_and_one_for_the_end():
    figure = plot_snapshots(run_among(interval=2.0))
    titles = [axes.get_title() for axes in panels(figure)]
    assert titles == [
        "(a) t = 0 s", "(b) t = 2 s", "(c) t = 4 s", "(d) t = 6 s", "(e) t = 8 s",
        "(f) t = 9 s, at the goal",
    ]  # fmt: skip
    plt.close(figure)


def test_of_many_updates_a_sheet_shows_twelve_moments_the_first_and_the_last_among_them():
    run = run_among(DOOR, interval=0.25)
    times = snapshot_times(run)
    assert len(times) == 12
    assert (times[0], times[-1]) == (0.0, run.trajectory.end)
    assert times == sorted(set(times))
    # No gap is left that is more than twice another, in steps of updates.
    assert np.diff(times).max() <= 2 * 36 * 0.25 / 11 + 0.25
    figure = plot_snapshots(run)
    assert len(panels(figure)) == 12
    plt.close(figure)


def test_the_update_that_detects_an_obstacle_is_shown_and_the_one_before_it():
    run = run_among(HIDDEN, interval=0.25)
    (detected,) = run.detected.values()
    assert {detected - 0.25, detected} <= set(snapshot_times(run, most=4))


def test_the_update_that_changes_the_way_ahead_is_shown_and_the_one_before_it():
    run = run_among(Obstacle("late", box(8, 0, 12, 15), Dynamics(appears=2.25)), interval=0.25)
    assert snapshot_times(run, most=4) == [0.0, 2.0, 2.25, run.trajectory.end]


def test_one_legend_names_what_is_in_the_panels_and_nothing_else(sheet):
    assert labels(sheet) == [
        "obstacle", "moving obstacle", "not yet detected",
        "way so far", "current path", "robot", "start", "goal",
    ]  # fmt: skip


def test_a_hit_is_marked_from_when_it_happens():
    run = run_among(RAM)
    assert run.hits
    figure = plot_snapshots(run)
    assert "hit" in labels(figure)
    marks = [[line.get_marker() for line in axes.lines].count("X") for axes in panels(figure)]
    assert (marks[0], marks[-1]) == (0, 1)
    plt.close(figure)


def test_looks_differ_without_colour():
    looks = simulation.LOOKS.values()
    assert len({(look.get("hatch"), look.get("linestyle")) for look in looks}) == len(looks)
    assert simulation.TRAIL["linestyle"] != simulation.PATH["linestyle"]


@pytest.mark.parametrize(
    "suffix", [".png", *(pytest.param(s, marks=pytest.mark.slow) for s in (".pdf", ".svg"))]
)
def test_a_sheet_is_a_small_file_and_the_same_bytes_each_time(run, tmp_path, suffix):
    for name in ("a", "b"):
        save(plot_snapshots(run), tmp_path / f"{name}{suffix}")
    first, second = ((tmp_path / f"{name}{suffix}").read_bytes() for name in ("a", "b"))
    assert first == second
    assert len(first) < 300_000


@pytest.mark.slow
def test_an_animation_moves_between_updates_and_stays_small(run, tmp_path, monkeypatch):
    monkeypatch.setattr(simulation, "MOST_FRAMES", 12)
    animate(run, tmp_path / "a.gif")
    assert (tmp_path / "a.gif").stat().st_size < 500_000
    with PIL.Image.open(tmp_path / "a.gif") as image:
        assert image.format == "GIF"
        assert image.n_frames >= 12
        assert image.info["loop"] == 0
    assert not plt.get_fignums()


def test_frames_are_spread_over_the_run_and_not_too_many(run):
    times = frame_times(run)
    assert (times[0], times[-1]) == (0.0, run.trajectory.end)
    assert len(times) <= simulation.MOST_FRAMES
    assert np.diff(times).max() <= 0.11


def test_a_file_that_cannot_be_an_animation_is_refused_beforehand(tmp_path, monkeypatch):
    check_animation_file(tmp_path / "x.GIF")
    with pytest.raises(KbgaBenchError, match=r"x\.png: animations are \.gif, \.mp4\. Name such"):
        check_animation_file(tmp_path / "x.png")
    with pytest.raises(KbgaBenchError, match="there is no folder"):
        check_animation_file(tmp_path / "none" / "x.gif")
    monkeypatch.setattr(FFMpegWriter, "isAvailable", lambda: False)
    with pytest.raises(KbgaBenchError, match=r"Install it, or name a \.gif file"):
        check_animation_file(tmp_path / "x.mp4")
