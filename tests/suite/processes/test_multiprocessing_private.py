"""If a release of Python takes away what we need of multiprocessing, it is these that fail."""

import multiprocessing
import os
import shutil
import stat
import subprocess
import sys
import tempfile
import time
from multiprocessing import forkserver, spawn

import psutil
import pytest

from suite.processes.multiprocessing_private import (
    MESSAGE_HEADER,
    ORPHAN_WARNING,
    forget_server,
    leave_server,
    main_module,
    make_socket_folder,
    parent_pipe,
    server_pid,
    stand_in_for_main,
)

CONTEXT = multiprocessing.get_context("forkserver")


@pytest.fixture
def server():
    """A fork server of our own, in the place of any other."""
    forget_server()
    CONTEXT.set_forkserver_preload([])
    forkserver.ensure_running()
    yield psutil.Process(server_pid())
    forget_server()


@pytest.fixture
def main(monkeypatch):
    """Afterwards the tests have their own ``__main__`` again."""
    monkeypatch.setitem(sys.modules, "__main__", sys.modules["__main__"])
    monkeypatch.setitem(sys.modules, "__mp_main__", None)


def look_around(answers):
    """The target of a child: what it finds, before and after it leaves the server."""
    pipe = os.fstat(parent_pipe()).st_mode
    alive = forkserver._forkserver._forkserver_alive_fd
    before = stat.S_ISFIFO(os.fstat(alive).st_mode)
    leave_server()
    leave_server()
    try:
        os.fstat(alive)
    except OSError:
        answers.send((stat.S_ISFIFO(pipe), before, "closed"))


def test_the_fork_server_is_found_and_is_gone_when_it_is_forgotten(server):
    while not (words := server.cmdline()):  # between its fork and its exec it has none
        time.sleep(0.001)
    assert "multiprocessing.forkserver" in " ".join(words)
    assert server.ppid() == os.getpid()
    forget_server()
    assert not server.is_running()
    assert server_pid() is None
    forget_server()


def test_a_killed_server_can_be_forgotten_and_another_one_starts(server):
    server.kill()
    forget_server()
    forkserver.ensure_running()
    assert server_pid() not in (None, server.pid)


@pytest.fixture
def configuration(monkeypatch):
    """Of this process, as if it had made no folder for sockets yet."""
    forget_server()
    found = multiprocessing.current_process()._config
    monkeypatch.setitem(found, "tempdir", None)
    yield found
    forget_server()


def test_a_folder_that_is_too_long_for_a_socket_is_not_used(configuration, monkeypatch, tmp_path):
    folder = tmp_path / ("long-" * 30)
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    make_socket_folder()
    forkserver.ensure_running()
    assert tempfile.gettempdir() == str(folder)
    assert not configuration["tempdir"].startswith(str(folder))


def test_a_folder_for_sockets_that_was_deleted_is_made_again(configuration):
    make_socket_folder()
    forkserver.ensure_running()
    folder = configuration["tempdir"]
    shutil.rmtree(folder)
    forget_server()
    make_socket_folder()
    forkserver.ensure_running()
    assert configuration["tempdir"] == folder
    assert os.stat(folder).st_mode & 0o777 == 0o700  # noqa: PTH116


GARBAGE = """
import os, sys
from multiprocessing import resource_tracker
from suite.processes.multiprocessing_private import start_tracker_quietly
start_tracker_quietly()
print("mine", file=sys.stderr, flush=True)
os.write(resource_tracker._resource_tracker._fd, b"garbage\\n")
"""


def test_the_tracker_says_nothing_of_what_planners_write_into_its_pipe():
    done = subprocess.run(
        [sys.executable, "-c", GARBAGE], capture_output=True, text=True, check=True, timeout=50
    )
    # Its standard error is this pipe's other end, if it has it: run waits for that.
    assert done.stderr == "mine\n"


FAREWELL = """
import atexit, threading, time
from suite.processes.multiprocessing_private import end_without_farewell
threading.Thread(target=time.sleep, args=(60,)).start()
end_without_farewell(lambda: print("last", flush=True))
atexit.register(print, "not this", flush=True)
"""


def test_a_process_that_ends_without_farewell_waits_for_nobody():
    done = subprocess.run(
        [sys.executable, "-c", FAREWELL], capture_output=True, text=True, check=True, timeout=50
    )
    assert done.stdout == "last\n"


def test_a_child_leaves_the_server_and_keeps_the_pipe_of_its_parent(server):
    receiver, sender = CONTEXT.Pipe(duplex=False)
    child = CONTEXT.Process(target=look_around, args=(sender,))
    with receiver:
        with sender:
            child.start()
        assert receiver.recv() == (True, True, "closed")
    child.join()
    assert psutil.pid_exists(server.pid)


def test_who_was_asked_for_by_nobody_has_no_pipe_of_a_parent():
    assert parent_pipe() is None


def test_a_message_is_sent_behind_its_length():
    receiver, sender = CONTEXT.Pipe(duplex=False)
    with receiver, sender:
        sender.send_bytes(b"planning")
        assert os.read(receiver.fileno(), 100) == MESSAGE_HEADER.pack(8) + b"planning"


def test_the_server_complains_of_orphans_in_these_words():
    words = [text for text in forkserver.main.__code__.co_consts if isinstance(text, str)]
    assert any(text.startswith(ORPHAN_WARNING) for text in words)


@pytest.mark.usefixtures("main")
def test_a_script_is_run_again_in_a_child_unless_something_stands_in_for_it(tmp_path):
    script = tmp_path / "script.py"
    script.write_text("raise RuntimeError('the whole benchmark again')\n")
    asked = {"init_main_from_path": str(script)}
    stand_in_for_main(None, str(script))
    spawn.prepare(asked)
    stand_in_for_main(None, str(tmp_path / "another.py"))
    with pytest.raises(RuntimeError, match="again"):
        spawn.prepare(asked)


@pytest.mark.usefixtures("main")
def test_a_module_is_run_again_in_a_child_unless_something_stands_in_for_it(tmp_path, monkeypatch):
    (tmp_path / "started_so.py").write_text("raise RuntimeError('the whole benchmark again')\n")
    monkeypatch.syspath_prepend(tmp_path)
    asked = {"init_main_from_name": "started_so"}
    stand_in_for_main("started_so", None)
    spawn.prepare(asked)
    stand_in_for_main(None, None)
    with pytest.raises(RuntimeError, match="again"):
        spawn.prepare(asked)


@pytest.mark.usefixtures("main")
def test_what_stands_in_is_told_apart_as_multiprocessing_does_it(tmp_path):
    stand_in_for_main("started.so", None)
    told = spawn.get_preparation_data("child")
    assert told["init_main_from_name"] == main_module()[0] == "started.so"
    file = f"{tmp_path}/folder/../script.py"
    stand_in_for_main(None, file)
    told = spawn.get_preparation_data("child")
    assert told["init_main_from_path"] == main_module()[1] == f"{tmp_path}/script.py"
