"""All tables of a store's runs: pure functions of its rows."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

from suite.report.optima import check_optima
from suite.report.paper.contrasts import contrast_table
from suite.report.paper.tables import COST_NOTE, paper_tables
from suite.report.paper.verdicts import Rows, verdict_table
from suite.report.rows import blocked_note, is_blocked, is_simulated, newest
from suite.report.statistics.anytime import Steps, steps_of
from suite.report.statistics.clock import dropped_note, fair
from suite.report.statistics.over_queries import only_maps
from suite.report.table import Table
from suite.report.tables.ablation import ablation_tables
from suite.report.tables.alignment import alignment_tables, without_repeats
from suite.report.tables.budgets import budget_tables
from suite.report.tables.differences import difference_tables
from suite.report.tables.queries import map_tables
from suite.report.tables.ranking import ranking_tables
from suite.report.tables.scenes import scenes_table
from suite.report.tables.simulated import simulated_tables
from suite.report.tables.statistics import check_reference, statistics_tables
from suite.report.tables.strata import STRATUM
from suite.report.tables.studies import study_tables
from suite.report.tables.summary import summary_tables
from suite.report.tables.targets import target_tables
from suite.report.words import joined
from suite.store.read import (
    read_events,
    read_first_measures,
    read_replans,
    read_runs,
    read_simulations,
)
from suite.store.scenes import ends_of_rows, sizes_of_scenes

BOOTSTRAP_SEED = 2004
"""Any will do; the same rows give the same intervals."""

WITHOUT_MAPS = (
    "Maps, scenes of many queries, are not here: there the queries are the sample and not the "
    "runs; the table maps-paired says how surely planners differ."
)


def all_tables(
    runs: pd.DataFrame,
    first: pd.DataFrame | None = None,
    events: pd.DataFrame | None = None,
    *,
    simulations: pd.DataFrame | None = None,
    replans: pd.DataFrame | None = None,
    sizes: pd.DataFrame | None = None,
    reference: str | None = None,
) -> list[Table]:
    """The summary, the studies, how the planners compare, and the paper's comparisons.

    Those that these runs can't answer are left out.

    Parameters
    ----------
    runs : DataFrame
        As :func:`suite.store.read.read_runs` gives it. A further column ``stratum``, as
        :func:`suite.store.scenes.ends_of_rows` gives it, brings a table of strata.
    first : DataFrame, optional
        As :func:`suite.store.read.read_first_measures` gives it.
    events : DataFrame, optional
        As :func:`suite.store.read.read_events` gives it. Without it there are no fixed targets and
        budgets, ranking and statistics.
    simulations, replans : DataFrame, optional
        As :func:`suite.store.read.read_simulations` and :func:`suite.store.read.read_replans` give
        them. Without them there are no tables of simulated runs.
    sizes : DataFrame, optional
        As :func:`suite.store.scenes.sizes_of_scenes` gives it. Without it there is no table of
        scenes.
    reference : str, optional
        The planner that the statistics compare the others with; default: kbga, or else the first.

    Returns
    -------
    list of Table

    Raises
    ------
    KbgaBenchError
        If no run is of the reference, or a path is shorter than the shortest.
    """
    check_reference(runs["variant"], reference)
    current = newest(runs)
    check_optima(current)
    left_out = len(runs) - len(current)
    asked = current[~is_blocked(current)]
    kept = fair(asked)
    untold = joined(dropped_note(asked), blocked_note(current))
    driven = kept[is_simulated(kept)]
    kept = kept[~is_simulated(kept)]
    aligned, kept = alignment_tables(kept), without_repeats(kept)
    moving = []
    if simulations is not None and replans is not None:
        moving = simulated_tables(driven, simulations, replans)
    answers = verdict_table(Rows(kept, driven, _or_empty(first), _or_empty(replans)))
    told = [table for table in (answers, contrast_table(kept)) if table is not None]
    prepared = None if sizes is None else scenes_table(current, sizes)
    scenes = [] if prepared is None else [prepared]
    if kept.empty and moving:
        return _paper_last([*moving, *scenes, *told], untold)
    steps = None if events is None else steps_of(kept, events)
    measured = [] if steps is None else measured_tables(steps, reference)
    rng = np.random.default_rng(BOOTSTRAP_SEED)
    maps = [] if steps is None else map_tables(steps, current, rng, reference)
    return _paper_last(
        [
            *summary_tables(kept, left_out),
            *maps,
            *scenes,
            *aligned,
            *moving,
            *study_tables(kept, first),
            *ablation_tables(kept, COST_NOTE),
            *difference_tables(kept),
            *measured,
            *told,
            *paper_tables(kept),
        ],
        untold,
    )


def read_tables(
    store: Path,
    reference: str | None = None,
    *,
    runs: pd.DataFrame | None = None,
    events: pd.DataFrame | None = None,
) -> list[Table]:
    """All tables of a store.

    Parameters
    ----------
    store : Path
    reference : str, optional
        As for :func:`all_tables`.
    runs, events : DataFrame, optional
        Of this store, where they were read already.

    Raises
    ------
    StoreError
        If it can't be read.
    KbgaBenchError
        If no run is of the reference.
    """
    rows = read_runs(store) if runs is None else runs
    return all_tables(
        rows.assign(**{STRATUM: ends_of_rows(store, rows)["stratum"]}),
        read_first_measures(store),
        read_events(store) if events is None else events,
        simulations=read_simulations(store),
        replans=read_replans(store),
        sizes=sizes_of_scenes(store, newest(rows)),
        reference=reference,
    )


def _paper_last(tables: list[Table], left_out: str) -> list[Table]:
    """The tables in their order, each saying which rows none of them counts."""
    ordered = sorted(tables, key=lambda table: table.name.startswith("paper-"))
    return [replace(table, note=joined(table.note, left_out)) for table in ordered]


def _or_empty(frame: pd.DataFrame | None) -> pd.DataFrame:
    return pd.DataFrame() if frame is None else frame


def measured_tables(steps: Steps, reference: str | None = None) -> list[Table]:
    """The ranking, fixed targets and budgets, and the statistics of runs as step functions."""
    apart = only_maps(steps, maps=False)
    told = WITHOUT_MAPS if len(apart.runs) < len(steps.runs) else ""
    surely = statistics_tables(apart, np.random.default_rng(BOOTSTRAP_SEED), reference)
    return [
        *ranking_tables(steps, reference),
        *target_tables(steps),
        *budget_tables(steps),
        *(replace(table, note=joined(table.note, told)) for table in surely),
    ]
