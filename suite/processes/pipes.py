"""Reading from the pipes of a run, whatever is written into them: never waiting, never without end.

``Connection.recv`` waits for as many bytes as the first four announce. A planner that prints into
the wrong descriptor would so hold up the harness for ever.
"""

import os
import pickle
from collections import deque
from multiprocessing.connection import Connection
from typing import Any

from suite.processes.multiprocessing_private import MESSAGE_HEADER

STDERR_LINES = 20
STDERR_BYTES = 16_384
BLOCK_BYTES = 65_536
"""What a pipe holds, on Linux."""

MESSAGE_BYTES = 1 << 28
"""More than any record has: a trace of a million generations is a tenth of it."""


class GarbledError(Exception):
    """What came through a pipe is not what the harness's own end sends."""


class TooLongError(Exception):
    """A message is longer than the other end takes it."""


def send(pipe: "Connection[Any, Any]", message: Any) -> None:
    """Send a message as ``Connection.send`` does, for an :class:`Inbox`.

    Raises
    ------
    TooLongError
        If it is too long, and nothing was sent.
    """
    packed = pickle.dumps(message)
    if len(packed) > MESSAGE_BYTES:
        raise TooLongError(f"{len(packed) / 1e6:.0f} MB, above {MESSAGE_BYTES / 1e6:.0f} MB")
    pipe.send_bytes(packed)


class Inbox:
    """Takes the messages that the other end sends with ``Connection.send``."""

    def __init__(self, pipe: "Connection[Any, Any]") -> None:
        self.pipe = pipe
        self._bytes = bytearray()
        os.set_blocking(pipe.fileno(), False)

    def read(self) -> list[Any]:
        """Take what is there, and return the messages that are whole by now.

        Raises
        ------
        EOFError
            At the end of the file.
        GarbledError
            If somebody else wrote into the pipe.
        """
        try:
            block = os.read(self.pipe.fileno(), BLOCK_BYTES)
        except BlockingIOError:
            return []
        if not block:
            raise EOFError
        self._bytes += block
        messages = []
        while (size := self._size()) is not None and len(self._bytes) >= size:
            messages.append(_unpickled(bytes(self._bytes[MESSAGE_HEADER.size : size])))
            del self._bytes[:size]
        return messages

    def _size(self) -> int | None:
        """Bytes of the message that comes next, header included; None if that is not known yet."""
        if len(self._bytes) < MESSAGE_HEADER.size:
            return None
        (size,) = MESSAGE_HEADER.unpack_from(self._bytes)
        if not 0 < size <= MESSAGE_BYTES:
            raise GarbledError(f"a message of {size} bytes")
        return MESSAGE_HEADER.size + int(size)


class Tail:
    """The last part of what a process writes to its standard error."""

    def __init__(self, pipe: "Connection[Any, Any]") -> None:
        self.pipe = pipe
        self._blocks: deque[bytes] = deque()
        self._size = 0
        os.set_blocking(pipe.fileno(), False)

    def read(self) -> bool:
        """Take what is there; False at the end of the file."""
        try:
            block = os.read(self.pipe.fileno(), BLOCK_BYTES)
        except BlockingIOError:
            return True
        self._blocks.append(block)
        self._size += len(block)
        while self._size - len(self._blocks[0]) > STDERR_BYTES:
            self._size -= len(self._blocks.popleft())
        return bool(block)

    def last_lines(self) -> str:
        """The last lines, as far as they were read."""
        text = b"".join(self._blocks)[-STDERR_BYTES:].decode(errors="replace")
        return "\n".join(text.splitlines()[-STDERR_LINES:])


def _unpickled(message: bytes) -> Any:
    try:
        return pickle.loads(message)
    except Exception as error:
        # Noise that looks like a pickle can raise anything.
        raise GarbledError(str(error)) from error
