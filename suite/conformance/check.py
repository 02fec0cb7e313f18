"""The contract of one planner, checked in a process of its own: it may hang or crash there.

The process tells of each rule and each run before it begins. If it then hangs, dies or exits, that
rule is broken, and another process goes on: without the scene, if the run was one that most rules
look at. What then remains unlooked at is called not tested.
"""

import multiprocessing
import os
import signal
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from multiprocessing.connection import Connection
from typing import Any

from suite.conformance import wording
from suite.conformance.finding import Finding, Kind, Result
from suite.conformance.rules import FIRST, RULES, apply, claim_of, rule_name
from suite.conformance.rules_of.other_processes import same_path_in_another_process
from suite.conformance.rules_of.runs import warms_up
from suite.conformance.subject import Rule, Subject
from suite.errors import PluginError, sentence
from suite.plugins.discovery import load_planner, planner_names
from suite.plugins.settings import make_settings
from suite.processes.family import REAP_S, kill_family

LIMIT_S = 30.0
"""What one rule may take, seconds: fifty times what it takes with a planner that is quick."""

WARM_UP_S = 300.0
"""What it may take to import a planner and warm it up, compilation included, as in a matrix."""

MOST_LOSSES = 4
"""Processes that may be lost: whoever hangs everywhere takes LIMIT_S for each."""

LOADING = -1
"""The plugin is imported; the rules are counted from 0."""

DONE = "done"

_CONTEXT = multiprocessing.get_context("spawn")


def check(
    planner: str, settings: Mapping[str, Any] | None = None, limit_s: float = LIMIT_S
) -> list[Result]:
    """Apply all rules of the contract to an installed planner, or one named by ``--plugin``.

    Parameters
    ----------
    planner : str
        Its name.
    settings : mapping, optional
        As :func:`suite.plugins.discovery.make_settings` takes them.
    limit_s : float
        What each rule may take, seconds; what comes before the first run may take WARM_UP_S.

    Returns
    -------
    list of Result
        In the order of RULES.

    Raises
    ------
    PluginError
        If there is no planner of that name, it can't be loaded, or it does not take the settings.
    """
    if planner not in planner_names():
        load_planner(planner)  # raises, and says which there are
    results: list[Result] = []
    without: set[str] = set()
    losses: dict[int, Finding] = {}
    for attempt in range(1, MOST_LOSSES + 1):
        lost = _attempt(planner, settings or {}, limit_s, results, losses, frozenset(without))
        if lost is None:
            return results
        number, rule = len(results), RULES[len(results)]
        found = losses.setdefault(number, lost.finding)
        if rule in FIRST:
            return [*results, _broken(rule, found), *_untested(number + 1, rule)]
        if attempt == MOST_LOSSES:
            break
        if lost.scene is not None:
            without.add(lost.scene)  # the same rule once more, on the other scenes
        else:
            results.append(_broken(rule, found))
    return [*results, _broken(rule, found), *_untested(number + 1, rule)]


@dataclass(frozen=True, slots=True)
class _Loss:
    """The process of the rules is gone.

    finding : how.
    scene : the small scene of the run that ended it, if its budget was an ordinary one.
    """

    finding: Finding
    scene: str | None


def _attempt(
    planner: str,
    settings: Mapping[str, Any],
    limit_s: float,
    results: list[Result],
    losses: Mapping[int, Finding],
    without: frozenset[str],
) -> _Loss | None:
    """Apply the rules that have no result yet, in a new process; what comes is put to the others.

    A rule that has ended a process before is broken, whatever it says of the other scenes.
    """
    receiver, sender = _CONTEXT.Pipe(duplex=False)
    arguments = (planner, settings, sender, len(results), without)
    process = _CONTEXT.Process(target=_examine, args=arguments)
    process.start()
    try:
        with receiver:
            sender.close()
            return _collected(process, receiver, planner, limit_s, results, losses)
    finally:
        kill_family(process.pid or 0)
        process.join(REAP_S)


@dataclass(frozen=True, slots=True)
class Checked:
    """What came of one planner of several.

    results : as :func:`check` returns them; none if it is unavailable.
    unavailable : why nothing could be checked.
    """

    planner: str
    results: Sequence[Result] = ()
    unavailable: str | None = None

    @property
    def kept(self) -> bool | None:
        """Whether no rule is broken; None if it is unavailable."""
        return None if self.unavailable is not None else not wording.broken(self.results)

    @property
    def line(self) -> str:
        """What came of it in a line."""
        return self.unavailable or wording.summary(self.planner, self.results)

    @property
    def as_data(self) -> dict[str, Any]:
        """All of it as plain data."""
        told = wording.as_data(self.planner, self.results)
        return {**told, "kept": self.kept, "unavailable": self.unavailable}


