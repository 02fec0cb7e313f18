import os
import pickle
import struct
from multiprocessing import Pipe

import pytest

from suite.processes import pipes
from suite.processes.pipes import (
    STDERR_BYTES,
    STDERR_LINES,
    GarbledError,
    Inbox,
    Tail,
    TooLongError,
    send,
)


@pytest.fixture
def pipe():
    receiver, sender = Pipe(duplex=False)
    with receiver, sender:
        yield receiver, sender


def test_messages_come_whole_and_in_order(pipe):
    inbox = Inbox(pipe[0])
    assert inbox.read() == []
    pipe[1].send("planning")
    pipe[1].send({"cost": 1.0})
    assert inbox.read() == ["planning", {"cost": 1.0}]


def test_a_message_in_pieces_is_waited_for_without_blocking(pipe):
    inbox = Inbox(pipe[0])
    message = pickle.dumps(list(range(100)))
    whole = struct.pack("!i", len(message)) + message
    for piece in (whole[:3], whole[3:20]):
        os.write(pipe[1].fileno(), piece)
        assert inbox.read() == []
    os.write(pipe[1].fileno(), whole[20:])
    assert inbox.read() == [list(range(100))]


def test_the_end_of_the_pipe_is_told(pipe):
    pipe[1].close()
    with pytest.raises(EOFError):
        Inbox(pipe[0]).read()


@pytest.mark.parametrize("noise", [b"hello, world", b"\0\0\0\4ABCD", b"\xff" * 8, b"\0" * 8])
def test_what_the_harness_did_not_write_is_noticed(pipe, noise):
    os.write(pipe[1].fileno(), noise)
    with pytest.raises(GarbledError):
        Inbox(pipe[0]).read()


def test_a_message_that_is_too_long_is_not_sent(pipe, monkeypatch):
    monkeypatch.setattr(pipes, "MESSAGE_BYTES", 1_000_000)
    with pytest.raises(TooLongError, match="2 MB, above 1 MB"):
        send(pipe[1], b"x" * 2_000_000)
    send(pipe[1], "short")
    assert Inbox(pipe[0]).read() == ["short"]


def test_of_standard_error_the_last_lines_are_kept(pipe):
    tail = Tail(pipe[0])
    for number in range(2000):
        os.write(pipe[1].fileno(), b"%d " % number + b"x" * 100 + b"\n")
        tail.read()
    lines = tail.last_lines().splitlines()
    assert len(lines) == STDERR_LINES
    assert lines[-1].startswith("1999 ")
    assert sum(map(len, tail._blocks)) < 2 * STDERR_BYTES
