"""What a rule of the contract says of a planner: what was found, what was expected, how to mend."""

from dataclasses import dataclass
from enum import StrEnum


@dataclass(frozen=True, slots=True)
class Finding:
    """A rule is broken.

    found, expected, mend : one sentence each.
    """

    found: str
    expected: str
    mend: str


@dataclass(frozen=True, slots=True)
class NotApplicable:
    """A rule says nothing of this planner.

    reason : why, in one sentence.
    """

    reason: str


@dataclass(frozen=True, slots=True)
class NotTested:
    """Nothing could be found out.

    reason : why, in one sentence.
    """

    reason: str


Answer = Finding | NotApplicable | NotTested | None
"""What a rule says of a planner; None if it is kept."""


class Kind(StrEnum):
    """What came of a rule, in a word."""

    KEPT = "kept"
    BROKEN = "broken"
    WARNING = "warning"
    NOT_APPLICABLE = "not applicable"
    NOT_TESTED = "not tested"


@dataclass(frozen=True, slots=True)
class Result:
    """One rule, applied to one planner.

    rule : its name.
    claim : what it asks, in one sentence.
    finding : if it is broken, or a warning.
    reason : why it does not apply, or was not tested; of one that is kept, where it was not tested.
    """

    rule: str
    claim: str
    kind: Kind
    finding: Finding | None = None
    reason: str | None = None
