"""Scene files: a planar GeoJSON FeatureCollection, read and written.

The format
----------
Coordinates are metres in the plane, x right, y up; no projection applies. Each feature has
``properties.role``:

``workspace``
    One Polygon: where the robot may be. A hole in it is an obstacle.
``obstacle``
    Polygon or MultiPolygon, convex or concave, with holes if need be; they may touch and overlap.
    ``properties.name`` is optional and unique. Without the properties below it is static; with any
    of them it is part of a dynamic scene, and the polygon is where it is drawn, not where it is.
``start``, ``goal``
    A Point each. Several pairs make several queries: ``properties.query`` names the pair
    (default ``main``). ``properties.stratum`` of a start is the query's stratum. What a start says
    as ``properties.blocked`` is why the query can't be asked, as the suite wrote it: queries of
    such a file whose ends are not free are kept, and refused when they are asked; those of any
    other file are an error.

Properties of an obstacle that changes over time (seconds from the start of a run, metres):

``motion``
    ``{"waypoints": [[t, dx, dy], ...]}``: it is moved by (dx, dy) from where it is drawn at the
    time t, along straight lines at constant speed between the waypoints, and rests before the first
    and after the last. ``{"velocity": [vx, vy], "start": t0, "stop": t1}`` is short for a line
    (``start`` is 0 if left out).
``detection``
    ``{"range": r}``: it is there, but unknown until the robot is within r metres of its edge at an
    update. ``{}`` takes the sensing range of the robot.
``removal``
    ``{"time": t}``, or ``{"place": [x, y], "distance": d}``: it vanishes at the time, or as soon as
    the robot is within d metres of the place; of both, at what comes first.
``appears``
    A time, before which it is not there.

Members of the collection that the suite reads: ``name`` (default: the file's name); ``crs``
(default: metres in the plane; one that is not known to be that is refused, see
:mod:`suite.scenes.crs`) and ``properties``, an object of which it knows ``description``,
``figure``, ``paper_best``, ``reconstruction`` and ``optimum`` (from query name to exact optimal
length, metres: what the file says of itself, for a reader; results are measured by the one that is
computed), ``radius`` (of the robot, metres: obstacles grow by it when the file is read) and
``grown_by`` (such a radius by which they have grown already); of a dynamic scene also ``world``,
the default settings of its simulation (see :class:`suite.simulation.settings.WorldSettings`), and
``gates``, from a name to a segment ``[[x, y], [x, y]]`` across an opening, so that a run can say
which one the robot passed. Others are kept. Any JSON, GIS or shapely tool reads the file.

Whatever may be left out may be null, as geopandas writes it, and names may be empty, as QGIS does.
"""

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from shapely.geometry import Polygon, mapping

from suite.errors import SceneError, check_file, writing
from suite.geometry.tolerances import LARGEST
from suite.scenes.crs import check_crs
from suite.scenes.dynamics import Length, Pair, as_properties, parse_dynamics
from suite.scenes.modifiers import SUFFIXES
from suite.scenes.scene import DEFAULT_QUERY, Obstacle, Scene, make_scene
from suite.typed import MisfitError, shown, typed

ROLES = ("workspace", "obstacle", "start", "goal")

LONGEST_NAME = 200
"""Characters: names stand in tables, file names and errors."""

_LINE = re.compile(rf"[^\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff]{{1,{LONGEST_NAME}}}")
"""No control characters, no ends of lines, nothing that UTF-8 can't hold."""

_READ = ("optimum", "world", "gates", "radius", "grown_by")
"""Properties of the collection that are read, and may be null for being left out."""


