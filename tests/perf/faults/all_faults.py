"""The faults that are tried: of processes, of the machine, and of planners."""

import os
import resource
import shutil
import signal
import sqlite3
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path

from suite.store.read import read_runs
from tests.perf.faults.fault import Fault
from tests.perf.faults.stage import Said, Stage
from tests.suite.commands import COMMAND

MANY = 8
"""Seeds of a matrix that is still running when it is struck."""

SOME_ROWS = 4
"""A matrix that has so many is in the middle."""

STOPPED_S = 3.0
DISK_BYTES = 4_000_000
LITTLE_BYTES = 150_000
"""Room for a few rows and SQLite's own files."""

NOBODY = 65534


def _struck(blow: Callable[[Stage, "subprocess.Popen[bytes]"], None]) -> Callable[[Stage], Said]:
    """Let a blow fall in the middle of a matrix."""

    def strike(stage: Stage) -> Said:
        command = stage.start()
        stage.wait_for_rows(SOME_ROWS)
        blow(stage, command)
        return stage.finish(command)

    return strike


def _signal_harness(number: int) -> Callable[[Stage], Said]:
    return _struck(lambda _, command: os.kill(command.pid, number))


def _signal_group(number: int) -> Callable[[Stage], Said]:
    """As a terminal and a batch system do."""
    return _struck(lambda _, command: os.killpg(command.pid, number))


def _signal_server(number: int) -> Callable[[Stage], Said]:
    return _struck(lambda stage, command: stage.server_of(command).send_signal(number))


def _signal_worker(number: int) -> Callable[[Stage], Said]:
    def strike(stage: Stage) -> Said:
        command = stage.start()
        stage.worker().send_signal(number)
        return stage.finish(command)

    return strike


def _stop_for_a_while(stage: Stage, command: "subprocess.Popen[bytes]") -> None:
    os.kill(command.pid, signal.SIGSTOP)
    time.sleep(STOPPED_S)
    os.kill(command.pid, signal.SIGCONT)


def _suspend_for_a_while(stage: Stage, command: "subprocess.Popen[bytes]") -> None:
    os.killpg(command.pid, signal.SIGTSTP)
    time.sleep(STOPPED_S)
    os.killpg(command.pid, signal.SIGCONT)


def _interrupt_twice(stage: Stage, command: "subprocess.Popen[bytes]") -> None:
    os.killpg(command.pid, signal.SIGINT)
    time.sleep(0.01)
    os.killpg(command.pid, signal.SIGINT)


LINGERS = 'settings = { file = "FOLDER/pid", seconds = 20.0 }'

OF_PROCESSES = [
    Fault("kill -9 of the harness", "SIGKILL in the middle of a matrix",
          _signal_harness(signal.SIGKILL), seeds=MANY, codes=(-9,)),
    Fault("kill -9 of the fork server", "SIGKILL in the middle of a matrix",
          _signal_server(signal.SIGKILL), seeds=MANY, status=("solved", "crashed")),
    Fault("kill -9 of a run", "SIGKILL of its process", _signal_worker(signal.SIGKILL),
          planner="lingers", settings=LINGERS, seeds=1, status=("crashed",),
          says="was ended by SIGKILL"),
    Fault("the harness is stopped", f"SIGSTOP, SIGCONT after {STOPPED_S:g} s",
          _struck(_stop_for_a_while), seeds=MANY),
    Fault("the fork server is stopped", "SIGSTOP, and nobody continues it",
          _signal_server(signal.SIGSTOP), seeds=MANY),
    Fault("a run is stopped", "SIGSTOP, and nobody continues it", _signal_worker(signal.SIGSTOP),
          planner="lingers", settings=LINGERS, seeds=1, limits="wall_s = 10",
          status=("timed_out",), says="more than 10 s"),
    Fault("Ctrl-Z and fg", f"SIGTSTP to the group, SIGCONT after {STOPPED_S:g} s",
          _struck(_suspend_for_a_while), seeds=MANY),
    Fault("Ctrl-C", "SIGINT to the group", _signal_group(signal.SIGINT), seeds=MANY,
          codes=(130,), says="to go on, give the same command again"),
    Fault("Ctrl-C twice", "SIGINT to the group, again after 10 ms", _struck(_interrupt_twice),
          seeds=MANY, codes=(130,), says="to go on, give the same command again"),
    Fault("a batch system's time is up", "SIGTERM to the group", _signal_group(signal.SIGTERM),
          seeds=MANY, codes=(143,), says="to go on, give the same command again"),
    Fault("the terminal is closed", "SIGHUP to the group", _signal_group(signal.SIGHUP),
          seeds=MANY, codes=(129,), says="to go on, give the same command again"),
]  # fmt: skip


