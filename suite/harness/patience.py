"""Patience with a busy machine: a run that the clock may end waits until a core is free for it.

What others leave of the processors is read from the kernel's own counts, over what has passed since
they were read last: the load average is minutes old.
"""

import os
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import psutil

from suite.processes.cores import honest_jobs

WINDOW_S = 0.2
"""Over less, the kernel's ticks of 10 ms tell too little."""

STALE_S = 2.0
"""A load of longer ago may be over."""

SLACK = 0.25
"""Of a core: what the system itself always does is no load."""


class OthersLoad:
    """How many cores other programs keep busy: all that is busy, less what descends from us."""

    def __init__(self) -> None:
        self._cores = _allowed()
        self._last = self._read()

    def __call__(self) -> float:
        """Cores, over the time since the last call; it waits until that is long enough."""
        since = time.monotonic() - self._last[0]
        if since > STALE_S:
            self._last, since = self._read(), 0.0
        if since < WINDOW_S:
            time.sleep(WINDOW_S - since)
        before, self._last = self._last, self._read()
        (then, all_then, own_then), (now, all_now, own_now) = before, self._last
        return max(0.0, (all_now - all_then) - (own_now - own_then)) / (now - then)

    def _read(self) -> tuple[float, float, float]:
        """The time, and seconds of processor time of all and of our own, since some beginning."""
        return time.monotonic(), _busy_s(self._cores), _own_s()


class Patience:
    """Waits for free cores, so long in all. Safe to use from several threads.

    waited_s : seconds that went to waiting.

    Parameters
    ----------
    seconds : float
        To be spent on waiting in all; 0 for none.
    others : callable, optional
        How many cores others keep busy.
    for_all : bool
        Whether all runs wait, and not only those that wall time may end.
    """

    def __init__(
        self,
        seconds: float,
        others: Callable[[], float] | None = None,
        *,
        for_all: bool = False,
    ) -> None:
        self.waited_s = 0.0
        self.for_all = for_all
        self._seconds = seconds
        self._others = others or (OthersLoad() if seconds > 0.0 else lambda: 0.0)
        self._turn = threading.Lock()
        self._runs: set[object] = set()
        self._over = threading.Event()

    def give_up(self) -> None:
        """Let all who wait go on at once, and wait no more."""
        self._over.set()

    @contextmanager
    def free_core(self, *, wanted: bool) -> Iterator[None]:
        """Within, a run goes on; before, a core is waited for if one is wanted.

        One thread waits at a time: otherwise several would take the same core for theirs. A run
        that ends takes no turn: it is what the others wait for.
        """
        run = object()
        with self._turn:
            if wanted:
                self._wait()
            self._runs.add(run)
        try:
            yield
        finally:
            self._runs.remove(run)

    def _wait(self) -> None:
        while self.waited_s < self._seconds and not self._over.is_set():
            asked = time.monotonic()
            if self._others() <= self._spare() + SLACK:
                return
            self._over.wait(WINDOW_S)
            self.waited_s += time.monotonic() - asked

    def _spare(self) -> int:
        """Cores that others may have; who asks for more jobs than there are cores has none left."""
        return max(0, honest_jobs() - len(self._runs) - 1)


def _allowed() -> tuple[int, ...]:
    if hasattr(os, "sched_getaffinity"):
        return tuple(sorted(os.sched_getaffinity(0)))
    return tuple(range(psutil.cpu_count() or 1))


def _busy_s(cores: tuple[int, ...]) -> float:
    """Processor time of all programs on these cores; what a hypervisor takes is gone too."""
    times = psutil.cpu_times(percpu=True)
    return sum(
        sum(times[core]) - times[core].idle - getattr(times[core], "iowait", 0.0)
        # Of virtual machines that run here: it is counted as the user's already.
        - getattr(times[core], "guest", 0.0) - getattr(times[core], "guest_nice", 0.0)
        for core in cores
        if core < len(times)
    )  # fmt: skip


def _own_s() -> float:
    """Processor time of this process and all that descends from it, the ended ones included."""
    me = psutil.Process()
    total = 0.0
    for process in (me, *me.children(recursive=True)):
        try:
            total += sum(process.cpu_times()[:4])
        except psutil.Error:
            # It has just ended: whoever started it has its time from now on.
            continue
    return total