def read_scene(path: Path, *, inflate: float | None = None, keep_blocked: bool = False) -> Scene:
    """Read a scene file.

    Parameters
    ----------
    path : Path
        A GeoJSON file in the format of this module.
    inflate : float, optional
        Radius of the robot, metres; see :func:`suite.scenes.scene.make_scene`. Default: the one
        that the file states, or none.
    keep_blocked : bool
        Keep queries whose ends are not free; see there.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        If the file can't be read or its scene can't be used. The message says where and why.
    """
    where = path.name
    document = _load(path)
    if document.get("type") != "FeatureCollection":
        raise SceneError(
            f"{where}: its type is {shown(document.get('type'))}, not 'FeatureCollection'. "
            "Put workspace, obstacles, start and goal into one FeatureCollection."
        )
    features = document.get("features")
    if not isinstance(features, list):
        raise SceneError(f"{where}: 'features' is missing or no list.")
    name = _name(where, "the collection", document.get("name"), path.stem)
    properties = _properties(where, document)
    radius, grown_by = (_length(where, properties, key) for key in ("radius", "grown_by"))
    workspaces: list[Polygon] = []
    obstacles: list[Obstacle] = []
    ends: dict[str, dict[str, Any]] = {"start": {}, "goal": {}}
    strata: dict[str, str] = {}
    may_be_blocked = False
    for number, feature in enumerate(features, 1):
        role, own, geometry = _feature(where, number, feature)
        if role == "workspace":
            workspaces += _polygons(where, f"feature {number} (workspace)", geometry)
        elif role == "obstacle":
            obstacles += _obstacle(where, number, len(obstacles) + 1, own, geometry)
        else:
            query = _name(where, f"feature {number}, query", own.get("query"), DEFAULT_QUERY)
            if query in ends[role]:
                raise SceneError(
                    f"{where}, feature {number}: query '{query}' has two points of role '{role}'. "
                    "Name the queries apart with properties.query."
                )
            ends[role][query] = _point(where, number, role, geometry)
            if role == "start" and own.get("stratum") is not None:
                strata[query] = _name(where, f"feature {number}, stratum", own["stratum"], "")
            may_be_blocked |= own.get("blocked") is not None
    if len(workspaces) != 1:
        raise SceneError(
            f"{where}: {len(workspaces)} workspaces. Give one Polygon of role 'workspace'."
        )
    return make_scene(
        name,
        workspaces[0],
        obstacles,
        _paired(where, ends["start"], ends["goal"]),
        properties=properties,
        path=path,
        inflate=radius if inflate is None else inflate,
        strata=strata,
        keep_blocked=keep_blocked or may_be_blocked,
        grown_by=grown_by,
    )


def stated_radius(path: Path) -> float:
    """The radius of the robot that a scene file states, metres; 0 if it states none.

    Raises
    ------
    SceneError
        If the file can't be read.
    """
    return _length(path.name, _properties(path.name, _load(path)), "radius")


def _length(where: str, properties: dict[str, Any], key: str) -> float:
    """Take a length out of the properties, metres; 0 if it is not there."""
    given = properties.pop(key, 0.0)
    try:
        return typed(given, Length)
    except MisfitError as error:
        raise SceneError(
            f"{where}: its property '{key}' is {shown(given)}. Give the robot's, in metres, "
            "or leave it out."
        ) from error


def _load(path: Path) -> dict[str, Any]:
    try:
        text = path.read_text(encoding="utf-8-sig")  # a byte order mark says nothing of UTF-8
    except OSError as error:
        raise SceneError(f"{path}: can't be read ({error.strerror}).") from error
    except UnicodeDecodeError as error:
        raise SceneError(f"{path.name}: is not UTF-8 text (byte {error.start}).") from error
    try:
        document = json.loads(text)
    except json.JSONDecodeError as error:
        raise SceneError(
            f"{path.name}, line {error.lineno}, column {error.colno}: not JSON ({error.msg})."
        ) from error
    except (ValueError, RecursionError) as error:  # numbers too long, or nested too deep
        raise SceneError(f"{path.name}: can't be read as JSON ({error}).") from error
    if not isinstance(document, dict):
        raise SceneError(f"{path.name}: holds no JSON object. A scene is a FeatureCollection.")
    return document


def _name(where: str, what: str, given: Any, default: str) -> str:
    """A name that is given, or the default for one that is left out, null or empty."""
    if given is None or given == "":
        return default
    # A table of names of which some are missing holds whole numbers as 1.0.
    name = str(given) if isinstance(given, str | int | float) else ""
    if isinstance(given, bool) or given != given or not _LINE.fullmatch(name):
        raise SceneError(
            f"{where}, {what}: its name is {shown(given)}. "
            f"Give a text of one line and at most {LONGEST_NAME} characters."
        )
    return name


