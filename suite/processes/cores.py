"""The processor cores that runs may have to themselves, so that their times can be compared."""

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

import psutil

TOPOLOGY = "/sys/devices/system/cpu/cpu{}/topology/thread_siblings_list"
QUOTA = Path("/sys/fs/cgroup/cpu.max")


def honest_jobs() -> int:
    """How many runs may go on at a time without disturbing each other's timing.

    One for each physical core that this process may use: two hyperthreads of a core share its
    units, and make each other slower by an amount that depends on the neighbour. A container's
    quota of processor time counts too, because a run beyond it is held up. At least 1.
    """
    return max(1, min(len(honest_cores()), _quota()))


@cache
def honest_cores() -> tuple[int, ...]:
    """One logical processor of each physical core that this process may use."""
    if not hasattr(os, "sched_getaffinity"):
        return tuple(range(psutil.cpu_count(logical=False) or 1))
    first: dict[str, int] = {}
    for processor in sorted(os.sched_getaffinity(0)):
        first.setdefault(_siblings(processor), processor)
    return tuple(first.values())


@contextmanager
def own_core() -> Iterator[int | None]:
    """A core that no other run on this machine is pinned to; None if all are taken.

    The claim is a socket's name: it holds between harnesses that know nothing of each other (two
    matrices, the workers of a cluster on one machine), and a killed harness can't keep it.

    Yields
    ------
    int or None
        None also where the system can't pin. The run then goes where the kernel puts it.
    """
    for core in honest_cores() if hasattr(os, "sched_setaffinity") else ():
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as claim:
            try:
                claim.bind(f"\0kbga-bench core {core}")
            except OSError:
                continue
            yield core
            return
    yield None


def _siblings(processor: int) -> str:
    """The hyperthreads of the core that a processor belongs to; itself, if the kernel is silent."""
    try:
        return Path(TOPOLOGY.format(processor)).read_text(encoding="ascii").strip()
    except OSError:
        return str(processor)


def _quota() -> int:
    """Whole processors that a container may use; very many without a quota."""
    try:
        share, period = QUOTA.read_text(encoding="ascii").split()
        return int(share) // int(period)
    # No such file outside of containers, and the word "max" for no quota.
    except (OSError, ValueError):
        return 1 << 20