def may_mount() -> str | None:
    """What is missing for file systems of one's own."""
    if os.geteuid() == 0 and shutil.which("mount"):
        return None
    return "not tried: it needs the right to mount (as root, or `unshare -rm make faults`)"


def _mount(*arguments: str) -> None:
    subprocess.run(["mount", *arguments], check=True)


@contextmanager
def _small_disk(stage: Stage) -> Iterator[None]:
    """A file system that takes no more than DISK_BYTES, with the store's folder on it."""
    disk = stage.folder / "disk"
    disk.mkdir()
    _mount("-t", "tmpfs", "-o", f"size={DISK_BYTES}", "tmpfs", str(disk))
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", str(disk)], check=True)


def _fill(disk: Path, spare: int = 0) -> Path:
    """Fill a file system until so many bytes are left."""
    filler = disk / "filler"
    with filler.open("wb") as file:
        file.truncate(0)
        free = shutil.disk_usage(disk).free
        file.write(b"\0" * max(0, free - spare))
    return filler


def _run_on_full_disk(spare: int) -> Callable[[Stage], Said]:
    def strike(stage: Stage) -> Said:
        filler = _fill(stage.store.parent, spare)
        said = stage.run()
        filler.unlink()
        return said

    return strike


def _on_full_disk(*words: str) -> Callable[[Stage], Said]:
    """Another command on the store, when nothing more can be written; FULL is such a place."""

    def strike(stage: Stage) -> Said:
        stage.run()
        disk = stage.folder / "disk"
        exports = disk / "exports"
        exports.mkdir()
        filler = _fill(disk)
        arguments = [word.replace("FULL", str(exports)) for word in words]
        arguments.insert(1, str(stage.store))
        said = stage.finish(stage.begin([*COMMAND, *arguments]))
        filler.unlink()
        return said

    return strike


def _on_read_only(stage: Stage) -> Said:
    disk = str(stage.store.parent)
    _mount("-o", "remount,ro", disk)
    said = stage.run()
    _mount("-o", "remount,rw", disk)
    return said


def _tables_on_read_only(stage: Stage) -> Said:
    stage.run()
    disk = str(stage.store.parent)
    _mount("-o", "remount,ro", disk)
    said = stage.finish(stage.begin([*COMMAND, "tables", str(stage.store)]))
    _mount("-o", "remount,rw", disk)
    return said


def may_lose_rights() -> str | None:
    """What is missing for a folder that root may not write to."""
    if os.geteuid() == 0 and shutil.which("setpriv"):
        return None
    return "not tried: it needs root and util-linux's setpriv"


def _in_a_folder_of_nobody(stage: Stage) -> Said:
    """Another user's store: to be read, not to be written. Root gives up its right to do all."""
    for place in (stage.store.parent, stage.store):
        os.chown(place, NOBODY, NOBODY)
    said = stage.run(prefix=("setpriv", "--bounding-set=-dac_override,-dac_read_search"))
    for place in (stage.store.parent, stage.store):
        os.chown(place, 0, 0)
    return said


def _with_lock(words: str) -> Callable[[Stage], Said]:
    def strike(stage: Stage) -> Said:
        with closing(sqlite3.connect(stage.store)) as other:
            other.execute(words)
            return stage.run()

    return strike


def _locked_in_the_middle(stage: Stage) -> Said:
    command = stage.start()
    stage.wait_for_rows(SOME_ROWS)
    with closing(sqlite3.connect(stage.store, timeout=30)) as other:
        other.execute("BEGIN IMMEDIATE")
        return stage.finish(command)


def _beside_another_harness(stage: Stage) -> Said:
    first = stage.start()
    stage.worker()
    second = stage.run()
    first.kill()
    first.wait()
    return second


CLOCK = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <time.h>

