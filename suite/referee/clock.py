"""The one clock of a run: it goes while the planner is asked, and says whether it had to wait."""

import time
from typing import Self

from suite.planner import Recorder

FACTOR = 1.1
FLOOR_S = 0.002
"""Below this, the resolution of the CPU clock decides, not the load of the machine."""


class Clock:
    """Goes as long as a ``with`` statement, in which nothing may stand but the planner's work.

    wall_s, cpu_s : float, seconds of wall time and of CPU time of this process, whatever was raised
        meanwhile; 0 until it stands.

    Parameters
    ----------
    recorder : Recorder
        Its stamps are of this clock: it starts when this one does.
    """

    def __init__(self, recorder: Recorder) -> None:
        self.wall_s = 0.0
        self.cpu_s = 0.0
        self._recorder = recorder

    def __enter__(self) -> Self:
        self._cpu = time.process_time()
        self._recorder.start_clock()
        # Kept here, for the planner has the recorder in its hands.
        self._started = self._recorder.started
        return self

    def __exit__(self, *_: object) -> None:
        self.wall_s = time.perf_counter() - self._started
        self.cpu_s = time.process_time() - self._cpu

    @property
    def restarted(self) -> bool:
        """Whether the recorder was started anew: what it stamped is no time of this clock."""
        return self._recorder.started != self._started

    @property
    def contended(self) -> bool:
        """Whether the work waited for the processor: its times are then longer than its own.

        Work that sleeps, or reads files, looks the same from outside. So it is said of too many
        rather than of too few. What a neighbour on the same core or memory slows down, no clock
        tells.
        """
        return self.wall_s > FACTOR * self.cpu_s + FLOOR_S
