"""Pictures of a simulated run: a sheet of snapshots, as in the paper's Fig. 11, and an animation.

Metres, x right, y up. What moves is darker and hatched, what the robot doesn't know is dashed and
empty; the way so far is a full line and the path ahead a broken one: grey tells them apart too.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from string import ascii_lowercase
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FFMpegWriter, PillowWriter
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, PathPatch

from suite.errors import KbgaBenchError, check_file, writing
from suite.report.figures import style
from suite.report.figures.scene import draw_ends, draw_room, outline
from suite.simulation.run import Outcome, Simulation
from suite.simulation.view import Sight, View, is_turn, update_times, view_at

ANIMATIONS = (".gif", ".mp4")

MOST_PANELS = 12
COLUMNS = 4
PANEL = 2.0
"""Width of a panel, inches."""

FRAMES_PER_SECOND = 10
"""Frames for each simulated second, as long as they are not more than MOST_FRAMES."""
MOST_FRAMES = 120
SHOWN_PER_SECOND = 15
STANDS_S = 2
"""Seconds for which the end stands before an animation begins anew."""
FRAME = 5.0
"""Width of an animation, inches."""
FRAME_DPI = 100

LOOKS: dict[Sight, dict[str, Any]] = {
    Sight.STILL: {"facecolor": style.OBSTACLE, "edgecolor": style.OBSTACLE_EDGE, "linewidth": 0.7},
    Sight.MOVING: {
        "facecolor": "#8f8f8f",
        "edgecolor": "#303030",
        "linewidth": 0.9,
        "hatch": "//////",
    },
    Sight.UNDETECTED: {
        "facecolor": "none",
        "edgecolor": style.OBSTACLE_EDGE,
        "linewidth": 0.9,
        "linestyle": (0, (3, 2)),
    },
}
TRAIL: dict[str, Any] = {"color": style.LINES[1][0], "linestyle": "-"}
PATH: dict[str, Any] = {"color": style.BEST, "linestyle": (0, (4, 1.5))}
ROBOT: dict[str, Any] = {
    "marker": "o",
    "markerfacecolor": "black",
    "markeredgecolor": "white",
    "markeredgewidth": 0.5,
    "linestyle": "none",
}
HIT: dict[str, Any] = {"marker": "X", "color": style.LINES[3][0], "markeredgecolor": "black"}


def plot_snapshots(run: Simulation, most: int = MOST_PANELS) -> Figure:
    """Draw a run as a sheet of snapshots: (a), (b), ...

    Parameters
    ----------
    run : Simulation
    most : int
        Panels at most. Of more moments some are left out, evenly.

    Returns
    -------
    Figure
        A panel for each update, and one for the end of the run.

    References
    ----------
    Hu and Yang, Fig. 11 and 12.
    """
    views = [view_at(run, time) for time in snapshot_times(run, most)]
    columns, height = min(COLUMNS, len(views)), style.height_for(run.scene, PANEL)
    rows = -(-len(views) // columns)
    size = (PANEL * max(columns, 2) + 0.5, (height + 0.15) * rows + 0.8)
    figure, grid = plt.subplots(
        rows, columns, figsize=size, layout="constrained", sharex=True, sharey=True, squeeze=False
    )
    for axes in grid.flat[len(views) :]:
        axes.set_visible(False)
    for letter, axes, view in zip(ascii_lowercase, grid.flat, views, strict=False):
        _draw(axes, run, view, scale=0.6)
        # Updates come at round times, but the interval may be any.
        axes.set_title(
            f"({letter}) t = {round(view.time, 2):g} s{_end(run, view)}", fontsize=style.LABEL
        )
        style.label_metres(axes)
    _legend(figure, run, views, columns=4 if columns > 2 else 2)
    return figure


def snapshot_times(run: Simulation, most: int = MOST_PANELS) -> list[float]:
    """The moments that a sheet shows: start and end, what happened between, and a fill.

    Updates come first at which the way ahead changed or an obstacle was detected, each with the
    update before it. The other panels go where the gaps are widest.
    """
    times = [*update_times(run), run.trajectory.end]
    last = len(times) - 1
    events = _turns(run) | set(run.detected.values())
    pairs = [
        i for event in sorted(events) if event in times for i in _with_one_before(times, event)
    ]
    chosen = set(list(dict.fromkeys([0, last, *pairs]))[:most])
    while len(chosen) < min(most, len(times)):
        others = set(range(last)) - chosen
        chosen.add(max(sorted(others), key=lambda i: min(abs(i - c) for c in chosen)))
    return [times[i] for i in sorted(chosen)]


def _with_one_before(times: Sequence[float], event: float) -> list[int]:
    number = times.index(event)
    return [number, max(number - 1, 0)]


def _turns(run: Simulation) -> set[float]:
    """Times of the plans that are longer or shorter than what was left of the plan before."""
    speed = run.settings.speed
    return {
        new.time
        for old, new in pairwise(run.replans)
        if is_turn(old.cost, new.cost, speed * (new.time - old.time))
    }


def frame_times(run: Simulation) -> list[float]:
    """The moments that an animation shows: evenly spread, first and last of the run included."""
    end = run.trajectory.end
    count = min(MOST_FRAMES, int(end * FRAMES_PER_SECOND) + 2)
    return np.linspace(0.0, end, count).tolist()


def check_animation_file(file: Path) -> None:
    """Refuse a file that an animation can't be written to, before anything is run for it.

    Raises
    ------
    KbgaBenchError
        If its kind is unknown, its folder is missing, or the program that writes it is.
    """
    check_file(file, "animations", ANIMATIONS)
    if file.suffix.lower() == ".mp4" and not FFMpegWriter.isAvailable():
        raise KbgaBenchError(
            f"{file}: the program ffmpeg, which writes .mp4, is not there. "
            "Install it, or name a .gif file."
        )


def animate(run: Simulation, file: Path) -> None:
    """Write a run as a moving picture; obstacles and robot move between updates too.

    Parameters
    ----------
    run : Simulation
    file : Path
        As :func:`check_animation_file` allows it.

    Raises
    ------
    KbgaBenchError
        If the file can't be written.
    """
    views = [view_at(run, time) for time in frame_times(run)]
    figure, axes = plt.subplots(
        figsize=(FRAME, style.height_for(run.scene, FRAME) + 1.0), layout="constrained"
    )

    def draw(view: View) -> None:
        axes.clear()
        _draw(axes, run, view, scale=1.0)
        # On the left, where it begins: in the middle it would jump with its width.
        axes.set_title(f"{run.scene.name}, t = {view.time:.1f} s{_end(run, view)}", loc="left")
        axes.set_xlabel("x (m)")
        axes.set_ylabel("y (m)")

    draw(views[0])
    _legend(figure, run, views, columns=2)
    # Laid out once: otherwise the picture jumps with the width of its title.
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    frames = [*views, *views[-1:] * (STANDS_S * SHOWN_PER_SECOND)]
    kind = PillowWriter if file.suffix.lower() == ".gif" else FFMpegWriter
    writer = kind(fps=SHOWN_PER_SECOND)
    try:
        # Not by FuncAnimation, which draws each frame once more than it writes it.
        with writing(file), writer.saving(figure, str(file), FRAME_DPI):
            for view in frames:
                draw(view)
                writer.grab_frame()
    finally:
        plt.close(figure)


def _end(run: Simulation, view: View) -> str:
    """How the run ended, if it has."""
    if view.time < run.trajectory.end:
        return ""
    return ", at the goal" if run.outcome is Outcome.REACHED else ", out of time"


def _draw(axes: Axes, run: Simulation, view: View, scale: float) -> None:
    room = draw_room(axes, run.scene)
    for seen in view.obstacles:
        drawn = axes.add_patch(PathPatch(outline(seen.polygon), **LOOKS[seen.sight]))
        drawn.set_clip_path(room)
    if view.path is not None:
        axes.plot(*view.path.T, linewidth=2.4 * scale, **PATH)
    axes.plot(*view.trail.T, linewidth=2.4 * scale, **TRAIL)
    draw_ends(axes, run.query, scale)
    for hit in run.hits:
        if hit.time <= view.time:
            axes.plot(*hit.place, markersize=11 * scale, linestyle="none", zorder=6, **HIT)
    axes.plot(*view.robot, markersize=6.5 * scale, zorder=7, **ROBOT)


def _legend(figure: Figure, run: Simulation, views: Sequence[View], columns: int) -> None:
    """One legend for all views, of what is in any of them."""
    sights = {seen.sight for view in views for seen in view.obstacles}
    handles: list[Artist] = [
        Patch(label=sight.value, **look) for sight, look in LOOKS.items() if sight in sights
    ]
    handles += [
        Line2D([], [], linewidth=2.0, label="way so far", **TRAIL),
        Line2D([], [], linewidth=2.0, label="current path", **PATH),
        Line2D([], [], markersize=6, label="robot", **ROBOT),
    ]
    handles += [
        Line2D([], [], marker="o", markersize=7, label="start", **style.ENDS),
        Line2D([], [], marker="*", markersize=11, label="goal", **style.ENDS),
    ]
    if run.hits:
        handles.append(Line2D([], [], markersize=8, linestyle="none", label="hit", **HIT))
    style.legend_below(figure, handles=handles, ncols=columns, handlelength=3.0)
