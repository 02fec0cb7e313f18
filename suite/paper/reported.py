"""The figures that Hu and Yang report, as data: what the tables put beside ours.

They are written down in ``reported.toml``, statement by statement, contradictions included.
"""

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

FILE = Path(__file__).parent / "reported.toml"

KBGA = "kbga"
PLAIN_GA = "plain-ga"
WITHOUT_CROSSOVER_AND_MUTATION = "kbga-without-crossover-and-mutation"
"""The three algorithms of the paper, under the names of our variants that answer them."""

KBGA_PLUS = "kbga-plus"
"""Ours, which the paper says nothing of: it is shown beside, and never gets a verdict."""

RUNS = 20
"""Of the paper, where it speaks of none: as for its other figures."""

UNITS = {"cost": "m", "generations": "", "time_s": "s", "reaction_s": "s", "success": ""}
"""Quantities that the paper reports, and their units here."""


@dataclass(frozen=True, slots=True)
class Reported:
    """One figure.

    source : where the paper states it.
    scene : the environment, under our name; None for parameters.
    planner : the algorithm, under the name of our variant.
    quantity : cost, generations, time_s, reaction_s, success, or the name of a setting.
    statistic : mean, sd (over ``runs`` runs), single (one run), best (the best one of ``runs``),
        initial (best of the first population), or setting.
    value : float
    unit : of the value, if it has one.
    runs : int, or None if the paper does not say.
    setting : what was set apart from the paper's defaults.
    note : what else the paper says of it.
    """

    source: str
    scene: str | None
    planner: str
    quantity: str
    statistic: str
    value: float
    unit: str
    runs: int | None
    setting: Mapping[str, float] = field(default_factory=dict, hash=False)
    note: str = ""


@cache
def reported() -> tuple[Reported, ...]:
    """All figures, in the order of the paper.

    Examples
    --------
    >>> [(r.source, r.value) for r in find(scene="zigzag", planner="kbga", quantity="cost",
    ...                                    statistic="sd")]
    [('section III-B', 1.99), ('Table 1', 0.47)]
    """
    statements = tomllib.loads(FILE.read_text(encoding="utf-8"))["statement"]
    return tuple(figure for statement in statements for figure in _figures(statement))


def find(**wanted: Any) -> list[Reported]:
    """The figures whose fields have these values."""
    return [r for r in reported() if all(getattr(r, k) == v for k, v in wanted.items())]


def best_reported(scene: str | None) -> float | None:
    """The lowest cost that the paper reports on a scene, metres: our drawing is calibrated to it.

    Examples
    --------
    >>> best_reported("clustered"), best_reported("obstacles_20")
    (160.5, None)
    """
    costs = [r.value for r in find(scene=scene, planner=KBGA, quantity="cost", statistic="single")]
    return min(costs, default=None)


def spread_of(figure: Reported) -> float | None:
    """The standard deviation that the paper states at the same place, if it does."""
    place = ("source", "scene", "planner", "quantity", "setting")
    same = find(statistic="sd", **{name: getattr(figure, name) for name in place})
    return same[0].value if same else None


def _figures(statement: Mapping[str, Any]) -> Iterator[Reported]:
    setting = statement.get("setting", {})
    quantities = {name: statement[name] for name in UNITS if name in statement}
    # A statement of nothing but settings reports these.
    quantities = quantities or {name: {"setting": value} for name, value in setting.items()}
    for quantity, values in quantities.items():
        for statistic, value in values.items():
            yield Reported(
                source=statement["source"],
                scene=statement.get("scene"),
                planner=statement["planner"],
                quantity=quantity,
                statistic=statistic,
                value=float(value),
                unit=UNITS.get(quantity, ""),
                runs=statement.get("runs"),
                setting=setting,
                note=statement.get("note", ""),
            )
