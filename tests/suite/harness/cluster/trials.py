"""Clusters tried for real, on loopback: `make cluster-test`.

python -m tests.suite.harness.cluster.trials [slurm] [mpi] [apart]

Each trial gives the command `kbga-bench run` a matrix of a user's own scene and planner file, and
compares the rows with those of this machine, bit for bit. A trial passed, failed, or is not
available here, with what is missing. The exit code is 1 if one failed, else 0.
"""

import argparse
import importlib.metadata
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
import traceback
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import psutil

from suite.errors import StoreError
from suite.harness.cluster.executors import connect
from suite.store.read import read_paths, read_runs
from tests.suite.commands import COMMAND
from tests.suite.harness.cluster.dask_on_loopback import (
    LOOPBACK,
    Cluster,
    Machine,
    can_hide,
    end,
    listening,
    wait_until,
)
from tests.suite.harness.cluster.user_folder import write_user_folder

SEEDS = 20
ROWS = 2 * SEEDS
LIMIT_S = 900.0
"""Of a command, with all kernels compiled on the way on a slow machine."""

GONE = ("CD", "CA", "F", "TO", "NF")
"""States of jobs that are over."""

SLURM = Path(__file__).parent / "slurm_on_loopback.sh"
PACKAGES = {
    "slurmctld": "slurm-wlm", "slurmd": "slurm-wlm", "sbatch": "slurm-wlm", "munged": "munge",
    "mpiexec": "openmpi-bin libopenmpi-dev", "ip": "iproute2", "unshare": "util-linux",
}  # fmt: skip
OPENMPI = (
    *("--allow-run-as-root", "--oversubscribe", "--bind-to", "none"),
    *("--mca", "oob_tcp_if_include", "lo", "--mca", "btl", "self,vader"),
)
"""All ranks on this machine, speaking by shared memory and loopback."""


class MissingError(Exception):
    """A trial that can't be made on this machine; the message says what is missing."""


def need(programs, distributions):
    """Refuse a trial whose programs or Python packages are not here."""
    path = os.environ.get("PATH", "") + ":/usr/sbin"
    missing = [program for program in programs if shutil.which(program, path=path) is None]
    if missing:
        packages = " ".join(sorted({PACKAGES[program] for program in missing}))
        raise MissingError(f"no {', '.join(missing)}. Debian: `apt-get install {packages}`.")
    for name in distributions:
        try:
            importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            raise MissingError(f"no {name}. `pip install --group cluster -e '.[dask]'`.") from None


def version(*command):
    """First line of what a program says of its version."""
    said = subprocess.run(command, capture_output=True, text=True)
    return (said.stdout or said.stderr).splitlines()[0].strip()


class Place:
    """The folders of a trial."""

    def __init__(self, top):
        self.top = top
        self.user = write_user_folder(top / "user", SEEDS)

    def run(self, name, address=None, expect=0):
        """The command, on a cluster or here; seconds, and the rows with their paths."""
        store = self.top / f"{name}.db"
        where = ("--executor", "dask", "--address", address) if address else ("--jobs", "2")
        begin = time.monotonic()
        done = subprocess.run(
            [*COMMAND, "run", "matrix.toml", "--store", str(store), "--plugin", "lucky.py",
             "--patience", "0", *where],
            cwd=self.user, capture_output=True, text=True, timeout=LIMIT_S,
        )  # fmt: skip
        assert done.returncode == expect, done.stderr
        return time.monotonic() - begin, read_runs(store), read_paths(store)


def same(rows, local):
    """Refuse rows that are not those of this machine, bit for bit."""
    _, runs, paths = rows
    _, wanted, wanted_paths = local
    assert runs["status"].tolist() == ["solved"] * ROWS, runs["reason"].dropna().unique()
    assert runs["key"].tolist() == wanted["key"].tolist()
    for key, path in wanted_paths.items():
        np.testing.assert_array_equal(paths[key], path)


def told(name, rows):
    """One line of figures; the first matrix pays for the warm-up of workers."""
    seconds, runs, _ = rows
    return f"{name}: {len(runs)} rows in {seconds:.1f} s"


def away(ears):
    """Those ports that are open to other machines."""
    return {ear for ear in ears if not ear[0].startswith("127.")}


def of(distribution):
    """The name and version of a Python package."""
    return f"{distribution} {importlib.metadata.version(distribution)}"


# SLURM


@contextmanager
def slurm(folder):
    """The SLURM of the script, while it is needed."""
    ports = [str(free_port()) for _ in range(2)]
    with (folder / "slurm.out").open("w") as out:
        script = subprocess.Popen(
            ["sh", str(SLURM), str(folder / "slurm"), *ports],
            stdin=subprocess.PIPE, stdout=out, stderr=out, start_new_session=True,
        )  # fmt: skip
    ready = folder / "slurm" / "ready"
    try:
        wait_until(lambda: ready.exists() or script.poll() is not None, patience_s=120)
        assert script.poll() is None, (folder / "slurm.out").read_text()
        os.environ["SLURM_CONF"] = str(folder / "slurm" / "slurm.conf")
        yield script
    finally:
        # slurmd kills a job that does not end by itself, if it has the time.
        with suppress(AssertionError, OSError):
            wait_until(lambda: not jobs_of_slurm("all"), patience_s=30)
        os.environ.pop("SLURM_CONF", None)
        script.stdin.close()  # which it waits for
        try:
            script.wait(timeout=30)
        except subprocess.TimeoutExpired:
            end(script)


