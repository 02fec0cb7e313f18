"""What a run's process and its descendants hold in memory, watched without disturbing the timing.

Memory is what is resident, not what is reserved: compilers and planners reserve far more than they
ever touch, so the kernel's own limit on address space would hit the wrong ones.
"""

import contextlib
import time

import psutil

LOOK_S = 0.05
"""At 8 GB/s, as fast as a processor fills pages, a process gains 0.4 GB between two looks."""

FAMILY_LOOK_S = 0.25
FAMILY_SHARE = 0.01
"""Finding descendants reads the state of every process of the machine: it may cost this share of
a processor."""


class MemoryWatch:
    """Says when a process with its descendants holds more than it may.

    next_look : when to ask again, on the clock of ``time.monotonic``.

    Parameters
    ----------
    pid : int
    limit : int
        Bytes.
    """

    def __init__(self, pid: int, limit: int) -> None:
        self._pid = pid
        self._limit = limit
        now = time.monotonic()
        self.next_look = now + LOOK_S
        self._next_family_look = now + FAMILY_LOOK_S

    def excess(self) -> int | None:
        """Bytes held, if these are too many; None if not, or before the next look."""
        now = time.monotonic()
        if now < self.next_look:
            return None
        held = 0
        # It may have just ended.
        with contextlib.suppress(psutil.Error):
            held = self._held(psutil.Process(self._pid), now)
        self.next_look = time.monotonic() + LOOK_S
        return held if held > self._limit else None

    def _held(self, root: psutil.Process, now: float) -> int:
        own = int(root.memory_info().rss)
        if own > self._limit or now < self._next_family_look:
            return own
        descendants = root.children(recursive=True)
        held = sum(map(_share, [root, *descendants])) if descendants else own
        done = time.monotonic()
        self._next_family_look = done + max(FAMILY_LOOK_S, (done - now) / FAMILY_SHARE)
        return held


def _share(process: psutil.Process) -> int:
    """Resident bytes; those that several processes share, as forks do, are divided among them."""
    try:
        memory = process.memory_full_info()
    except psutil.Error:
        return 0
    return int(getattr(memory, "pss", memory.uss))
