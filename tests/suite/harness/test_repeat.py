import pytest

from suite.harness.matrix import load_matrix
from suite.harness.repeat import ATTEMPTS, repeat_contended
from suite.harness.run import run_matrix
from suite.store.read import read_paths, read_runs
from suite.store.status import as_text, status
from suite.store.write import open_store

PATIENCE_S = 600.0
"""More than anybody needs; a test that waits so long fails for what it finds then."""


@pytest.fixture
def matrix(hostile, wall_file, tmp_path):
    """Two runs of a planner that sleeps in its first run, or in all, with a budget of wall time."""

    def make(planner="drowsy"):
        file = tmp_path / "matrix.toml"
        settings = f'settings = {{folder = "{tmp_path}"}}\n' if planner == "drowsy" else ""
        file.write_text(
            f'scenes = ["{wall_file}"]\nseeds = 2\n[[planner]]\nplanner = "{planner}"\n'
            f"{settings}budget = {{wall_s = 5.0}}\n"
        )
        return load_matrix(file)

    return make


@pytest.fixture(autouse=True)
def idle_machine(monkeypatch):
    """Nobody waits for those who keep this machine busy while it is tested."""
    monkeypatch.setattr("suite.harness.patience.OthersLoad", lambda: lambda: 0.0)


@pytest.fixture
def store(tmp_path):
    with open_store(tmp_path / "store.db") as opened:
        yield opened


def rows(store):
    return read_runs(store.path).set_index("key")


def test_a_contended_row_gives_way_to_a_run_that_had_a_core(matrix, store):
    end = run_matrix(matrix(), store, jobs=2)
    before = rows(store)
    assert before["contended"].all()
    assert end.contended == 2
    assert "2 rows had no core to run on: see `run --patience`." in end.summary()
    end = repeat_contended(matrix(), store, end, patience_s=PATIENCE_S)
    after = rows(store)
    assert not after["contended"].any()
    assert (after["attempts"] >= 2).all()
    assert (after["wall_s"] != before["wall_s"]).all()
    assert "2 rows had no core and ran again; none still are contended." in end.summary()
    assert (end.done, end.wanted, end.repeated) == (2, 2, 2)


def test_rows_of_earlier_sessions_are_run_again_too(matrix, store):
    run_matrix(matrix(), store, jobs=2)
    paths = read_paths(store.path)
    end = run_matrix(matrix(), store, jobs=2)
    assert (end.found, end.contended) == (2, 2)
    repeat_contended(matrix(), store, end, patience_s=PATIENCE_S)
    assert not rows(store)["contended"].any()
    assert {k: p.tobytes() for k, p in read_paths(store.path).items()} == {
        k: p.tobytes() for k, p in paths.items()
    }


def test_who_sleeps_each_time_is_tried_a_few_times_and_keeps_its_row(matrix, store):
    end = run_matrix(matrix("sleeper"), store, jobs=2)
    before = rows(store)
    end = repeat_contended(matrix("sleeper"), store, end, patience_s=PATIENCE_S)
    after = rows(store)
    assert after["contended"].all()
    assert after["attempts"].tolist() == [1 + ATTEMPTS] * 2
    assert after["wall_s"].equals(before["wall_s"])
    assert after["started_at"].equals(before["started_at"])
    assert (end.repeats_wanted, end.repeats_done) == (2 * ATTEMPTS, 2 * ATTEMPTS)
    assert "2 rows had no core and ran again; 2 still are contended." in end.summary()


def test_without_patience_nothing_is_run_again(matrix, store):
    end = run_matrix(matrix(), store, jobs=2)
    assert repeat_contended(matrix(), store, end, patience_s=0.0).repeats_done == 0
    assert rows(store)["attempts"].tolist() == [1, 1]


def test_when_patience_is_over_no_further_run_is_begun(matrix, store):
    end = run_matrix(matrix("sleeper"), store, jobs=1)
    end = repeat_contended(matrix("sleeper"), store, end, patience_s=0.01, jobs=1)
    # Two are handed out at a time: one more than can run.
    assert end.repeats_done <= 2


def test_an_interruption_leaves_the_rows_as_they_were(matrix, store):
    def interrupt(progress):
        if progress.repeats_wanted and progress.running:
            raise KeyboardInterrupt

    end = run_matrix(matrix("sleeper"), store, jobs=1)
    before = rows(store)
    with pytest.raises(KeyboardInterrupt):
        repeat_contended(
            matrix("sleeper"), store, end, patience_s=PATIENCE_S, on_progress=interrupt
        )
    after = rows(store)
    assert after["wall_s"].equals(before["wall_s"])
    assert len(read_paths(store.path)) == 2


def test_a_run_that_wall_time_ends_waits_for_a_core_and_says_so(matrix, store, monkeypatch):
    monkeypatch.setattr("suite.harness.patience.OthersLoad", lambda: lambda: 64.0)
    end = run_matrix(matrix(), store, jobs=1, patience_s=1.5)
    assert end.waited_s >= 1.5
    assert "s went to waiting for a core." in end.summary()
    assert end.done == 2


def test_the_status_of_a_store_counts_contended_rows(matrix, store):
    run_matrix(matrix(), store, jobs=2)
    found = status(store.path)
    assert found["contended"] == 2
    assert "2 rows had no core for themselves" in as_text(found)
