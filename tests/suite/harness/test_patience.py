import subprocess
import sys
import threading
import time

import pytest

from suite.harness import patience as module
from suite.harness.patience import OthersLoad, Patience
from suite.processes.cores import honest_jobs

BURN = "import time\nwhile time.process_time() < 0.4: pass\n"


def loads(*values):
    """What others take, call by call; the last for ever."""
    left = list(values)
    return lambda: left.pop(0) if len(left) > 1 else left[0]


def test_it_waits_until_others_leave_a_core(monkeypatch):
    patience = Patience(600.0, loads(64.0, 64.0, 0.0))
    with patience.free_core(wanted=True):
        assert 2 * module.WINDOW_S <= patience.waited_s < 600.0


def test_an_idle_machine_costs_nothing():
    patience = Patience(10.0, loads(0.0))
    with patience.free_core(wanted=True):
        assert patience.waited_s == 0.0


def test_who_wants_no_core_does_not_wait():
    patience = Patience(10.0, loads(64.0))
    with patience.free_core(wanted=False):
        assert patience.waited_s == 0.0


def test_it_waits_no_longer_in_all_than_it_is_told():
    asked = []

    def others():
        asked.append(64.0)
        return 64.0

    patience = Patience(0.5, others)
    with patience.free_core(wanted=True):
        assert patience.waited_s >= 0.5
    asked.clear()
    for _ in range(3):
        with patience.free_core(wanted=True):
            assert asked == [], "who asks waits"


def test_runs_of_our_own_take_cores_too():
    patience = Patience(0.3, loads(honest_jobs() - 1.0))
    with patience.free_core(wanted=True):
        assert patience.waited_s == 0.0
        with patience.free_core(wanted=True):
            # Where there is but one core, nobody who asks for two jobs can be helped.
            assert patience.waited_s > 0.0 or honest_jobs() == 1


def test_giving_up_lets_all_go_on_at_once():
    patience = Patience(3600.0, loads(64.0))
    ends = []

    def run():
        with patience.free_core(wanted=True):
            ends.append(time.monotonic())

    threads = [threading.Thread(target=run) for _ in range(3)]
    for thread in threads:
        thread.start()
    patience.give_up()
    for thread in threads:
        thread.join(300.0)
    assert len(ends) == 3


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the kernel's counts")
def test_what_descends_from_us_is_no_load_of_others(tmp_path):
    def spent(command):
        busy, own = module._busy_s(module._allowed()), module._own_s()
        command()
        return module._busy_s(module._allowed()) - busy, module._own_s() - own

    def by_a_child():
        subprocess.run([sys.executable, "-c", BURN], check=True)

    def by_an_orphan():
        done = tmp_path / "done"
        code = f"{BURN}open({str(done)!r}, 'w').close()"
        subprocess.run(["sh", "-c", f'"{sys.executable}" -c "$0" & exit', code], check=True)
        while not done.exists():
            time.sleep(0.01)

    busy, own = spent(by_a_child)
    assert busy >= 0.35
    assert own >= 0.35
    busy, own = spent(by_an_orphan)
    assert busy >= 0.35
    assert own < 0.3


def test_the_load_of_others_is_a_number_of_cores():
    others = OthersLoad()
    assert 0.0 <= others() <= len(module._allowed()) + 1.0