static long back(void) {
    struct stat there;
    const char *file = getenv("KBGA_TEST_CLOCK_IS_BACK");
    return file && stat(file, &there) == 0 ? 400L * 86400L : 0L;
}
int clock_gettime(clockid_t clock, struct timespec *now) {
    static int (*real)(clockid_t, struct timespec *);
    if (!real) real = dlsym(RTLD_NEXT, "clock_gettime");
    int code = real(clock, now);
    if (clock == CLOCK_REALTIME) now->tv_sec -= back();
    return code;
}
int gettimeofday(struct timeval *now, void *zone) {
    struct timespec found;
    int code = clock_gettime(CLOCK_REALTIME, &found);
    now->tv_sec = found.tv_sec;
    now->tv_usec = found.tv_nsec / 1000;
    return code;
}
time_t time(time_t *now) {
    struct timespec found;
    clock_gettime(CLOCK_REALTIME, &found);
    if (now) *now = found.tv_sec;
    return found.tv_sec;
}
"""
"""The calendar's clock as a process sees it, 400 days back while a file is there; the steady clock
goes on. libfaketime 0.9.10 can't leave that one alone: Python's sleep then fails."""


def has_compiler() -> str | None:
    """What is missing for another clock."""
    return None if shutil.which("cc") else "not tried: it needs a C compiler"


def _clock_set_back(stage: Stage) -> Said:
    source, library, mark = (stage.folder / name for name in ("clock.c", "clock.so", "is-back"))
    source.write_text(CLOCK, encoding="utf-8")
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True)
    environment = {"LD_PRELOAD": str(library), "KBGA_TEST_CLOCK_IS_BACK": str(mark)}
    command = stage.start(environment=environment)
    stage.wait_for_rows(SOME_ROWS)
    mark.touch()
    said = stage.finish(command)
    dates = read_runs(stage.store)["started_at"].dropna()
    if len({date[:4] for date in dates}) < 2:
        raise AssertionError("no row is from before the clock was set")
    return said


def _with(environment: dict[str, str | None]) -> Callable[[Stage], Said]:
    def strike(stage: Stage) -> Said:
        wanted = {
            name: value and value.replace("FOLDER", str(stage.folder))
            for name, value in environment.items()
        }
        return stage.run(environment=wanted)

    return strike


def _tmpdir_goes(stage: Stage) -> Said:
    folder = stage.folder / "tmp"
    folder.mkdir()
    command = stage.start(environment={"TMPDIR": str(folder)})
    stage.wait_for_rows(SOME_ROWS)
    shutil.rmtree(folder)
    return stage.finish(command)


def _with_long_tmpdir(stage: Stage) -> Said:
    folder = stage.folder / ("a-long-name-" * 8) / ("b-long-name-" * 8)
    folder.mkdir(parents=True)
    return stage.run(environment={"TMPDIR": str(folder)})


def _without_temporary_folders(stage: Stage) -> Said:
    """TMPDIR is full, as it may be on a cluster's node."""
    disk = stage.folder / "disk"
    filler = _fill(disk)
    said = stage.run(environment={"TMPDIR": str(disk)})
    filler.unlink()
    return said


def _limited(kind: int, value: int) -> Callable[[Stage], Said]:
    return lambda stage: stage.run(before=lambda: resource.setrlimit(kind, (value, value)))


def _store_goes(pattern: str) -> Callable[[Stage], Said]:
    def blow(stage: Stage, _: "subprocess.Popen[bytes]") -> None:
        for file in stage.store.parent.glob(pattern):
            file.unlink()

    return _struck(blow)


def _folder_goes(stage: Stage, _: "subprocess.Popen[bytes]") -> None:
    shutil.rmtree(stage.store.parent)


@contextmanager
def _plugin_file(stage: Stage) -> Iterator[None]:
    """A file for --plugin, which does something when it is imported, in the command itself too."""
    (stage.folder / "plugin.py").write_text(HANGS_AT_EXIT, encoding="utf-8")
    yield


@contextmanager
def _folder_of_its_own(stage: Stage) -> Iterator[None]:
    (stage.folder / stage.place).mkdir()
    yield


def _reader_goes(stage: Stage) -> Said:
    """`| head -0`: nobody reads what the command prints."""
    stage.run()
    words = " ".join(f"'{word}'" for word in [*COMMAND, "tables", str(stage.store)])
    return stage.finish(stage.begin(["bash", "-c", f"set -o pipefail; {words} | true"]))


def _without_streams(stage: Stage) -> Said:
    def close() -> None:
        os.closerange(0, 3)

    return stage.run(before=close)


HANGS_AT_EXIT = """
import atexit, threading, time
from suite.planner import Plan, Planner, PlanStatus
atexit.register(time.sleep, 300)
threading.Thread(target=time.sleep, args=(300,)).start()

class Lasting(Planner):
    name = "lasting"
    def plan(self, scene, query, budget, rng, recorder):
        return Plan(PlanStatus.EXHAUSTED)
"""
"""An exit handler that hangs, and a thread that Python would wait for."""

WITHOUT_CACHES: dict[str, str | None] = {
    # Not even root can make it.
    "HOME": "/proc/nonexistent",
    "NUMBA_CACHE_DIR": None,
    "XDG_CACHE_HOME": None,
    "XDG_CONFIG_HOME": None,
}
MEND = "run the same command again|Check its folder|name another|give the same command again"

