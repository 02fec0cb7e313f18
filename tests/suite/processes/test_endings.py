import signal
import subprocess
import sys

import pytest

from suite.processes import endings
from suite.processes.endings import Asked, ending_tidily

PATIENT = """
import time
from suite.processes.endings import Asked, ending_tidily
with ending_tidily():
    try:
        print("ready", flush=True)
        time.sleep(60)
    except KeyboardInterrupt as asked:
        print("asked", flush=True)
        time.sleep(0.5)
        print(asked, asked.exit_code)
"""


@pytest.fixture(autouse=True)
def _this_process_hears_as_before():
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = {number: signal.getsignal(number) for number in numbers}
    signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.mark.parametrize(
    ("number", "told"),
    [(signal.SIGINT, "SIGINT 130"), (signal.SIGTERM, "SIGTERM 143"), (signal.SIGHUP, "SIGHUP 129")],
)
def test_who_is_asked_twice_to_end_ends_tidily_once(number, told):
    process = subprocess.Popen(
        [sys.executable, "-c", PATIENT],
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),
    )
    assert process.stdout.readline() == "ready\n"
    process.send_signal(number)
    assert process.stdout.readline() == "asked\n"
    process.send_signal(number)
    assert process.communicate()[0] == f"{told}\n"
    assert process.returncode == 0


def test_who_asks_again_much_later_is_heard(monkeypatch):
    with ending_tidily():
        with pytest.raises(Asked):
            signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGTERM)
        monkeypatch.setattr(endings, "DEAF_S", 0.0)
        with pytest.raises(Asked):
            signal.raise_signal(signal.SIGTERM)


def test_what_was_ignored_stays_ignored_and_all_is_as_before_afterwards():
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with ending_tidily():
            signal.raise_signal(signal.SIGHUP)
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    finally:
        signal.signal(signal.SIGHUP, before)


IMPATIENT = (
    PATIENT.replace("print(asked, asked.exit_code)", "pass")
    + """
print("done", flush=True)
time.sleep(0.5)
"""
)


def test_who_asks_again_while_the_process_ends_is_not_heard():
    process = subprocess.Popen(
        [sys.executable, "-c", IMPATIENT],
        stdout=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    assert process.stdout.readline() == "ready\n"
    process.send_signal(signal.SIGINT)
    assert process.stdout.readline() == "asked\n"
    assert process.stdout.readline() == "done\n"
    process.send_signal(signal.SIGINT)
    assert process.wait() == 0


def test_much_later_it_is_heard_as_before(monkeypatch):
    with pytest.raises(Asked), ending_tidily():
        signal.raise_signal(signal.SIGINT)
    signal.raise_signal(signal.SIGINT)
    monkeypatch.setattr(endings, "DEAF_S", 0.0)
    with pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
