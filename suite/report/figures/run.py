"""The picture of one run that ``kbga-bench plan --plot`` draws."""

from collections.abc import Sequence
from pathlib import Path

from suite.planner import Snapshot
from suite.report.figures.files import save
from suite.report.figures.scene import plot_run
from suite.scenes.catalogue import scene_as_it_was
from suite.scenes.exact import shortest_path
from suite.store.record import RunRecord


def draw_record(record: RunRecord, snapshots: Sequence[Snapshot], file: Path) -> None:
    """Draw a run, its first population if it took a snapshot of it, and the exact optimum.

    Raises
    ------
    KbgaBenchError
        If the file can't be written.
    """
    cell = record.cell
    scene, query = scene_as_it_was(cell.scene_source, cell.query, cell.scene_hash)
    exact = shortest_path(scene, query)
    outcome = f"{record.cost:.2f} m" if record.cost is not None else str(record.status)
    figure = plot_run(
        scene,
        query,
        record.path,
        path_label=f"{cell.variant}, seed {cell.seed}: {outcome}",
        first_population=snapshots[0].paths if snapshots else (),
        optimum=exact.path,
        optimum_label=f"optimum: {exact.length:.2f} m",
    )
    save(figure, file)