def _properties(where: str, document: Mapping[str, Any]) -> dict[str, Any]:
    """What the collection says of itself, with its crs, as :func:`write_scene` takes it."""
    given = document.get("properties")
    if not isinstance(given, dict | None):
        raise SceneError(f"{where}: its properties are {shown(given)}. Give an object.")
    own = {key: v for key, v in (given or {}).items() if v is not None or key not in _READ}
    if "crs" in own:
        raise SceneError(f"{where}: its properties have a crs. Make it a member of the collection.")
    try:
        check_crs(document.get("crs"))
        _check_optimum(own.get("optimum", {}))
        _check_gates(own.get("gates", {}))
    except SceneError as error:
        raise SceneError(f"{where}: {error}") from error
    return own if document.get("crs") is None else own | {"crs": document["crs"]}


def _check_optimum(optima: Any) -> None:
    mend = 'Give {"QUERY": metres}, or leave it out: it is computed.'
    if not isinstance(optima, dict):
        raise SceneError(f"its property 'optimum' is {shown(optima)}. {mend}")
    for query, length in optima.items():
        try:
            if length is not None:
                typed(length, Length)
        except MisfitError as error:
            raise SceneError(
                f"its property 'optimum' of {shown(query)} is {shown(length)}. {mend}"
            ) from error


def _check_gates(gates: Any) -> None:
    if not isinstance(gates, dict):
        raise SceneError(f"its property 'gates' is {shown(gates)}. Give an object of segments.")
    for name, gate in gates.items():
        try:
            typed(gate, tuple[Pair, Pair])
        except MisfitError as error:
            raise SceneError(
                f"its gate {shown(name)} is {shown(gate)}. Give a segment [[x, y], [x, y]]."
            ) from error


def _feature(where: str, number: int, feature: Any) -> tuple[str, Mapping[str, Any], Any]:
    if not isinstance(feature, dict) or feature.get("type") != "Feature":
        raise SceneError(f"{where}, feature {number}: is no GeoJSON Feature.")
    properties = feature.get("properties")
    properties = properties if isinstance(properties, dict) else {}
    role = properties.get("role")
    if role not in ROLES:
        problem = "has no role" if role is None else f"has the unknown role {shown(role)}"
        raise SceneError(
            f"{where}, feature {number}: {problem}. "
            f"Set properties.role to one of {', '.join(ROLES)}."
        )
    return role, properties, feature.get("geometry")


def _obstacle(
    where: str, number: int, count: int, properties: Mapping[str, Any], geometry: Any
) -> list[Obstacle]:
    name = _name(where, f"feature {number}", properties.get("name"), f"obstacle {count}")
    polygons = _polygons(where, name, geometry)
    try:
        dynamics = parse_dynamics(properties)
    except SceneError as error:
        raise SceneError(f"{where}, {name}: {error}") from error
    if len(polygons) == 1:
        return [Obstacle(name, polygons[0], dynamics)]
    return [Obstacle(f"{name}, polygon {i}", p, dynamics) for i, p in enumerate(polygons, 1)]


def _polygons(where: str, what: str, geometry: Any) -> list[Polygon]:
    kind = geometry.get("type") if isinstance(geometry, dict) else None
    if kind not in ("Polygon", "MultiPolygon"):
        raise SceneError(f"{where}, {what}: its geometry is {shown(kind)}; give a Polygon.")
    members = geometry.get("coordinates")
    members = [members] if kind == "Polygon" else members
    if not isinstance(members, list) or not members:
        raise SceneError(f"{where}, {what}: its coordinates are missing.")
    return [_polygon(where, what, rings) for rings in members]


def _polygon(where: str, what: str, rings: Any) -> Polygon:
    if not isinstance(rings, list) or not rings:
        raise SceneError(f"{where}, {what}: its coordinates are missing.")
    closed = [_ring(where, what, ring) for ring in rings]
    return Polygon(closed[0], closed[1:])


