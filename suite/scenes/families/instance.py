"""The families, and an instance of each from a seed: drawn, turned, shifted, proved solvable."""

import re
from collections.abc import Mapping
from dataclasses import asdict
from typing import Protocol, Self
from zlib import crc32

import numpy as np

from suite.errors import SceneError
from suite.scenes.exact import shortest_path
from suite.scenes.families.bug_trap import BugTrap
from suite.scenes.families.city import City
from suite.scenes.families.clutter import Clutter
from suite.scenes.families.draft import ROOM, Draft
from suite.scenes.families.forest import Forest
from suite.scenes.families.maze import Maze
from suite.scenes.families.narrow import Narrow
from suite.scenes.families.office import Office
from suite.scenes.families.rooms_with_clutter import RoomsWithClutter
from suite.scenes.families.scattering import Scattering
from suite.scenes.families.spiral import Spiral
from suite.scenes.families.zigzag import Zigzag
from suite.scenes.modifiers import parse_modifiers
from suite.scenes.reach import no_way
from suite.scenes.scene import DEFAULT_QUERY, Scene, make_scene, renamed
from suite.scenes.similarity import modified

TRIES = 100
"""Drafts for one seed; of most families the first is solvable."""

LEAST_DETOUR = 1.001
"""Optimum over straight line: where nothing is in the way, there is nothing to plan."""


class Family(Protocol):
    """Parameters of a generator, which draws as many instances as there are seeds."""

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> Self:
        """Parameters at random, from the range that the family is made of."""

    def draft(self, rng: np.random.Generator) -> Draft:
        """Draw an instance."""


FAMILIES: Mapping[str, type[Family]] = {
    "scattered": Scattering,
    "maze": Maze,
    "office": Office,
    "zigzag": Zigzag,
    "bug_trap": BugTrap,
    "spiral": Spiral,
    "narrow": Narrow,
    "forest": Forest,
    "city": City,
    "clutter": Clutter,
    "rooms_with_clutter": RoomsWithClutter,
}

_NAME = re.compile(rf"({'|'.join(FAMILIES)})-([0-9]{{1,20}})")


def parse_family_name(name: str) -> tuple[str, int] | None:
    """Family and seed in the name of an instance; None if it is another name.

    Examples
    --------
    >>> parse_family_name("maze-1003"), parse_family_name("maze"), parse_family_name("moving-3")
    (('maze', 1003), None, None)
    """
    found = _NAME.fullmatch(name)
    return None if found is None else (found[1], int(found[2]))


def instance(family: str, seed: int) -> Scene:
    """An instance of a family: the same for the same seed on any machine.

    Parameters
    ----------
    family : one of :data:`FAMILIES`.
    seed : 0 or more. Of everything that is random: parameters, draft, turn and shift.

    Returns
    -------
    Scene
        In a room of 100 m x 100 m, turned by any angle and shifted, so that no lattice of a planner
        fits its walls. Its properties name the parameters and the exact optimum.

    Raises
    ------
    SceneError
        If there is no such family, or no instance of that seed can be solved.

    Examples
    --------
    >>> scene = instance("maze", 3)
    >>> scene.name, scene.properties["family"], len(scene.queries)
    ('maze-3', 'maze', 1)
    """
    if family not in FAMILIES or seed < 0:
        raise SceneError(
            f"family '{family}', seed {seed}: give one of {', '.join(FAMILIES)}, and 0 or more."
        )
    rng = np.random.default_rng([seed, crc32(family.encode())])
    for _ in range(TRIES):
        made = _solvable(family, seed, rng)
        if made is not None:
            return made
    raise SceneError(f"{family}-{seed}: none of {TRIES} drafts can be solved. Take another seed.")


def _solvable(family: str, seed: int, rng: np.random.Generator) -> Scene | None:
    """A draft as a scene; None where there is no way, or nothing in the way."""
    parameters = FAMILIES[family].drawn(rng)
    draft = parameters.draft(rng)
    turn, dx, dy = rng.uniform(0.0, 360.0), *rng.uniform(-1.0, 1.0, 2)
    name = f"{family}-{seed}"
    drawn = make_scene(
        name, ROOM, draft.obstacles, {DEFAULT_QUERY: (draft.start, draft.goal)}, keep_blocked=True
    )
    if drawn.query().blocked is not None or no_way(drawn, drawn.query()) is not None:
        return None
    where = parse_modifiers(f"turn={turn:.6f},shift={dx:.6f}:{dy:.6f}", name)
    scene = modified(drawn, where)
    query = scene.query()
    optimum = shortest_path(scene, query).length
    if not optimum >= LEAST_DETOUR * float(np.hypot(*(query.goal - query.start))):
        return None
    return renamed(scene, name, _properties(family, seed, parameters, optimum))


def _properties(family: str, seed: int, parameters: Family, optimum: float) -> dict[str, object]:
    kind = type(parameters)
    described = (kind.__doc__ or "").partition("\n")[0]
    return {
        "description": described,
        "generated": True,
        "generator": "family",
        "family": family,
        "seed": seed,
        "parameters": asdict(parameters),  # type: ignore[call-overload]
        "optimum": {DEFAULT_QUERY: optimum},
    }
