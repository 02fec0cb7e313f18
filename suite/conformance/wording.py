"""What came of all rules, for people and for programs."""

from collections.abc import Sequence
from typing import Any

from suite.conformance.finding import Kind, Result

WIDTH = 10


def broken(results: Sequence[Result]) -> list[Result]:
    """The rules that are broken; warnings are not among them."""
    return [result for result in results if result.kind is Kind.BROKEN]


def as_data(planner: str, results: Sequence[Result]) -> dict[str, Any]:
    """All results as plain data for JSON; ``kept`` says whether no rule is broken."""
    return {
        "planner": planner,
        "kept": not broken(results),
        "rules": [
            {
                "rule": result.rule,
                "claim": result.claim,
                "result": str(result.kind),
                "reason": result.reason,
                "found": result.finding and result.finding.found,
                "expected": result.finding and result.finding.expected,
                "mend": result.finding and result.finding.mend,
            }
            for result in results
        ],
    }


def as_text(planner: str, results: Sequence[Result]) -> str:
    """A line for each rule; more for those that are broken."""
    lines = [_line(result) for result in results]
    return "\n".join([*lines, "", summary(planner, results)])


def _line(result: Result) -> str:
    words = {
        Kind.KEPT: "kept",
        Kind.BROKEN: "BROKEN",
        Kind.WARNING: "WARNING",
        Kind.NOT_TESTED: "not tested",
    }
    head = f"{words.get(result.kind, '-'):{WIDTH - 1}} {result.rule}"
    if result.reason is not None:
        return f"{head}: {result.reason}"
    if result.finding is None:
        return head
    finding = result.finding
    told = (("rule", result.claim), ("found", finding.found), ("expected", finding.expected))
    texts = [*told, ("mend", finding.mend)]
    return "\n".join([head, *(f"{'':{WIDTH}}  {word:10}{_indented(t)}" for word, t in texts)])


def _indented(text: str) -> str:
    return text.replace("\n", "\n" + " " * (2 * WIDTH + 2))


def summary(planner: str, results: Sequence[Result]) -> str:
    """One line: how many rules are broken, and how many say nothing of it."""
    count = {kind: sum(result.kind is kind for result in results) for kind in Kind}
    applied = len(results) - count[Kind.NOT_APPLICABLE] - count[Kind.NOT_TESTED]
    others = f", {count[Kind.NOT_APPLICABLE]} do not apply" if count[Kind.NOT_APPLICABLE] else ""
    others += f", {count[Kind.NOT_TESTED]} not tested" if count[Kind.NOT_TESTED] else ""
    warned = f", {count[Kind.WARNING]} warning" if count[Kind.WARNING] else ""
    if count[Kind.BROKEN]:
        return f"{planner}: {count[Kind.BROKEN]} of {applied} rules broken{warned}{others}."
    return f"{planner}: keeps the contract, {applied} rules{warned}{others}."
