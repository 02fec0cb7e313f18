"""Workers with no shared disk: what a user's command names by file must come to them.

Where the system lets us (Linux, with the right to mount), each worker sees a disk without the
user's folder; elsewhere the folder is moved away as soon as the first run is handed out.
"""

import os

import numpy as np
import pytest

from suite.harness.cluster.executors import connect
from suite.harness.matrix import load_matrix
from suite.harness.run import run_matrix
from suite.plugins.from_file import name_plugins
from suite.store.read import read_paths, read_runs
from suite.store.write import open_store
from tests.suite.harness.cluster.dask_on_loopback import (
    Cluster,
    Machine,
    can_hide,
    listening,
    wait_until,
)
from tests.suite.harness.cluster.user_folder import write_user_folder

SEEDS = 4


@pytest.fixture
def user(tmp_path, monkeypatch):
    folder = write_user_folder(tmp_path / "user", SEEDS)
    monkeypatch.setenv("HOME", str(folder))
    yield folder
    name_plugins([])


@pytest.fixture
def cluster(user, tmp_path):
    found = Cluster(tmp_path, dict(os.environ))
    yield found
    found.close()


def run(user, store, on_progress=lambda _: None, **options):
    name_plugins([str(user / "lucky.py")])
    matrix = load_matrix(user / "matrix.toml")
    with open_store(store) as opened:
        run_matrix(matrix, opened, on_progress=on_progress, **options)
    return read_runs(store), read_paths(store)


@pytest.mark.slow
def test_files_travel_to_machines_without_a_shared_disk(user, cluster, tmp_path):
    # First, so that our own kernels are compiled, which takes minutes.
    local, local_paths = run(user, tmp_path / "local.db", jobs=1)
    machines = [Machine(tmp_path / name, user) for name in ("a", "b")]
    workers = [cluster.add_worker(machine=machine) for machine in machines]
    away = tmp_path / "away"

    def move_away(progress):
        if progress.running and not can_hide() and user.exists():
            user.rename(away)

    cluster.wait_for(2)
    with connect(cluster.address) as there:
        runs, paths = run(user, tmp_path / "s.db", move_away, executor=there)
        if away.exists():
            away.rename(user)
        compiled_once = [machine.new_code() for machine in machines]
        # Another worker of the first machine, and another matrix: the machine code is there.
        workers[0].kill()
        wait_until(lambda: there.slots() == 1)
        cluster.add_worker(machine=machines[0])
        cluster.wait_for(2)
        again, _ = run(user, tmp_path / "again.db", executor=there)
        ears = listening(process.pid for process in cluster.processes if process.poll() is None)
    assert runs["status"].tolist() == ["solved"] * 2 * SEEDS, runs["reason"].tolist()
    assert again["status"].tolist() == ["solved"] * 2 * SEEDS
    assert runs["key"].tolist() == local["key"].tolist()
    for key, path in paths.items():
        np.testing.assert_array_equal(path, local_paths[key])
    for machine, found in zip(machines, compiled_once, strict=True):
        (place,) = set((machine.folder / "ran-from").read_text().split())
        assert place.startswith(str(machine.folder))
        assert [file.name.partition("-")[0] for file in found] == ["lucky.bend"]
        assert machine.new_code() == found
    assert {ip for ip, _ in ears} == {"127.0.0.1"}
