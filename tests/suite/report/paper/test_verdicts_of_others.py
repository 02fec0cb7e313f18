"""Other planners' runs, given out as KBGA's: the verdicts notice."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from suite.harness.cell import attempt_cell
from suite.harness.single import cell_for
from suite.paper.reported import KBGA, reported
from suite.planner import Budget
from suite.report.paper.verdicts import Rows, verdict
from suite.report.statistics.agreement import AGREES, DIFFERS, NOT_COMPARABLE
from suite.store.read import read_first_measures, read_runs
from suite.store.record import RunRecord
from suite.store.write import open_store

SCENES = ("unstructured", "maze", "zigzag", "double_u", "clustered")


@pytest.fixture(scope="module")
def words(tmp_path_factory):
    """Verdicts on a planner's real runs under KBGA's name, by quantity and statistic."""

    def given(planner, runs, budget) -> pd.DataFrame:
        records = [r for scene in SCENES for r in runs_on(scene, planner, runs, budget)]
        file = tmp_path_factory.mktemp("others") / "s.db"
        with open_store(file) as store:
            store.begin_session({})
            for record in records:
                store.add(replace(record, cell=replace(record.cell, variant=KBGA)))
        found = read_runs(file)
        rows = Rows(found, found.iloc[:0], read_first_measures(file), pd.DataFrame())
        figures = [f for f in reported() if f.planner == KBGA and f.scene in SCENES]
        table = pd.DataFrame(
            [(f.scene, f.quantity, f.statistic, verdict(f, rows).word) for f in figures],
            columns=["scene", "quantity", "statistic", "word"],
        )
        return table[table["statistic"].isin(["mean", "sd", "single"])]

    return given


def runs_on(scene, planner, runs, budget) -> Sequence[RunRecord]:
    def attempt(seed):
        return attempt_cell(cell_for(scene, planner, seed=seed, budget=budget))

    if planner != "visibility-graph":
        return [attempt(seed) for seed in range(runs)]
    # It is the same each time.
    one = attempt(0)
    return [replace(one, cell=replace(one.cell, seed=seed)) for seed in range(runs)]


def told(found: pd.DataFrame, quantity: str, *statistics: str) -> list[str]:
    chosen = found[(found["quantity"] == quantity) & found["statistic"].isin(statistics)]
    return chosen["word"].tolist()


def test_the_exact_solver_is_not_taken_for_kbga(words):
    found = words("visibility-graph", 20, Budget())
    costs = told(found, "cost", "mean", "sd", "single")
    assert len(costs) == 17
    assert set(costs) == {DIFFERS, NOT_COMPARABLE}, "none of them may pass"
    assert costs.count(DIFFERS) > len(costs) / 2
    assert set(told(found, "generations", "mean", "sd", "single")) == {NOT_COMPARABLE}


def test_rrt_star_is_not_taken_for_kbga(words):
    found = words("ompl-rrtstar", 8, Budget(checks=20_000))
    costs = told(found, "cost", "mean", "sd", "single")
    assert costs.count(AGREES) <= len(costs) / 3
    assert DIFFERS in told(found, "cost", "mean")
    generations = told(found, "generations", "mean", "single")
    # Where its few checks left some runs without a path, the others' mean is not compared.
    assert set(generations) <= {DIFFERS, NOT_COMPARABLE}
    assert generations.count(DIFFERS) > len(generations) / 2


def test_the_first_path_of_a_random_tree_is_not_taken_for_kbga(words):
    found = words("ompl-rrt", 8, Budget(checks=200_000))
    means = told(found, "cost", "mean")
    assert set(means) == {DIFFERS}
    assert AGREES not in told(found, "cost", "single")


def test_runs_that_are_all_alike_have_no_spread_that_agrees(words):
    found = words("visibility-graph", 2, Budget())
    assert AGREES not in told(found, "cost", "mean", "sd", "single")
    assert np.isin(told(found, "cost", "sd"), [DIFFERS, NOT_COMPARABLE]).all()