OF_THE_MACHINE = [
    Fault("the disk is full at the start", "the store on a file system without a free byte",
          _run_on_full_disk(0), place="disk", ground=_small_disk, needs=may_mount, codes=(2,),
          says="store.db: .*disk.*(Make room|full)"),
    Fault("the disk becomes full", f"the store on a file system with {LITTLE_BYTES:,} bytes left",
          _run_on_full_disk(LITTLE_BYTES), place="disk", seeds=30, planner="visibility-graph",
          ground=_small_disk, needs=may_mount, codes=(2,),
          says="store.db: .*disk.*(Make room|full)"),
    Fault("the disk is full for `tables --output`", "CSV files go to a full file system",
          _on_full_disk("tables", "--format", "csv", "--output", "FULL"),
          ground=_small_disk, needs=may_mount, codes=(2,), says="exports.*No space left"),
    Fault("the disk is full for `export`", "rows go to a full file system",
          _on_full_disk("export", "FULL", "--to", "csv"),
          ground=_small_disk, needs=may_mount, codes=(2,), says="exports.*No space left"),
    Fault("the disk is full for Planner Arena", "a database on a full file system",
          _on_full_disk("export", "FULL/arena.db", "--to", "planner-arena"),
          ground=_small_disk, needs=may_mount, codes=(2,), says="exports.*No space left"),
    Fault("the disk is full for `report`", "the page goes to a full file system",
          _on_full_disk("report", "-o", "FULL/report.html"),
          ground=_small_disk, needs=may_mount, codes=(2,), says="exports.*No space left"),
    Fault("`tables` on a full disk", "the store on a file system without a free byte",
          _on_full_disk("tables"), place="disk", ground=_small_disk, needs=may_mount,
          says="wanderer"),
    Fault("a file may have 300 kB", "RLIMIT_FSIZE, as a quota", _limited(resource.RLIMIT_FSIZE,
          300_000), seeds=60, planner="visibility-graph", codes=(2,),
          says=f"store.db: .*({MEND}|full)"),
    Fault("the folder is read-only", "the store on a file system that is mounted read-only",
          _on_read_only, place="disk", ground=_small_disk, needs=may_mount, codes=(2,),
          says=f"store.db: .*({MEND})"),
    Fault("`tables` in a read-only folder", "the same, for reading", _tables_on_read_only,
          place="disk", ground=_small_disk, needs=may_mount, says="wanderer"),
    Fault("the store is another user's", "its folder is, too", _in_a_folder_of_nobody,
          place="out", ground=_folder_of_its_own, needs=may_lose_rights, codes=(2,),
          says=f"store.db: .*({MEND})"),
    Fault("another harness writes to the store", "a second one is started beside it",
          _beside_another_harness, planner="lingers", settings=LINGERS, seeds=1, codes=(2,),
          says=r"store.db: another process is writing to it \(process"),
    Fault("the store is locked", "BEGIN EXCLUSIVE in another process",
          _with_lock("BEGIN EXCLUSIVE"), codes=(2,), says=f"store.db: .*({MEND})"),
    Fault("the store is locked in the middle", "BEGIN IMMEDIATE in another process",
          _locked_in_the_middle, seeds=MANY, codes=(2,), says=f"store.db: .*({MEND})"),
    Fault("the clock is set back", "by 400 days in the middle, for these processes",
          _clock_set_back, seeds=MANY, needs=has_compiler),
    Fault("TMPDIR was never there", "TMPDIR names no folder", _with({"TMPDIR": "/nonexistent"})),
    Fault("TMPDIR goes", "it is deleted in the middle", _tmpdir_goes, seeds=MANY),
    Fault("TMPDIR has a long name", "of more than 108 characters, too many for a socket",
          _with_long_tmpdir),
    Fault("TMPDIR is full", "a file system without a free byte", _without_temporary_folders,
          ground=_small_disk, needs=may_mount, codes=(0, 2)),
    Fault("HOME can't be written", "HOME names no folder, and no cache is named",
          _with(WITHOUT_CACHES)),
    Fault("64 open files", "ulimit -n 64", _limited(resource.RLIMIT_NOFILE, 64)),
    Fault("64 open files and 8 jobs", "ulimit -n 64", _limited(resource.RLIMIT_NOFILE, 64),
          seeds=MANY, options=("--jobs", "8")),
    Fault("20 open files", "ulimit -n 20", _limited(resource.RLIMIT_NOFILE, 20), codes=(0, 2)),
    Fault("nobody reads", "`tables | true`", _reader_goes, codes=(0, 1, 141)),
    Fault("no standard streams", "descriptors 0 to 2 are closed", _without_streams),
    Fault("the store is deleted", "in the middle, with all files beside it",
          _store_goes("store.db*"), seeds=MANY, says="store.db: was deleted"),
    Fault("the store's journal is deleted", "store.db-wal and -shm, in the middle",
          _store_goes("store.db-*"), seeds=MANY),
    Fault("the store's folder is deleted", "in the middle", _struck(_folder_goes), seeds=MANY,
          place="out", ground=_folder_of_its_own, says="store.db: was deleted"),
]  # fmt: skip

