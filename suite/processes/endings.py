"""The signals that ask a process to end: Ctrl-C, a batch system's, a closed terminal's."""

import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any, NoReturn

DEAF_S = 10.0
"""Whoever is impatient presses Ctrl-C twice. What the first one began takes less."""


class Asked(KeyboardInterrupt):
    """Somebody asked this process to end.

    number : of the signal.
    """

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.number = number

    @property
    def exit_code(self) -> int:
        """As shells count it: 130 for Ctrl-C."""
        return 128 + self.number


@contextmanager
def ending_tidily() -> Iterator[None]:
    """Raise :class:`Asked` when this process is asked to end, and once only.

    A signal that whoever started the process had it ignore, as ``nohup`` does, stays ignored. In
    any thread but the main one, which alone hears signals, nothing is changed.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    numbers = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
    before = {number: signal.getsignal(number) for number in numbers}
    asked_at: list[float] = []

    def ask(number: int, _: FrameType | None) -> None:
        if not asked_at or time.monotonic() > asked_at[-1] + DEAF_S:
            asked_at.append(time.monotonic())
            _raise(number)

    for number, handler in before.items():
        if handler in (signal.SIG_DFL, signal.default_int_handler):
            signal.signal(number, ask)
    try:
        yield
    finally:
        for number, handler in before.items():
            # Somebody impatient is not heard either while the process goes on to its end.
            signal.signal(number, _deaf(handler) if asked_at else handler)


def _deaf(handler: Any) -> Callable[[int, FrameType | None], None]:
    """A handler that does nothing for DEAF_S, and then what another one does."""
    since = time.monotonic()

    def hear(number: int, _: FrameType | None) -> None:
        if time.monotonic() > since + DEAF_S:
            signal.signal(number, handler)
            signal.raise_signal(number)

    return hear


def _raise(number: int) -> NoReturn:
    raise Asked(number)
