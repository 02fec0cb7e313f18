"""Whether a run had a processor to itself: what its clocks say of it when it is over."""

FACTOR = 1.1
FLOOR_S = 0.002
"""Below this, the resolution of the CPU clock decides, not the load of the machine."""


def waited(wall_s: float, cpu_s: float) -> bool:
    """Whether a computation waited for the processor: its times are then longer than its own.

    One that sleeps, or reads files, looks the same from outside. So it is said of too many rather
    than of too few. What a neighbour on the same core or memory slows down, no clock tells.

    Parameters
    ----------
    wall_s, cpu_s : float
        What it took, seconds.

    Examples
    --------
    >>> waited(1.0, 0.98), waited(1.0, 0.5), waited(0.002, 0.001)
    (False, True, False)
    """
    return wall_s > FACTOR * cpu_s + FLOOR_S
