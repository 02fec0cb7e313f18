"""Where runs are waited for: threads of this process, a dask cluster, or any other executor.

``concurrent.futures.Executor`` is the only idea of "where". How to run on a cluster is told in
``README.md`` beside this file.
"""

import time
import uuid
from collections.abc import Callable, Collection, Iterator, Mapping
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, ParamSpec, TypeVar

from suite.errors import HarnessError
from suite.harness.cluster.luggage import Luggage, pack
from suite.harness.cluster.worker import (
    DISTRIBUTION,
    Answer,
    Session,
    describe,
    end_session,
    run_for,
)
from suite.harness.fleet import kill_running, start_server
from suite.harness.fork_server import Warmth
from suite.harness.isolate import run_isolated
from suite.harness.matrix import Limits
from suite.harness.patience import Patience
from suite.harness.provenance import package_version
from suite.planner import PlanStatus
from suite.plugins.from_file import named_plugins
from suite.processes.cores import honest_jobs
from suite.scenes.scene import Scene
from suite.store.record import Cell, RunRecord

CONNECT_S = 10.0
"""How long a scheduler may take to answer, at first and when the connection is broken."""

FIRST_WORKER_S = 10.0
"""How long its first worker may take to be there."""

ANSWER_S = 60.0
"""How long the workers may take to say what they are: one that is stopped never does."""

HEARD_S = 30.0
"""How long they may take to kill runs: a busy machine takes seconds for it."""

END_S = 5.0
"""How long to wait for killed runs to be gone."""

POLL_S = 0.02

ABANDON_S = 5.0
"""Runs of this machine are gone much sooner; those of others may go on until their limits."""

P = ParamSpec("P")
T = TypeVar("T")


Coming = Future[RunRecord | Answer]


def new_session(luggage: Luggage | None = None) -> Session:
    """A session of this suite that is like no other."""
    return Session(uuid.uuid4().hex, package_version(DISTRIBUTION), bool(luggage))


class DaskExecutor(Executor):
    """The workers of a dask scheduler, as an executor. Made by :func:`connect`.

    address : of the scheduler.
    """

    def __init__(self, address: str, client: Any) -> None:
        self.address = address
        self._client = client
        # A run is never pure: two of the same arguments are two runs.
        self._executor = client.get_executor(pure=False)

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Have a worker call a function; another one, if that worker dies."""
        future: Future[T] = self._executor.submit(fn, *args, **kwargs)
        return future

    def slots(self) -> int:
        """Threads of all workers that are there now; at least 1.

        Raises
        ------
        HarnessError
            If the scheduler is gone.
        """
        try:
            return max(1, sum(self._client.nthreads().values()))
        except (OSError, RuntimeError) as error:
            raise _lost(error) from error

    def machines(self, session: Session) -> list[dict[str, Any]]:
        """What the machines of the workers are, each once, as provenance.

        Raises
        ------
        HarnessError
            If a worker can do no runs, or does not answer.
        """
        try:
            answers = self._ask(describe, session, "return", ANSWER_S)
        except TimeoutError as error:
            raise HarnessError(
                f"{self.address}: {self._longest_silent()} does not answer within {ANSWER_S:g} s. "
                "Let it go on if it is stopped, or end it."
            ) from error
        machines = {}
        for worker, answer in answers.items():
            if isinstance(answer, Exception):
                raise HarnessError(
                    f"the worker {worker} can't run {DISTRIBUTION} ({answer!r}). Install it there "
                    "in the same version."
                )
            if answer["unfit"] is not None:
                raise HarnessError(f"{self.address}: {answer['unfit']}")
            machines[answer["host"]] = {k: answer[k] for k in answer if k not in _NOT_OF_A_MACHINE}
        return list(machines.values())

    def end(self, session: Session) -> int:
        """Kill the runs of a session on all workers.

        Returns
        -------
        int
            How many go on in spite of it, because their workers serve others too: they end by
            themselves or at their limits.

        Raises
        ------
        OSError, RuntimeError
            If the scheduler is gone, or a worker does not answer: nobody knows what goes on.
        """
        deadline = time.monotonic() + END_S
        while True:
            answers = self._ask(end_session, session, "ignore", HEARD_S)
            left = sum(answers.values())
            if not left or time.monotonic() > deadline:
                return left
            time.sleep(POLL_S)

    def _ask(
        self, question: Callable[[Session], T], session: Session, on_error: str, limit_s: float
    ) -> dict[str, Any]:
        """What each worker answers, by its address; a TimeoutError if one does not."""
        # `run` hands on what it does not know, to `Client.sync`.
        answers: dict[str, Any] = self._client.run(
            question, session, on_error=on_error, callback_timeout=limit_s
        )
        return answers

    def _longest_silent(self) -> str:
        """The worker that was last heard of before all others."""
        workers = self._client.scheduler_info(n_workers=-1)["workers"]
        return f"the worker {min(workers, key=lambda worker: workers[worker]['last_seen'])}"

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Leave the cluster, which goes on."""
        self._executor.shutdown(wait=wait and not cancel_futures)
        self._client.close()


_NOT_OF_A_MACHINE = ("matrix", "started_at", "planner_distributions", "unfit")


