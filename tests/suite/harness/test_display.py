import io

from rich.console import Console

from suite.harness.display import Display
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