def free_port():
    with closing(socket.socket()) as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


def jobs_of_slurm(states="RUNNING"):
    said = subprocess.run(
        ["squeue", "--noheader", f"--states={states}", "--format=%i %t"],
        capture_output=True, text=True,
    )  # fmt: skip
    jobs = [line.split() for line in said.stdout.splitlines()]
    return [number for number, state in jobs if state not in GONE]


def end_what_is_left(top):
    """End processes that were started with this folder and outlived their masters, by their ids.

    A dask worker that is told to end twice at a time may hang (distributed 2026.8).
    """
    for process in psutil.process_iter(["cmdline"]):
        if f"--local-directory {top}" in " ".join(process.info["cmdline"] or ()):
            with suppress(psutil.NoSuchProcess):
                process.kill()


def try_slurm(top):
    """Two jobs of dask-jobqueue's SLURMCluster; then one is cancelled in the middle of a matrix."""
    need(("munged", "slurmctld", "slurmd", "sbatch"), ("dask-jobqueue",))
    if os.getuid() != 0:
        raise MissingError("slurmd must be started by root.")
    from dask_jobqueue import SLURMCluster

    place = Place(top)
    local = place.run("local")
    with slurm(top) as script, SLURMCluster(
        queue="batch", cores=2, processes=1, memory="2GB", walltime="00:30:00", nanny=False,
        scheduler_options={
            "host": "127.0.0.1", "dashboard": False, "dashboard_address": "127.0.0.1:0",
        },
        worker_extra_args=list(LOOPBACK), local_directory=str(top), log_directory=str(top / "log"),
    ) as cluster:  # fmt: skip
        cluster.scale(jobs=2)
        cluster.wait_for_workers(2, timeout=120)
        ears = listening([script.pid, os.getpid()])
        first = place.run("slurm", cluster.scheduler_address)
        same(first, local)
        jobs = jobs_of_slurm()
        assert len(jobs) == 2, jobs
        with in_the_middle(place, "cancelled", lambda: subprocess.run(["scancel", jobs[0]])):
            second = place.run("cancelled", cluster.scheduler_address)
        same(second, local)
        assert jobs[0] not in jobs_of_slurm()
    assert not away(ears), ears
    yield f"{version('slurmctld', '-V')}, {of('dask-jobqueue')}, {of('distributed')}"
    yield told("two jobs of two threads", first)
    yield told("again, a job cancelled in the middle", second)
    yield f"{len(ears)} ports, all of 127.0.0.1"


@contextmanager
def in_the_middle(place, name, action):
    """Do something when the matrix that is run meanwhile has three rows; fail if it never had."""
    done = []

    def wait_and_act():
        wait_until(lambda: number_of_rows(place.top / f"{name}.db") >= 3)
        action()
        done.append(number_of_rows(place.top / f"{name}.db"))

    thread = threading.Thread(target=wait_and_act)
    thread.start()
    yield
    thread.join()
    assert done
    assert done[0] < ROWS, "it came too late"


def number_of_rows(store):
    try:
        return len(read_runs(store))
    except StoreError:
        return 0  # not yet made


# MPI


def try_mpi(top):
    """dask-mpi: a scheduler and three workers, one rank each; then mpi4py.futures with two."""
    need(("mpiexec", "unshare", "ip"), ("dask-mpi", "mpi4py"))
    if set(psutil.net_if_addrs()) - {"lo"}:
        yield from in_a_network_of_its_own("mpi")
        return
    place = Place(top)
    local = place.run("local")
    with mpi(top, 4, "-m", "dask_mpi.cli", *dask_mpi_options(top)):
        file = top / "mpi.json"
        wait_until(lambda: file.exists() and file.stat().st_size > 0)
        with connect(json.loads(file.read_text())["address"]) as there:
            wait_until(lambda: there.slots() == 3)
            address = there.address
        first = place.run("dask-mpi", address)
    same(first, local)
    begin = time.monotonic()
    with mpi(top, 3, "-m", "mpi4py.futures", str(program_for(place))) as ranks:
        assert ranks.wait(timeout=LIMIT_S) == 0, (top / "mpi.out").read_text()
    store = top / "futures.db"
    second = (time.monotonic() - begin, read_runs(store), read_paths(store))
    same(second, local)
    yield f"{version('mpiexec', '--version')}, {of('dask-mpi')}, {of('mpi4py')}"
    yield told("dask-mpi, three workers of a thread", first)
    yield told("mpi4py.futures, two workers, their start included", second)
    yield "in a network of its own, which has loopback only"


