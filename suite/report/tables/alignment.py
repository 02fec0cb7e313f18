"""Whether a planner's results hang on where the walls lie: scenes as drawn, moved, and aligned.

A moved scene (``zigzag@twin=3``) is the same problem as the scene as it is drawn, so the same gaps
should come out. A control (``zigzag_aligned``) has its corners on a lattice.
"""

from collections.abc import Iterable
from typing import Any

import pandas as pd

from suite.report.rows import feasible, places
from suite.report.statistics.agreement import shares_differ
from suite.report.statistics.inference import LEVEL
from suite.report.table import Table
from suite.scenes.catalogue import aligned_names
from suite.scenes.modifiers import MARK

ALLOWED_POINTS, ALLOWED_SHARE = 0.1, 0.2
"""How far the mean gap of moved scenes may lie from that of the scene as drawn: percentage points,
and more of them as a share of the gap as drawn."""

CONTROL = "_aligned"
"""What the name of a control ends in."""

MOVES = ("turn", "shift", "scale", "twin")
"""Modifiers that leave the problem as it is."""

HOLDS, DIFFERS, NOT_COMPARABLE = "holds", "differs", "not comparable"

NOTE = (
    "Mean gaps over the runs with a path. as drawn: the scene of the catalogue; moved: the same "
    "scene turned and shifted, one mean over all; worst: the mean of the worst of them. aligned: "
    "the scene as it was once drawn, with its corners on a lattice. "
    f"{HOLDS}: the gaps as drawn and moved are within {ALLOWED_POINTS:g} percentage points + "
    f"{ALLOWED_SHARE:.0%} of that as drawn, and as many runs find a path; {DIFFERS}: they are not, "
    f"or a path is not found as often (Fisher's exact test, {1.0 - LEVEL:.0%}); "
    f"{NOT_COMPARABLE}: on either side no run has a path. "
).replace("%", " %")


def without_repeats(runs: pd.DataFrame) -> pd.DataFrame:
    """The runs without those of moved scenes and controls, where their scene was run as drawn.

    Ranks and tests over scenes would count the same problem several times.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    """
    as_drawn = set(runs["scene"])
    repeats = [
        scene != (drawn := _uncontrolled(_unmoved(scene))) and drawn in as_drawn
        for scene in runs["scene"]
    ]
    return runs[~pd.Series(repeats, index=runs.index, dtype=bool)]


def _unmoved(scene: str) -> str:
    """The scene as it is drawn; what makes it another problem stays, a radius say.

    Examples
    --------
    >>> _unmoved("zigzag@twin=3"), _unmoved("tb3@radius=0.2"), _unmoved("tb3@radius=0.2,turn=7")
    ('zigzag', 'tb3@radius=0.2', 'tb3@radius=0.2')
    """
    base, _, modifiers = scene.partition(MARK)
    kept = [part for part in modifiers.split(",") if part.partition("=")[0].strip() not in MOVES]
    return MARK.join(filter(None, [base, ",".join(kept)]))


def _uncontrolled(scene: str) -> str:
    return scene.removesuffix(CONTROL) if scene in aligned_names() else scene


def alignment(runs: pd.DataFrame) -> pd.DataFrame:
    """Each planner on each scene as drawn and moved, and on its control.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.

    Returns
    -------
    DataFrame
        A row for each planner and scene that were run as drawn and moved; controls come last.
        Empty if there are none.
    """
    if runs.empty:
        return pd.DataFrame()
    drawn = runs.assign(scene=runs["scene"].map(_unmoved))
    moved = drawn["scene"] != runs["scene"]
    drawn = drawn.assign(moved=moved, as_run=runs["scene"], place=places(drawn))
    rows = [
        _row(str(place), str(planner), group, drawn)
        for (planner, place), group in drawn.groupby(["variant", "place"], sort=False)
        if group["moved"].any() and not group["moved"].all()
    ]
    rows.sort(key=lambda row: row["scene"] in aligned_names())
    return pd.DataFrame(rows)


def _row(place: str, planner: str, group: pd.DataFrame, runs: pd.DataFrame) -> dict[str, Any]:
    drawn, moved = group[~group["moved"]], group[group["moved"]]
    of_control = (runs["place"] == place + CONTROL) & ~runs["moved"] & (runs["variant"] == planner)
    gap, gap_moved = _gap(drawn), _gap(moved)
    return {
        "scene": place,
        "planner": planner,
        "as drawn (%)": gap,
        "moved (%)": gap_moved,
        "worst (%)": float(moved.groupby("as_run").apply(_gap).max()),
        "difference (%)": gap_moved - gap,
        "allowed (%)": _allowed(gap),
        "aligned (%)": _gap(runs[of_control]),
        "with path as drawn": f"{len(feasible(drawn))} of {len(drawn)}",
        "with path moved": f"{len(feasible(moved))} of {len(moved)}",
        "verdict": _verdict(drawn, moved),
    }


def _gap(runs: pd.DataFrame) -> float:
    """Mean gap of the runs with a path, per cent; nan if there are none."""
    return 100.0 * float(feasible(runs)["gap"].mean())


def _allowed(gap: float) -> float:
    return ALLOWED_POINTS + ALLOWED_SHARE * gap


def _verdict(drawn: pd.DataFrame, moved: pd.DataFrame) -> str:
    found, found_moved = len(feasible(drawn)), len(feasible(moved))
    if shares_differ((found, len(drawn)), (found_moved, len(moved))):
        return f"{DIFFERS}: runs with a path"
    if 0 in (found, found_moved):
        return f"{NOT_COMPARABLE}: no path"
    gap, gap_moved = _gap(drawn), _gap(moved)
    same = gap == gap_moved or abs(gap_moved - gap) <= _allowed(gap)  # both may be infinite
    return HOLDS if same else f"{DIFFERS}: gap"


def alignment_tables(runs: pd.DataFrame) -> list[Table]:
    """The table of alignment; none if no scene was run both as drawn and moved.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it.
    """
    frame = alignment(runs)
    if frame.empty:
        return []
    title = "Scenes as drawn, moved, and with their corners on a lattice: mean gap (%)"
    return [Table("alignment", title, frame, NOTE + _counted(frame))]


def _counted(frame: pd.DataFrame) -> str:
    """How often the verdict holds, planner by planner, controls apart."""
    scenes = frame[~frame["scene"].isin(aligned_names())]
    return f"Of the scenes but the controls, it holds {', '.join(_counts(scenes))}."


def _counts(scenes: pd.DataFrame) -> Iterable[str]:
    for planner, group in scenes.groupby("planner", sort=False):
        yield f"on {int((group['verdict'] == HOLDS).sum())} of {len(group)} for {planner}"
