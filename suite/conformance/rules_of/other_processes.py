"""A rule about another process: what differs between two of them decides nothing of a run.

The order of a set of strings, and ``hash`` of a string, are other ones in each process; so are the
number of the process and the addresses of its objects. A planner that depends on them repeats
itself as long as its process lives, and no row of it can be made again.
"""

import contextlib
import os
import pickle
import subprocess
import sys
from typing import Any

from suite.conformance.finding import Answer, Finding, NotApplicable
from suite.conformance.rules_of.repeatability import difference, keeps_no_state
from suite.conformance.subject import Subject
from suite.plugins.from_file import named_plugins
from suite.processes.output import print_aside

SCENES = ("one wall", "500 obstacles")
"""Few, as a process is started for them; in the second one, a set of obstacles is a large one."""

ANSWER_S = 120
"""What it may take, compilation included. Whoever waits for this rule must wait for longer."""

PROGRAM = (
    "import sys; sys.path[:] = sys.argv[1:]; "
    "from suite.conformance.rules_of.other_processes import answer; answer()"
)

NOT_FOUND = NotApplicable(
    "another process does not find the class or its settings: it is not at the top of a module."
)


def same_path_in_another_process(subject: Subject) -> Answer:
    """The same seed and counted budget give the same run in another process."""
    found = keeps_no_state(subject)
    if found is not None:
        return found if isinstance(found, NotApplicable) else NotApplicable("it keeps state.")
    try:
        names = [scene.name for scene in subject.on(*SCENES)]
        request = pickle.dumps((subject.planner_class, subject.settings, names))
    except Exception:  # pickle raises whatever a class's own hooks raise
        return NOT_FOUND
    try:
        done = _asked_there(request)
    except subprocess.TimeoutExpired:
        return _differs(f"another process had not ended after {ANSWER_S} s")
    if done.returncode != 0:
        return _differs(f"another process ended with exit code {done.returncode}{_last(done)}")
    there: dict[str, Any] | None = pickle.loads(done.stdout)
    if there is None:
        return NOT_FOUND
    here = {trial.scene.name: trial for trial in subject.ordinary_trials}
    for name, outcome in there.items():
        if outcome != here[name].outcome:
            what = difference(here[name].outcome, outcome)
            error = f": {outcome[-1]}" if isinstance(outcome[-1], str) else ""
            where = f"{here[name].label}: a run in another process"
            return _differs(f"{where} differs in {what}{error}")
    return None


def _differs(found: str) -> Finding:
    return Finding(
        found,
        "the same path, counts and reports in every process",
        "Sort what comes out of a set before you go through it; draw from the `rng` that plan is "
        "given and from nothing else: hash() of a string, id(), os.getpid() and the time of day "
        "are others in each process.",
    )


def _asked_there(request: bytes) -> "subprocess.CompletedProcess[bytes]":
    """Hand a request to a new interpreter, whose strings have other hashes."""
    salt = "2" if os.environ.get("PYTHONHASHSEED") == "1" else "1"
    return subprocess.run(
        [sys.executable, "-c", PROGRAM, *map(str, sys.path)],
        input=request,
        capture_output=True,
        env={**os.environ, "PYTHONHASHSEED": salt},
        check=False,
        timeout=ANSWER_S,
    )


def _last(done: "subprocess.CompletedProcess[bytes]") -> str:
    lines = done.stderr.decode(errors="replace").strip().splitlines()
    return f": {lines[-1]}" if lines else ""


def answer() -> None:
    """Read a request from standard input, run it, and write the outcomes to standard output."""
    request = sys.stdin.buffer.read()
    with print_aside():
        outcomes = _outcomes(request)
    sys.stdout.buffer.write(pickle.dumps(outcomes))
    sys.stdout.flush()
    # Without the interpreter's farewell, where libraries and threads of a planner may hang.
    os._exit(0)


def _outcomes(request: bytes) -> dict[str, Any] | None:
    """By the name of the scene; None if the planner is not found here."""
    for plugin in named_plugins():
        # The one that is asked for is missed below; the others are nobody's business here.
        with contextlib.suppress(Exception, SystemExit):
            plugin.load()
    try:
        planner_class, settings, names = pickle.loads(request)
    except Exception:  # the import of other people's code may raise anything
        return None
    subject = Subject(planner_class, settings)
    return {scene.name: subject.trial(scene).outcome for scene in subject.on(*names)}