def in_a_network_of_its_own(name):
    """The lines of a trial where there is no interface but loopback.

    Open MPI's mpiexec listens on all interfaces, whatever `oob_tcp_if_include` says.
    """
    alone = ("unshare", "--net", *(() if os.getuid() == 0 else ("--map-root-user",)))
    up = ("sh", "-c", 'ip link set lo up && exec "$@"', "sh")
    if subprocess.run([*alone, *up, "true"], capture_output=True).returncode != 0:
        raise MissingError(
            "mpiexec listens on all interfaces, and a network of its own (`unshare --net`) is "
            "forbidden here."
        )
    trial = (sys.executable, "-m", __spec__.name, name)
    with subprocess.Popen([*alone, *up, *trial], stdout=subprocess.PIPE, text=True) as there:
        try:
            said, _ = there.communicate(timeout=3 * LIMIT_S)
        finally:
            end(there)
    assert there.returncode == 0, said
    yield from (line.strip() for line in said.splitlines() if line.startswith("  "))


def dask_mpi_options(top):
    return (
        "--scheduler-file", str(top / "mpi.json"), "--scheduler-port", "0", "--interface", "lo",
        "--no-dashboard",
        "--dashboard-address", "127.0.0.1:0", "--worker-class", "distributed.Worker",
        "--nthreads", "1", "--local-directory", str(top),
    )  # fmt: skip


def program_for(place):
    """What the README has for mpi4py.futures, with the matrix and the planner of this user."""
    program = place.top / "run_mine.py"
    program.write_text(f"""
from pathlib import Path
from mpi4py.futures import MPIPoolExecutor
from suite.harness.matrix import load_matrix
from suite.harness.run import run_matrix
from suite.plugins.from_file import name_plugins
from suite.store.write import open_store

if __name__ == "__main__":
    name_plugins([{str(place.user / "lucky.py")!r}])
    store = Path({str(place.top / "futures.db")!r})
    with open_store(store) as opened, MPIPoolExecutor() as pool:
        run_matrix(load_matrix({str(place.user / "matrix.toml")!r}), opened, executor=pool, jobs=2)
""")
    return program


@contextmanager
def mpi(top, ranks, *program):
    """A Python program on some ranks, while it is needed."""
    command = ["mpiexec", *OPENMPI, "-n", str(ranks), sys.executable, *program]
    with (top / "mpi.out").open("w") as out:
        started = subprocess.Popen(command, stdout=out, stderr=out, stdin=subprocess.DEVNULL)
    try:
        yield started
    finally:
        end(started)


# Machines without a shared disk


def try_apart(top):
    """Two workers, each with a folder of its own for everything, and no kernels at first."""
    place = Place(top)
    cluster = Cluster(top, dict(os.environ))
    try:
        machines = [Machine(top / name, place.user, cold=True) for name in ("a", "b")]
        for machine in machines:
            cluster.add_worker(machine=machine)
        cluster.wait_for(2)
        ears = listening(process.pid for process in cluster.processes)
        first = place.run("apart", cluster.address)
        compiled = [machine.new_code() for machine in machines]
        second = place.run("again", cluster.address)
        assert [machine.new_code() for machine in machines] == compiled
        ran_from = [set((m.folder / "ran-from").read_text().split()) for m in machines]
    finally:
        cluster.close()
    local = place.run("local")
    same(first, local)
    same(second, local)
    for machine, places in zip(machines, ran_from, strict=True):
        assert all(Path(one).is_relative_to(machine.folder) for one in places), places
    assert not away(ears), ears
    hidden = (
        "out of the workers' sight" if can_hide() else "in the workers' sight: no right to hide"
    )
    yield f"{of('distributed')}; the user's folder {hidden}"
    yield told("two workers, kernels compiled on each", first)
    yield told("again", second)
    yield f"functions compiled, once: {' and '.join(str(len(new)) for new in compiled)}"
    yield f"{len(ears)} ports, all of 127.0.0.1"


TRIALS = {"slurm": try_slurm, "mpi": try_mpi, "apart": try_apart}


def say(line):
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def outcome(name):
    """One trial: "passed", "failed" or "not available here", after its lines are printed."""
    trial = TRIALS[name]
    say(f"{name}: {trial.__doc__}")
    with TemporaryDirectory(prefix=f"kbga-bench-{name}-", ignore_cleanup_errors=True) as top:
        try:
            for line in trial(Path(top)):
                say(f"  {line}")
        except MissingError as missing:
            say(f"  {missing}")
            return "not available here"
        except Exception:
            say(traceback.format_exc())
            return "failed"
        finally:
            end_what_is_left(top)
    return "passed"


def main(arguments=None):
    """Make the trials that are asked for; all, if none is."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("trials", nargs="*", choices=[*TRIALS, []], metavar="|".join(TRIALS))
    # Told to end, it ends what it started.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    found = {name: outcome(name) for name in parser.parse_args(arguments).trials or TRIALS}
    for name, word in found.items():
        say(f"{name}: {word}")
    return int("failed" in found.values())


if __name__ == "__main__":
    sys.exit(main())
