"""A scene as it was planned in, as a document: what a store keeps of it, and a worker is sent.

The document is the scene's GeoJSON (:mod:`suite.scenes.geojson`), compressed, and any GIS tool
reads what is in it. Reading it back checks, cuts and grows nothing: each coordinate is what it was,
and so are the hash and the arrangement, bit for bit, whatever importers and modifiers do by then.
A member ``kept`` of the collection has what a scene file does not say: the radius that the
obstacles are grown by already, what blocks queries, their strata, and the scene's hash.
"""

import hashlib
import json
import zlib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from shapely.geometry import Polygon

from suite.errors import SceneError
from suite.scenes.dynamics import parse_dynamics
from suite.scenes.geojson import as_geojson
from suite.scenes.scene import Obstacle, Query, Scene

SUFFIX = ".kept"
"""Of a document that lies in a file: no suffix of maps or scene files, which are checked."""

LEVEL = 6
"""Of zlib: 9 takes twice as long, or ten times, for 1 % at the most (measured on six scenes)."""

_Points = dict[str, dict[str, list[float]]]


def pack_scene(scene: Scene) -> bytes:
    """A scene as a document.

    Parameters
    ----------
    scene : Scene
        Static or dynamic, grown or not.
    """
    queries = scene.queries
    kept = {
        "hash": scene.hash,
        "radius": scene.radius,
        "blocked": {q.name: q.blocked for q in queries if q.blocked is not None},
        "strata": {q.name: q.stratum for q in queries if q.stratum is not None},
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
    crs = {"crs": collection["crs"]} if "crs" in collection else {}
    kept = collection["kept"]
    (workspace,) = rooms
    return Scene(
        name=collection["name"],
        workspace=workspace,
        obstacles=tuple(obstacles),
        queries=tuple(_query(name, ends, kept) for name in ends["start"]),
        properties=MappingProxyType(collection["properties"] | crs),
        radius=kept["radius"],
    )


def _polygon(feature: Mapping[str, Any]) -> Polygon:
    """A polygon of exactly these coordinates."""
    shell, *holes = feature["geometry"]["coordinates"]
    return Polygon(shell, holes)


def _query(name: str, ends: _Points, kept: Mapping[str, Any]) -> Query:
    start, goal = (np.array(ends[role][name], dtype=np.float64) for role in ("start", "goal"))
    for point in (start, goal):
        point.setflags(write=False)
    return Query(name, start, goal, kept["blocked"].get(name), kept["strata"].get(name))
