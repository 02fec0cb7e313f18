import time
from dataclasses import dataclass

import pytest

from suite.planner import Recorder
from suite.referee.clock import Clock


@dataclass
class Machine:
    """Its clocks go when they are told to."""

    wall_s: float = 100.0
    cpu_s: float = 10.0

    def compute(self, seconds):
        self.wall_s += seconds
        self.cpu_s += seconds

    def wait(self, seconds):
        self.wall_s += seconds


@pytest.fixture
def machine(monkeypatch):
    machine = Machine()
    monkeypatch.setattr(time, "perf_counter", lambda: machine.wall_s)
    monkeypatch.setattr(time, "process_time", lambda: machine.cpu_s)
    return machine


def test_it_counts_what_is_within_and_nothing_else(machine):
    clock = Clock(Recorder())
    machine.compute(1.0)
    with clock:
        machine.compute(2.0)
        machine.wait(4.0)
    machine.compute(8.0)
    assert (clock.wall_s, clock.cpu_s) == (6.0, 2.0)


def test_reports_are_stamped_by_it(machine):
    recorder = Recorder()
    machine.compute(1.0)
    with Clock(recorder):
        machine.compute(2.0)
        machine.wait(4.0)
        recorder.improved(3.0)
    (report,) = recorder.improvements
    assert (report.wall_s, report.cpu_s) == (6.0, 2.0)


def test_on_a_real_machine_no_report_is_later_than_its_end():
    recorder = Recorder()
    with Clock(recorder) as clock:
        recorder.improved(3.0)
    (report,) = recorder.improvements
    assert 0.0 < report.wall_s <= clock.wall_s
    assert 0.0 < report.cpu_s <= clock.cpu_s


def test_what_is_raised_stops_it_and_passes(machine):
    def fail():
        machine.compute(2.0)
        raise RuntimeError("no luck")

    clock = Clock(Recorder())
    with pytest.raises(RuntimeError, match="no luck"), clock:
        fail()
    assert clock.wall_s == 2.0


def test_a_recorder_that_is_started_anew_is_told_and_shortens_no_time(machine):
    recorder = Recorder()
    with Clock(recorder) as clock:
        machine.compute(2.0)
        recorder.start_clock()
    assert clock.restarted
    assert clock.wall_s == 2.0


@pytest.mark.parametrize(
    ("computes", "waits", "contended"), [(2.0, 0.1, False), (2.0, 1.0, True), (0.001, 0.001, False)]
)
def test_work_that_waits_is_contended_and_a_tenth_or_a_tick_does_not_count(
    machine, computes, waits, contended
):
    with Clock(Recorder()) as clock:
        machine.compute(computes)
        machine.wait(waits)
    assert clock.contended is contended
    assert not clock.restarted