def check_each(planners: Sequence[str], limit_s: float = LIMIT_S) -> Iterator[Checked]:
    """Check several planners with their own settings, one after the other.

    Parameters
    ----------
    planners : sequence of str
        Their names.
    limit_s : float
        As in :func:`check`.

    Raises
    ------
    PluginError
        If there is no planner of one of the names, before any is checked. One that can't be
        loaded stops nobody else.
    """
    for planner in set(planners) - set(planner_names()):
        load_planner(planner)  # raises, and says which there are
    for planner in dict.fromkeys(planners):
        try:
            yield Checked(planner, check(planner, limit_s=limit_s))
        except PluginError as error:
            yield Checked(planner, unavailable=str(error))


def _examine(
    planner: str,
    settings: Mapping[str, Any],
    sender: "Connection[Any, None]",
    first: int,
    without: frozenset[str],
) -> None:
    """Send the number of each rule, each run, and then the rule's result."""
    os.setsid()
    os.dup2(2, 1)  # standard output is the report's
    try:
        planner_class = load_planner(planner)
        made = make_settings(planner_class, settings)
    except PluginError as error:
        sender.send(error)
        return
    subject = Subject(planner_class, made, sender.send, without)
    if first > RULES.index(warms_up):
        _ = subject.warm_up  # before the first rule, whose time is short
    for number, rule in enumerate(RULES[first:], first):
        sender.send(number)
        sender.send(apply(rule, subject))
    sender.send(DONE)
    # Without the interpreter's farewell, where libraries and threads of a planner may hang.
    os._exit(0)


def _collected(
    process: Any,
    receiver: "Connection[None, Any]",
    planner: str,
    limit_s: float,
    results: list[Result],
    losses: Mapping[int, Finding],
) -> _Loss | None:
    doing, run = LOADING, None
    while True:
        patience_s = limit_s if _is_warm(doing) else WARM_UP_S
        lost = None if receiver.poll(patience_s) else _late(patience_s)
        try:
            message: Any = None if lost else receiver.recv()
        except (EOFError, OSError):
            lost = _died(process)
        if lost is not None and doing == LOADING and not results:
            how = sentence(lost.found)
            raise PluginError(f"planner '{planner}': while it was imported, {how}")
        if lost is not None and run is not None:
            found = replace(lost, found=f"{run.label}: {lost.found}")
            return _Loss(found, run.scene if run.ordinary else None)
        if lost is not None:
            return _Loss(lost, None)
        if isinstance(message, PluginError):
            raise message
        if message == DONE:
            return None
        if isinstance(message, Result):
            loss = losses.get(len(results))
            results.append(_broken(RULES[len(results)], loss) if loss else message)
        elif isinstance(message, int):
            doing, run = message, None
        else:
            run = message


def _is_warm(doing: int) -> bool:
    """Whether all is compiled that will be; another process begins anew."""
    return doing > RULES.index(warms_up) and RULES[doing] is not same_path_in_another_process


def _late(patience_s: float) -> Finding:
    return Finding(
        f"it did not end within {patience_s:g} s, and was killed",
        "runs of a fraction of a second: the scenes are small, and so are the budgets",
        "End when the budget is spent: look at it in every loop that may last. Without a budget, "
        "end by a criterion of your own, or refuse.",
    )


def _died(process: Any) -> Finding:
    process.join(REAP_S)
    code = process.exitcode or 0
    how = f"signal {signal.Signals(-code).name}" if code < 0 else f"exit code {code}"
    return Finding(
        f"its process died with {how}",
        "a process that lives on",
        "Run it under `python -X faulthandler`; look for os._exit, and for libraries that crash.",
    )


def _broken(rule: Rule, finding: Finding) -> Result:
    return Result(rule_name(rule), claim_of(rule), Kind.BROKEN, finding)


def _untested(first: int, lost: Rule) -> list[Result]:
    """The rules from a number on, of which nothing can be said after one that was not survived."""
    reason = f"mend {rule_name(lost)} first."
    return [
        Result(rule_name(rule), claim_of(rule), Kind.NOT_TESTED, reason=reason)
        for rule in RULES[first:]
    ]
