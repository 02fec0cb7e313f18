"""Planners that raise, exit, crash, hang, leave processes behind or end their parent."""

import ctypes
import os
import signal
import sys
import time

import numba

from .base import HANG_S, Base, go_away


class Raises(Base):
    name = "raises"

    def misbehave(self):
        raise RuntimeError("no luck today")


class RaisesBaseException(Base):
    """What ``except Exception`` does not catch."""

    name = "raises-base-exception"

    def misbehave(self):
        raise GeneratorExit


class Interrupts(Base):
    name = "interrupts"

    def misbehave(self):
        raise KeyboardInterrupt


class SystemExits(Base):
    name = "system-exits"

    def misbehave(self):
        sys.exit(3)


class Exits(Base):
    name = "exits"

    def misbehave(self):
        os.write(2, b"going down\n")
        os._exit(3)


class Segfaults(Base):
    name = "segfaults"

    def misbehave(self):
        ctypes.string_at(0)


class Hangs(Base):
    name = "hangs"

    def misbehave(self):
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        while True:
            pass


class HangsInC(Base):
    """Keeps the GIL."""

    name = "hangs-in-c"

    def misbehave(self):
        ctypes.PyDLL(None).sleep(int(HANG_S))


@numba.njit("int64(int64)", nogil=False)
def _endless(number):
    while number >= 0:
        number = (number + 1) % 1000
    return number


class HangsInKernel(Base):
    """Keeps the GIL too, and sees no signal that Python handles."""

    name = "hangs-in-kernel"

    def misbehave(self):
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        _endless(1)


class HangsInWarmUp(Base):
    name = "hangs-in-warm-up"

    def warm_up(self):
        time.sleep(HANG_S)


class ExitsInWarmUp(Base):
    name = "exits-in-warm-up"

    def warm_up(self):
        os._exit(4)


class Forks(Base):
    """Leaves a child that lives longer, and holds all pipes open."""

    name = "forks"

    def misbehave(self):
        if os.fork() == 0:
            time.sleep(HANG_S)
            os._exit(0)


class Daemonizes(Base):
    name = "daemonizes"

    def misbehave(self):
        go_away()
        os.wait()


class DaemonizesInWarmUp(Base):
    """And so in the fork server, too."""

    name = "daemonizes-in-warm-up"

    def warm_up(self):
        super().warm_up()
        go_away()


class DaemonizesAndDies(Base):
    name = "daemonizes-and-dies"

    def misbehave(self):
        go_away()
        os.wait()
        ctypes.string_at(0)


class DaemonizesAndHangs(Base):
    name = "daemonizes-and-hangs"

    def misbehave(self):
        go_away()
        while True:
            pass


class LeavesItsSessionAndHangs(Base):
    """In a child that keeps all descriptors."""

    name = "leaves-its-session-and-hangs"

    def misbehave(self):
        if os.fork() == 0:
            os.setsid()
            time.sleep(HANG_S)
        while True:
            pass


class KillsItsParent(Base):
    name = "kills-its-parent"

    def misbehave(self):
        os.kill(os.getppid(), signal.SIGKILL)
        time.sleep(HANG_S)


class ComesBackTwice(Base):
    """Forks, and lets the child go on as if it were the planner."""

    name = "comes-back-twice"

    def misbehave(self):
        os.fork()
