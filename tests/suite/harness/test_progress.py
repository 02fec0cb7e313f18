import io

from rich.console import Console

from suite.harness.progress import Display
from suite.harness.run import Progress
from suite.planner import PlanStatus
from tests.suite.harness.records import make_cell, make_record


def shown(*states, terminal=False):
    out = io.StringIO()
    console = Console(file=out, force_terminal=terminal, width=200)
    with Display("walls", console) as display:
        for state in states:
            display(state)
    return out.getvalue()


def failure():
    return make_record(make_cell(seed=7), status=PlanStatus.ERROR, reason="Trace\nValueError: no")


def test_a_log_gets_plain_lines_of_first_and_last_state():
    text = shown(Progress(4, 0, 0, running=["a"]), Progress(4, 2, 0), Progress(4, 4, 0))
    assert text.splitlines() == [
        "walls: 0 of 4 done, 4 left; running a",
        "walls: 4 of 4 done, 0 left",
    ]


def lines_of(times, *, wanted, running=2):
    """What a log gets of runs that end at these times, the first of which waited for a compiler."""
    now = [0.0]
    out = io.StringIO()
    with Display("walls", Console(file=out, width=200), clock=lambda: now[0]) as display:
        names = ["x"] * running
        display(Progress(wanted, 0, 0, running=names))
        for done, time in enumerate(times, 1):
            now[0] = time
            display(Progress(wanted, done, 0, running=names))
    return out.getvalue().splitlines()


def test_what_the_compiler_took_is_not_taken_for_the_rate():
    # 75 s of compiling, then two runs a second.
    said = lines_of([75.0 + i / 2 for i in range(60)], wanted=100)
    assert "left; running" in said[1], said
    assert "runs/s" not in said[1], "after one run"
    assert "2 runs/s, about 40 s left" in said[2]
    assert all("min" not in line for line in said)


def test_runs_of_an_hour_have_an_estimate_after_a_round():
    # Two at a time, that end a minute apart: after the first round nobody knows yet.
    said = lines_of([3600, 3660, 7200, 7260], wanted=8)
    assert ["runs/s" in line for line in said] == [False, False, False, False, True]
    assert "about 2 h 0 min left" in said[-1]


def test_a_failure_is_named_once_with_the_end_of_its_reason():
    state = Progress(4, 1, 0, failed=1, last=failure())
    text = shown(state, state)
    assert text.count("zigzag / kbga / seed 7: error: ValueError: no") == 1


def test_failures_of_one_kind_are_named_once():
    def state(done, seed):
        record = make_record(make_cell(seed=seed), status=PlanStatus.ERROR, reason="boom")
        return Progress(4, done, 0, failed=done, last=record)

    assert shown(state(1, 5), state(2, 6)).count("error: boom") == 1


def test_a_terminal_gets_a_bar_that_names_what_runs():
    text = shown(
        Progress(4, 1, 0, failed=1, running=["zigzag / kbga / seed 1"], last=failure()),
        terminal=True,
    )
    assert "1/4" in text
    assert "1 failed" in text
    assert "zigzag / kbga / seed 1" in text


def test_runs_that_are_repeated_are_counted_by_themselves():
    states = [Progress(4, 4, 0, repeats_wanted=3, repeats_done=i) for i in (1, 3)]
    assert "4 of 4 done, 0 left, contended runs again: 3 of 3" in shown(*states)
    assert "contended runs again" in shown(*states, terminal=True)
    assert "contended" not in shown(Progress(4, 4, 0), terminal=True)
