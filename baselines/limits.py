"""When a run's time is over: what all planners of this package that keep a budget of time ask."""

from collections.abc import Callable

from suite.planner import Budget, Recorder


def time_is_over(budget: Budget, recorder: Recorder) -> Callable[[], bool]:
    """Make the question whether a run's wall time or CPU time is spent.

    The recorder's clock is the run's only one. CPU time is read where it is limited only: a system
    call, it takes ten times as long as wall time.

    Parameters
    ----------
    budget : Budget
        ``wall_s`` and ``cpu_s`` count; without either, time is never over.
    recorder : Recorder

    Returns
    -------
    callable

    Examples
    --------
    >>> recorder = Recorder()
    >>> time_is_over(Budget(checks=5), recorder)()
    False
    >>> time_is_over(Budget(wall_s=1e-9), recorder)(), time_is_over(Budget(cpu_s=99), recorder)()
    (True, False)
    """
    wall_s, cpu_s = budget.wall_s, budget.cpu_s

    def is_over() -> bool:
        if wall_s is not None and recorder.wall_s() >= wall_s:
            return True
        return cpu_s is not None and recorder.cpu_s() >= cpu_s

    return is_over
