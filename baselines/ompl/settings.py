"""Settings of OMPL's planners: what OMPL has a setter for, and what the adapter adds."""

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple


class Rule(NamedTuple):
    """What a setting must be.

    holds : whether a value keeps the rule.
    words : the rule, to be read after "It must".
    """

    holds: Callable[[Any], bool]
    words: str


ABOVE_0 = Rule(lambda value: value > 0, "be above 0")
AT_LEAST_1 = Rule(lambda value: value >= 1, "be 1 or more")
A_SHARE = Rule(lambda value: 0 <= value <= 1, "lie between 0 and 1")


def bound(setter: str, rule: Rule | None = None, *, is_length: bool = False) -> Any:
    """Declare a setting that OMPL's planner has a setter for; None leaves OMPL's own default.

    A length is in metres, and handed over in OMPL's coordinates.
    """
    return field(default=None, metadata={"setter": setter, "rule": rule, "is_length": is_length})


def ours(default: float | None, rule: Rule | None = None) -> Any:
    """Declare a setting of the adapter, which OMPL does not know."""
    return field(default=default, metadata={"rule": rule})


@dataclass(frozen=True, slots=True)
class OmplSettings:
    """Settings of any OMPL planner.

    default_wall_s : seconds of wall time of a run whose budget sets no limit; the choice is ours.
    """

    default_wall_s: float = ours(1.0, ABOVE_0)

    def __post_init__(self) -> None:
        for setting in fields(self):
            value, rule = getattr(self, setting.name), setting.metadata.get("rule")
            if value is not None and rule is not None and not rule.holds(value):
                raise ValueError(f"{setting.name} is {value}. It must {rule.words}.")


def apply(settings: OmplSettings, planner: Any, unit: float) -> None:
    """Hand OMPL's planner the settings that are not None; ``unit`` metres are 1 to it."""
    for setting in fields(settings):
        value = getattr(settings, setting.name)
        if value is not None and "setter" in setting.metadata:
            scaled = value / unit if setting.metadata["is_length"] else value
            getattr(planner, setting.metadata["setter"])(scaled)
