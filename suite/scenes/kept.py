"""A scene as it was planned in, as a document: what a store keeps of it, and a worker is sent.

The document is the scene's GeoJSON (:mod:`suite.scenes.geojson`), compressed, and any GIS tool
reads what is in it. Reading it back checks, cuts and grows nothing: each coordinate is what it was,
and so are the hash and the arrangement, bit for bit, whatever importers and modifiers do by then.
A member ``kept`` of the collection has all else that a scene says: the radius that the obstacles
are grown by already, what blocks queries, their strata, and its hash.
"""

import hashlib
import json
import zlib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from shapely.geometry import Polygon

from suite.errors import SceneError
from suite.scenes.dynamics import parse_dynamics
from suite.scenes.geojson import as_geojson
from suite.scenes.scene import Obstacle, Query, Scene
from suite.typed import plain

SUFFIX = ".kept"
"""Of a document that lies in a file: no suffix of maps or scene files, which are checked."""

LEVEL = 6
"""Of zlib: 9 takes twice as long, or ten times, for 1 % at the most (measured on six scenes)."""

_DRAWN = ("name", "workspace", "obstacles", "queries", "properties")
"""What the features and the members of the collection say of a scene."""

_ENDS = ("name", "start", "goal")
"""And of a query."""

_Points = dict[str, dict[str, list[float]]]


def pack_scene(scene: Scene) -> bytes:
    """A scene as a document.

    Parameters
    ----------
    scene : Scene
        Static or dynamic, grown or not.
    """
    queries = {query.name: _others(query, _ENDS) for query in scene.queries}
    kept = {
        "hash": scene.hash,
        "scene": _others(scene, (*_DRAWN, "path")),
        "queries": {name: others for name, others in queries.items() if others},
        "properties": list(scene.properties),
    }
    return zlib.compress(as_geojson(scene, {"kept": kept}).encode(), LEVEL)


def unpack_scene(document: bytes, where: str) -> Scene:
    """The scene of a document, the same to the bit but for the file that it was read from.

    Parameters
    ----------
    document : bytes
        As :func:`pack_scene` made it.
    where : str
        What holds it, for errors.

    Raises
    ------
    SceneError
        If it is damaged.
    """
    try:
        collection = json.loads(zlib.decompress(document))
        scene = _scene(collection)
        wanted = collection["kept"]["hash"]
    except (zlib.error, ValueError, KeyError, TypeError, AttributeError, SceneError) as error:
        raise SceneError(f"{where}: the scene that it keeps can't be read ({error}).") from error
    if scene.hash != wanted:
        raise SceneError(f"{where}: the scene that it keeps as {scene.name} is damaged.")
    return scene


def text_of(document: bytes) -> str:
    """The GeoJSON in a document."""
    return zlib.decompress(document).decode()


def digest_of(document: bytes) -> str:
    """Hash of what is in a document: 32 hexadecimal digits, whatever compressed it."""
    return hashlib.sha256(zlib.decompress(document)).hexdigest()[:32]


def read_kept(path: Path) -> Scene:
    """The scene of a document in a file.

    Raises
    ------
    SceneError
        If it can't be read.
    """
    try:
        document = path.read_bytes()
    except OSError as error:
        raise SceneError(f"{path}: can't be read ({error.strerror}).") from error
    return unpack_scene(document, str(path))


def _scene(collection: Mapping[str, Any]) -> Scene:
    rooms: list[Polygon] = []
    obstacles: list[Obstacle] = []
    ends: _Points = {"start": {}, "goal": {}}
    for feature in collection["features"]:
        own, role = feature["properties"], feature["properties"]["role"]
        if role == "workspace":
            rooms.append(_polygon(feature))
        elif role == "obstacle":
            obstacles.append(Obstacle(own["name"], _polygon(feature), parse_dynamics(own)))
        else:
            ends[role][own["query"]] = feature["geometry"]["coordinates"]
    kept = collection["kept"]
    crs = {"crs": collection["crs"]} if "crs" in collection else {}
    properties = collection["properties"] | crs
    (workspace,) = rooms
    return Scene(
        name=collection["name"],
        workspace=workspace,
        obstacles=tuple(obstacles),
        queries=tuple(_query(name, ends, kept) for name in ends["start"]),
        properties=MappingProxyType({name: properties[name] for name in kept["properties"]}),
        **_as_they_were(kept["scene"]),
    )


def _polygon(feature: Mapping[str, Any]) -> Polygon:
    """A polygon of exactly these coordinates."""
    shell, *holes = feature["geometry"]["coordinates"]
    return Polygon(shell, holes)


def _query(name: str, ends: _Points, kept: Mapping[str, Any]) -> Query:
    start, goal = (np.array(ends[role][name], dtype=np.float64) for role in ("start", "goal"))
    for point in (start, goal):
        point.setflags(write=False)
    return Query(name, start, goal, **_as_they_were(kept["queries"].get(name, {})))


def _others(value: Scene | Query, left_out: tuple[str, ...]) -> dict[str, Any]:
    """The fields of a value but some, where they are not what they are by default, as plain data.

    Whatever field is added is kept so, and what was kept before it has its default.
    """
    given = {f.name: (getattr(value, f.name), f.default) for f in fields(value)}
    return {
        name: plain(own)
        for name, (own, default) in given.items()
        if name not in left_out and own != default
    }


def _as_they_were(others: Mapping[str, Any]) -> dict[str, Any]:
    """The same, read back: JSON has lists for tuples."""
    return {name: tuple(v) if isinstance(v, list) else v for name, v in others.items()}
