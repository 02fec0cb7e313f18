"""The contract of one planner, checked in a process of its own: it may hang or crash there.

The process tells of each rule before it begins it. If it then hangs, dies or exits, that rule is
broken, and the rules after it stay unlooked at: they would meet the same.
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
from suite.conformance.rules import RULES, apply, claim_of, rule_name
from suite.conformance.rules_of.other_processes import same_path_in_another_process
from suite.conformance.rules_of.runs import warms_up
from suite.conformance.subject import Rule, Subject
from suite.errors import PluginError
from suite.plugins.discovery import load_planner, planner_names
from suite.plugins.settings import make_settings
from suite.processes.family import REAP_S, kill_family

LIMIT_S = 30.0
"""What one rule may take, seconds: fifty times what it takes with a planner that is quick."""

WARM_UP_S = 300.0
"""What it may take to import a planner and warm it up, compilation included, as in a matrix."""

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
    receiver, sender = _CONTEXT.Pipe(duplex=False)
    process = _CONTEXT.Process(target=_examine, args=(planner, settings or {}, sender))
    process.start()
    try:
        with receiver:
            sender.close()
            return _collected(process, receiver, planner, limit_s)
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


def _examine(planner: str, settings: Mapping[str, Any], sender: "Connection[Any, None]") -> None:
    """Send the number of each rule, the label of each run, and then the rule's result."""
    os.setsid()
    os.dup2(2, 1)  # standard output is the report's
    try:
        planner_class = load_planner(planner)
        made = make_settings(planner_class, settings)
    except PluginError as error:
        sender.send(error)
        return
    subject = Subject(planner_class, made, on_run=sender.send)
    for number, rule in enumerate(RULES):
        sender.send(number)
        sender.send(apply(rule, subject))
    sender.send(DONE)
    # Without the interpreter's farewell, where libraries and threads of a planner may hang.
    os._exit(0)


def _collected(
    process: Any, receiver: "Connection[None, Any]", planner: str, limit_s: float
) -> list[Result]:
    results: list[Result] = []
    doing, label = LOADING, ""
    while True:
        patience_s = limit_s if _is_warm(doing) else WARM_UP_S
        lost = None if receiver.poll(patience_s) else _late(patience_s)
        try:
            message: Any = None if lost else receiver.recv()
        except (EOFError, OSError):
            lost = _died(process)
        if lost is not None and label:
            lost = replace(lost, found=f"{label}: {lost.found}")
        if lost is not None:
            if doing == LOADING:
                raise PluginError(f"planner '{planner}': while it was imported, {lost.found}.")
            return [*results, *_ended(doing, lost)]
        if isinstance(message, PluginError):
            raise message
        if message == DONE:
            return results
        if isinstance(message, Result):
            results.append(message)
        elif isinstance(message, int):
            doing, label = message, ""
        else:
            label = message


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


def _ended(number: int, finding: Finding) -> list[Result]:
    """The rule that was not survived, and those after it."""
    first, *others = RULES[number:]
    name = rule_name(first)
    return [
        Result(name, claim_of(first), Kind.BROKEN, finding),
        *(_unlooked_at(rule, f"mend {name} first.") for rule in others),
    ]


def _unlooked_at(rule: Rule, reason: str) -> Result:
    return Result(rule_name(rule), claim_of(rule), Kind.NOT_APPLICABLE, reason=reason)
