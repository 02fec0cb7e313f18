"""Settings of OMPL's planners: what OMPL has a setter for, and what the adapter adds."""

from collections.abc import Callable
from dataclasses import Field, dataclass, field, fields
from typing import Any, NamedTuple, Protocol


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
A_PART = Rule(lambda value: 0 < value <= 1, "be above 0, and 1 at the most: it is a share")


class Lengths(Protocol):
    """What the lengths among the settings are measured by."""

    @property
    def unit(self) -> float:
        """Metres that are 1 in OMPL's coordinates."""

    @property
    def side(self) -> float:
        """Of free space around the query, metres; see :func:`baselines.units.free_side`."""


def bound(setter: str, rule: Rule | None = None, *, is_length: bool = False) -> Any:
    """Declare a setting that OMPL's planner has a setter for; None leaves OMPL's own default.

    A length is in metres, and handed over in OMPL's coordinates.
    """
    return field(default=None, metadata={"setter": setter, "rule": rule, "is_length": is_length})


def share_of_side(instead_of: str, setter: str | None = None) -> Any:
    """Declare a length as a share of the side of free space, in place of one in metres.

    On maps of all sizes metres mean nothing. Both together are refused.

    Parameters
    ----------
    instead_of : str
        Name of the setting in metres.
    setter : str, optional
        Of OMPL's planner; without one the adapter itself makes use of it.
    """
    metadata: dict[str, Any] = {"rule": A_PART, "instead_of": instead_of}
    return field(default=None, metadata=metadata | ({"setter": setter} if setter else {}))


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
            metres = setting.metadata.get("instead_of")
            if value is not None and metres and getattr(self, metres) is not None:
                raise ValueError(
                    f"{metres} is {getattr(self, metres)} and {setting.name} is {value}: they say "
                    f"the same. Give {metres}, in metres, or {setting.name}, a share of the longer "
                    "side of free space, and not both."
                )


@dataclass(frozen=True, slots=True)
class RangeSettings(OmplSettings):
    """Settings of any planner of OMPL that extends a tree; None leaves OMPL's default.

    range : longest edge that extends a tree, metres.
    range_share : the same as a share of the longer side of the box around the part of free space
        that the query lies in (:func:`baselines.units.free_side`); in place of ``range``.
    """

    range: float | None = bound("setRange", ABOVE_0, is_length=True)
    range_share: float | None = share_of_side("range", "setRange")


def apply(settings: OmplSettings, planner: Any, lengths: Lengths) -> None:
    """Hand OMPL's planner the settings that are not None, lengths in its own coordinates."""
    for setting in fields(settings):
        value = getattr(settings, setting.name)
        if value is not None and "setter" in setting.metadata:
            getattr(planner, setting.metadata["setter"])(_in_units(value, setting, lengths))


def _in_units(value: Any, setting: Field[Any], lengths: Lengths) -> Any:
    if "instead_of" in setting.metadata:
        return value * lengths.side / lengths.unit
    return value / lengths.unit if setting.metadata["is_length"] else value