OF_PLANNERS = [
    Fault("a planner deletes the store", "with all files beside it", planner="deletes",
          settings='settings = { pattern = "FOLDER/store.db*" }', says="store.db: was deleted"),
    Fault("a million improvements", "each is an event of the row", planner="improves-without-end",
          limits="wall_s = 170\nmemory_mb = 1500", seeds=1),
    Fault("a path of a million points", "16 MB", planner="goes-by-a-million-points", seeds=1,
          limits="wall_s = 170\nmemory_mb = 1500"),
    Fault("a message of 100 MB", "a path of 6.25 million points, most repeated",
          planner="sends-megabytes", seeds=1, limits="wall_s = 170\nmemory_mb = 3000"),
    Fault("a message that is too large", "a path of 18 million points", planner="sends-too-much",
          seeds=1, limits="wall_s = 170\nmemory_mb = 6000", status=("error",),
          says="288 MB"),
    Fault("an error of 100 MB", "its text", planner="complains-without-end", seeds=1,
          status=("error",), says="luck"),
    Fault("500 threads", "which outlive the plan", planner="starts-many-threads"),
    Fault("an atexit that hangs", "registered in `plan`", planner="hangs-at-exit"),
    Fault("an atexit that hangs, in the fork server", "registered in `warm_up`",
          planner="hangs-at-exit-of-the-server"),
    Fault("a thread in the fork server", "started in `warm_up`, not daemonic",
          planner="leaves-a-thread-in-warm-up"),
    Fault("an atexit and a thread at import", "by a file for --plugin, in the command too",
          planner="lasting", status=("exhausted",), ground=_plugin_file,
          options=("--jobs", "2", "--plugin", "FOLDER/plugin.py")),
    Fault("memory beyond the limit", "as fast as pages are filled", planner="eats-all-memory",
          status=("out_of_memory",), says="above 600 MB"),
    Fault("recursion without end", "in Python", planner="recurses-without-end",
          status=("error",), says="RecursionError"),
    Fault("the stack overflows", "in C", planner="overflows-the-stack",
          status=("crashed", "error"), says="SIGSEGV|RecursionError"),
    Fault("a segmentation fault", "a read at 0", planner="segfaults", status=("crashed",),
          says="SIGSEGV"),
    Fault("os._exit", "with 3", planner="exits", status=("crashed",), says="exit code 3"),
    Fault("all descriptors closed", "0 to 255", planner="closes-descriptors",
          status=("crashed",), says="exit code"),
    Fault("a child is left", "by fork", planner="forks"),
    Fault("100 children are left", "each in a session of its own", planner="leaves-many-children"),
    Fault("a daemon is left", "fork, setsid, fork", planner="daemonizes"),
    Fault("a planner kills the fork server", "SIGKILL to its parent", planner="kills-its-parent",
          limits="wall_s = 3", status=("crashed", "timed_out")),
    Fault("a planner stops the fork server", "SIGSTOP to its parent", planner="stops-its-parent"),
    Fault("a planner stops itself", "SIGSTOP", planner="stops-itself", limits="wall_s = 2",
          status=("timed_out",), says="more than 2 s"),
    Fault("a planner hangs", "in a loop, deaf to SIGTERM", planner="hangs", limits="wall_s = 2",
          status=("timed_out",), says="more than 2 s"),
    Fault("a planner hangs in C", "holding the GIL", planner="hangs-in-c", limits="wall_s = 2",
          status=("timed_out",), says="more than 2 s"),
    Fault("a planner asks the user", "input()", planner="asks-the-user", status=("error",),
          says="EOFError"),
    Fault("200 MB of print", "to standard output and error", planner="prints"),
    Fault("garbage in the harness's pipe", "written to every descriptor",
          planner="prints-into-pipes", status=("error",), says="wrote into the pipe"),
]  # fmt: skip

FAULTS = [*OF_PROCESSES, *OF_THE_MACHINE, *OF_PLANNERS]