def _ring(where: str, what: str, ring: Any) -> list[tuple[float, float]]:
    if not isinstance(ring, list):
        raise SceneError(f"{where}, {what}: a ring is no list of [x, y].")
    points = [_xy(where, f"{what}, vertex {i}", point) for i, point in enumerate(ring, 1)]
    if len(set(points)) < 3:
        raise SceneError(
            f"{where}, {what}: only {len(set(points))} different vertices. A ring needs three."
        )
    return points


def _xy(where: str, what: str, point: Any) -> tuple[float, float]:
    numbers = point[:2] if isinstance(point, list) else []
    if len(numbers) != 2 or any(
        isinstance(v, bool) or not isinstance(v, int | float) for v in numbers
    ):
        raise SceneError(f"{where}, {what}: {shown(point)} is not [x, y].")
    x, y = numbers
    if not (abs(x) <= LARGEST and abs(y) <= LARGEST):  # so written, NaN is refused too
        raise SceneError(
            f"{where}, {what}: {shown(point)}. "
            f"Coordinates must be finite numbers, in metres, up to {LARGEST:g}."
        )
    return float(x) + 0.0, float(y) + 0.0


def _point(where: str, number: int, role: str, geometry: Any) -> tuple[float, float]:
    kind = geometry.get("type") if isinstance(geometry, dict) else None
    if kind != "Point":
        raise SceneError(
            f"{where}, feature {number} ({role}): its geometry is {shown(kind)}; give a Point."
        )
    return _xy(where, f"feature {number} ({role})", geometry.get("coordinates"))


def _paired(
    where: str, starts: Mapping[str, Any], goals: Mapping[str, Any]
) -> dict[str, tuple[Any, Any]]:
    for name in (*starts, *goals):
        for role, points in (("start", starts), ("goal", goals)):
            if name not in points:
                raise SceneError(
                    f"{where}: query '{name}' has no {role}. Add a Point of that role."
                )
    return {name: (starts[name], goals[name]) for name in starts}


def check_scene_file(path: Path) -> None:
    """Refuse a file that a scene can't be written to, before any is made for it.

    Raises
    ------
    SceneError
        If its suffix is not that of a scene file, or its folder is missing.
    """
    check_file(path, "scene files", SUFFIXES, SceneError)


def write_scene(scene: Scene, path: Path) -> None:
    """Write a scene as GeoJSON, one feature a line, in the format of this module.

    Raises
    ------
    SceneError
        If the file can't be written.
    """
    with writing(path, SceneError):
        path.write_text(as_geojson(scene), encoding="utf-8")


def as_geojson(scene: Scene, members: Mapping[str, Any] | None = None) -> str:
    """A scene as the text of a file, one feature a line, with every coordinate to the last bit.

    Parameters
    ----------
    scene : Scene
    members : mapping, optional
        Further ones of the collection.
    """
    features = [_as_feature({"role": "workspace"}, mapping(scene.workspace))]
    features += [
        _as_feature(
            {"role": "obstacle", "name": o.name, **as_properties(o.dynamics)}, mapping(o.polygon)
        )
        for o in scene.obstacles
    ]
    for query in scene.queries:
        of_start = {"stratum": query.stratum, "blocked": query.blocked}
        own = {key: value for key, value in of_start.items() if value is not None}
        for role, point, more in (("start", query.start, own), ("goal", query.goal, {})):
            geometry = {"type": "Point", "coordinates": point.tolist()}
            features.append(_as_feature({"role": role, "query": query.name, **more}, geometry))
    lines = ",\n".join(json.dumps(f) for f in features)
    # As it is: whoever reads it is not to grow it again.
    properties = dict(scene.properties) | ({"grown_by": scene.radius} if scene.radius else {})
    crs = {"crs": properties.pop("crs")} if "crs" in properties else {}
    head = json.dumps(
        {"name": scene.name, **crs, "properties": properties, **(members or {})}, indent=1
    )
    return f'{head[:-2]},\n "type": "FeatureCollection",\n "features": [\n{lines}\n]}}\n'


def _as_feature(properties: Mapping[str, Any], geometry: Mapping[str, Any]) -> dict[str, Any]:
    return {"type": "Feature", "properties": dict(properties), "geometry": dict(geometry)}