def connect(address: str) -> DaskExecutor:
    """Connect to a dask scheduler whose workers can do runs.

    Parameters
    ----------
    address : str
        As the scheduler prints it: ``tcp://host:port``.

    Raises
    ------
    HarnessError
        If dask is not installed, no scheduler answers there, or it has no workers that can run.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise HarnessError(
            f"dask.distributed is not installed. Install it: `pip install {DISTRIBUTION}[dask]`."
        ) from error
    try:
        client = Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise HarnessError(
            f"no dask scheduler answers at {address} ({_one_line(error)}). Start one with "
            "`dask scheduler`, and give the address that it prints."
        ) from error
    try:
        client.wait_for_workers(1, timeout=FIRST_WORKER_S)
    except TimeoutError as error:
        client.close()
        raise HarnessError(
            f"the dask scheduler at {address} has no workers. Start some with `dask worker "
            f"{address} --no-nanny` on machines that have {DISTRIBUTION}."
        ) from error
    executor = DaskExecutor(address, client)
    try:
        executor.machines(new_session())
    except HarnessError:
        executor.shutdown()
        raise
    return executor


@dataclass(frozen=True, slots=True)
class Crew:
    """Who runs the cells, and within what limits.

    executor : where each is waited for.
    jobs : how many at a time; None to ask the cluster again and again, for it may grow.
    session : of runs whose workers are not this process; None for threads of this process.
    patience : with this machine, if it is busy. Workers elsewhere have none.
    limits : of each run.
    warmth : what fork servers have ready for them.
    luggage : files that they need, for workers that ask for them.
    """

    executor: Executor
    jobs: int | None
    session: Session | None
    patience: Patience
    limits: Limits
    warmth: Warmth
    luggage: Luggage

    def size(self) -> int:
        """Runs at a time."""
        if self.jobs is None and isinstance(self.executor, DaskExecutor):
            return self.executor.slots()
        return self.jobs or honest_jobs()

    def start(self, cell: Cell, *, with_luggage: bool = False) -> Coming:
        """Have a cell run; with luggage, if a worker answered that it has none yet."""
        what = (cell, self.limits, self.warmth)
        if self.session is None:
            return self.executor.submit(_run_patiently, self.patience, *what)
        luggage = self.luggage if with_luggage else None
        return self.executor.submit(run_for, self.session, *what, luggage)

    def provenance(self) -> dict[str, Any]:
        """Where runs go that do not stay on this machine."""
        if self.session is None or not isinstance(self.executor, DaskExecutor):
            return {}
        return {
            "scheduler": self.executor.address,
            "workers": self.executor.machines(self.session),
        }

    def abandon(self, futures: Collection[Coming]) -> int:
        """Kill runs in flight, and say how many could not be: they end at their limits.

        Their records are dropped: the next session runs them again.
        """
        started = [future for future in futures if not future.cancel()]
        self.patience.give_up()
        if self.session is not None and isinstance(self.executor, DaskExecutor):
            try:
                return self.executor.end(self.session)
            except (OSError, RuntimeError):
                # A scheduler that is gone; its workers leave too, and their runs with them. Or a
                # worker that stands still; the others have heard it.
                return len(futures)
        deadline = time.monotonic() + ABANDON_S
        while started and (self.session is None or time.monotonic() < deadline):
            # Again and again: a thread may have been about to start its process.
            kill_running()
            started = list(wait(started, timeout=POLL_S).not_done)
        return len(started)


@contextmanager
def crew(
    given: Executor | None,
    jobs: int | None,
    patience: Patience,
    limits: Limits,
    warmth: Warmth,
    scenes: Mapping[str, Scene],
) -> Iterator[Crew]:
    """Those who run a matrix: a given executor, or threads of this process while they are needed.

    Parameters
    ----------
    given : Executor, optional
    jobs : int, optional
        Runs at a time; default: what leaves their timing honest.
    patience : Patience
        With this machine.
    limits, warmth : of each run. The fork server of this process begins to warm itself.
    scenes : by their sources, those that workers elsewhere may have to be sent.

    Raises
    ------
    HarnessError
        If a planner's file that workers will need can't be read any more.
    """
    if given is not None:
        wanted = {source: scenes[source] for source, _ in warmth.queries}
        luggage = pack(wanted, named_plugins())
        yield Crew(given, jobs, new_session(luggage), patience, limits, warmth, luggage)
        return
    start_server(warmth)
    jobs = jobs or honest_jobs()
    with ThreadPoolExecutor(jobs, thread_name_prefix="run") as own:
        yield Crew(own, jobs, None, patience, limits, warmth, Luggage())


def _run_patiently(
    patience: Patience, cell: Cell, limits: Limits, warmth: Warmth
) -> RunRecord | Answer:
    with patience.free_core(wanted=patience.for_all or cell.load_counts):
        return run_isolated(cell, limits, warmth)


def record_of(future: Coming, cell: Cell) -> RunRecord | Answer:
    """The record of a run that came back, whatever became of the place where it was.

    An Answer, if its worker wants to be given more.

    Raises
    ------
    HarnessError
        If the executor is gone.
    """
    try:
        return future.result()
    except (CancelledError, BrokenExecutor) as error:
        raise _lost(error) from error
    except Exception as error:
        # Of distributed, which is imported only where it is used.
        if type(error).__name__ != "KilledWorker":
            raise
        reason = f"several workers died while they ran it: {_one_line(error)}"
        return RunRecord(cell, PlanStatus.CRASHED, reason)


def _lost(error: BaseException) -> HarnessError:
    return HarnessError(
        f"the executor was lost ({_one_line(error)}). All finished runs "
        "are kept; to go on, start it again and give the same command again."
    )


def _one_line(error: BaseException) -> str:
    return " ".join(str(error).split()) or type(error).__name__
