"""SVG drawings: what is painted is obstacle, as one sees it.

Taken are paths, polygons, polylines, rectangles, circles, ellipses and lines, in groups and by
``use``, with their transforms: the inside of what is filled, by its fill rule, and the strokes, as
wide as they are drawn (a dashed one as if it were not). Paint that is white is no obstacle, and
where it is opaque it hides what was painted before, as the floor of a room does; other paint counts
if it is darker than the threshold: 1 is black, and the default anything that is not white. What has
neither fill nor stroke is not there, nor is what is hidden. Text and images are left out with a
warning. Masks and clip paths are not applied, with a warning: what they cut off is obstacle all the
same, and white that they cut hides nothing, so that an obstacle is rather larger.

The workspace is the page: the viewBox, without one width and height, without either the box of all
that is painted. A unit of the viewBox is a metre (the modifier scale makes it another length), the
lower left corner of the page is (0, 0), and y is up, so that the map is not mirrored. Curves become
chords: by them an outline is off by no more than a 10,000th of the page's larger side.
"""

import io
import math
import re
import warnings
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal
from xml.etree import ElementTree

import numpy as np
import shapely
import svgelements
from numpy.typing import NDArray
from shapely.geometry import LinearRing, LineString, MultiPolygon, Polygon
from shapely.geometry.base import BaseGeometry

from suite.errors import SceneError
from suite.geometry.tolerances import LARGEST
from suite.scenes.maps.curves import Line, lines_of
from suite.scenes.maps.drawing import Drawing
from suite.scenes.maps.fill import filled
from suite.scenes.maps.options import MapOptions
from suite.scenes.maps.polygons import drawing_of, solids
from suite.scenes.maps.text import one_line
from suite.scenes.scene import SceneWarning

FLATNESS = 1e-4
"""By how much a chord may be off its curve, as a share of the page's larger side."""

PIXELS_PER_INCH = 96.0
PIXELS = {
    "": 1.0,
    "px": 1.0,
    "in": PIXELS_PER_INCH,
    "cm": PIXELS_PER_INCH / 2.54,
    "mm": PIXELS_PER_INCH / 25.4,
    "pt": PIXELS_PER_INCH / 72.0,
    "pc": PIXELS_PER_INCH / 6.0,
}
"""Of CSS: a page without viewBox that is 100 mm wide has 378 units."""

_LENGTH = re.compile(rf"([0-9]*\.?[0-9]+(?:[eE][-+]?[0-9]{{1,2}})?)({'|'.join(PIXELS)})")

DARKEST_FLOOR = 1e-3
"""Share of black up to which paint is white: less than a 255th, which a screen can show."""

NAMESPACE = "{http://www.w3.org/2000/svg}"

_TEMPLATES = ("symbol", "marker", "mask")
"""Elements whose content is shown only where another one refers to it."""

_CAPS: dict[str, Literal["flat", "round", "square"]] = {
    "butt": "flat",
    "round": "round",
    "square": "square",
}
_JOINS: dict[str, Literal["mitre", "round", "bevel"]] = {
    "miter": "mitre",
    "round": "round",
    "bevel": "bevel",
}


_CUTS = ("clip-path", "mask")
"""Attributes, and properties of styles, by which less of an element is shown than is drawn."""


@dataclass(frozen=True, slots=True)
class Page:
    """What is shown of the plane of a drawing, in its units, y down.

    x, y : its upper left corner, (0, 0) if it is named. width, height : above 0.
    """

    x: float
    y: float
    width: float
    height: float

    @property
    def tolerance(self) -> float:
        """By how much an outline may be off."""
        return FLATNESS * max(self.width, self.height)

    def metres(self, xy: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (n, 2) from its lower left corner, y up."""
        return np.column_stack([xy[:, 0] - self.x, self.y + self.height - xy[:, 1]])


@dataclass(frozen=True, slots=True)
class Painted:
    """A shape, and whether it or a group that it lies in is clipped or masked."""

    shape: Any
    is_cut: bool


def read_svg(path: Path, options: MapOptions) -> Drawing:
    """Read a drawing, of which each thing that is painted is an obstacle, cut at the page.

    Raises
    ------
    SceneError
        If it is no SVG, or nothing is painted on its page.
    """
    root = _root(path)
    page = _page(path, root)
    shapes = _shapes(path, root)
    page = page or _box(path, shapes)
    room = shapely.box(0.0, 0.0, page.width, page.height)
    floor = DARKEST_FLOOR if options.threshold is None else options.threshold
    painted: list[BaseGeometry] = []
    for one in shapes:
        for area, dark in _areas(path, one.shape, page, floor):
            if dark:
                painted.append(area)
            elif not one.is_cut:
                painted = [below.difference(area) for below in painted]
    obstacles = tuple(p for area in painted for p in solids(area.intersection(room)))
    if not obstacles:
        raise SceneError(
            f"{path.name}: nothing on its page is painted darker than {floor:g} of black. "
            "Give its obstacles a fill or a stroke, or name a lower threshold."
        )
    return drawing_of(room, obstacles, simplify=options.simplify, properties={"format": "SVG"})


def _root(path: Path) -> ElementTree.Element:
    try:
        root = ElementTree.fromstring(path.read_bytes())
    except OSError as error:
        raise SceneError(f"{path.name}: can't be read ({error.strerror}).") from error
    except (ElementTree.ParseError, ValueError, LookupError) as error:  # an encoding unknown
        raise SceneError(f"{path.name}: no XML ({one_line(error)}).") from error
    if _tag(root) != "svg":
        raise SceneError(f"{path.name}: its root is {_tag(root)[:40]!r}, not 'svg'.")
    return root


def _tag(element: ElementTree.Element) -> str:
    return str(element.tag).removeprefix(NAMESPACE)


def _page(path: Path, root: ElementTree.Element) -> Page | None:
    """The page that a drawing names; None if it names none."""
    size = [root.attrib.pop(key, "").strip() for key in ("width", "height")]
    box = root.attrib.pop("viewBox", "").replace(",", " ").split()
    if not box and all(size) and not any(length.endswith("%") for length in size):
        box = ["0", "0", *(str(_pixels(path, length)) for length in size)]
    if not box:
        return None
    try:
        x, y, width, height = (float(number) for number in box)
    except ValueError as error:
        raise SceneError(
            f"{path.name}: its viewBox is {' '.join(box)[:60]!r}. It is four numbers: x, y, width, "
            "height."
        ) from error
    is_near = abs(x) <= LARGEST and abs(y) <= LARGEST
    if not (is_near and 0.0 < width <= LARGEST and 0.0 < height <= LARGEST):
        raise SceneError(f"{path.name}: its page is {width:g} by {height:g}. Give it some size.")
    # So that a unit stays one; of pages without viewBox svgelements swaps width and height.
    root.set("viewBox", f"{x!r} {y!r} {width!r} {height!r}")
    root.attrib |= {"width": repr(width), "height": repr(height)}
    return Page(0.0, 0.0, width, height)


def _pixels(path: Path, length: str) -> float:
    found = _LENGTH.fullmatch(length)
    if found is None:
        raise SceneError(f"{path.name}: {length[:40]!r} is no length. Write it like 80mm.")
    return float(found[1]) * PIXELS[found[2]]


def _shapes(path: Path, root: ElementTree.Element) -> list[Painted]:
    """All that is painted, in turn, each with its own transform."""
    _put_templates_away(path, root)
    text = io.BytesIO(ElementTree.tostring(root))
    try:
        drawing = svgelements.SVG.parse(text, reify=False, ppi=PIXELS_PER_INCH)
        elements = list(_elements(drawing))
    except RecursionError as error:
        raise SceneError(f"{path.name}: an element uses itself, or lies too deep.") from error
    # The library checks no attribute: one that is broken ends in whatever it meets first.
    except Exception as error:
        raise SceneError(f"{path.name}: an attribute can't be read ({one_line(error)}).") from error
    left_out = Counter(
        type(e.shape).__name__.lower() + "s"
        for e in elements
        if isinstance(e.shape, svgelements.Text | svgelements.Image)
    )
    if left_out:
        told = " and ".join(f"{count} {kind}" for kind, count in sorted(left_out.items()))
        warnings.warn(
            f"{path.name}: {told} left out. Turn them into paths if they are obstacles.",
            SceneWarning,
            stacklevel=3,
        )
    shapes = [
        e for e in elements if isinstance(e.shape, svgelements.Shape) and _is_visible(e.shape)
    ]
    cut = sum(e.is_cut for e in shapes)
    if cut:
        warnings.warn(
            f"{path.name}: {cut} of {len(shapes)} shapes are clipped or masked, which is not "
            "applied: all of a dark one is an obstacle, and a white one hides nothing. Cut them in "
            "a drawing program (Inkscape: Object, Clip, Release; then Path, Intersection).",
            SceneWarning,
            stacklevel=3,
        )
    return shapes


def _elements(element: Any, *, is_cut: bool = False) -> Iterator[Painted]:
    """An element and all that lies in it, in turn."""
    # What a group is clipped by, its elements do not know.
    is_cut = is_cut or any(element.values.get(by) not in (None, "", "none") for by in _CUTS)
    yield Painted(element, is_cut)
    if isinstance(element, list):
        for child in element:
            yield from _elements(child, is_cut=is_cut)


def _put_templates_away(path: Path, root: ElementTree.Element) -> None:
    """Make definitions of templates, of which svgelements knows none."""
    for parent in list(root.iter()):
        for i, child in enumerate(parent):
            if _tag(child) not in _TEMPLATES:
                continue
            if _tag(child) == "symbol" and "viewBox" in child.attrib:
                raise SceneError(
                    f"{path.name}: the symbol {child.get('id', '')[:40]!r} has a viewBox, which is "
                    "not applied. Unlink its clones (Inkscape: Edit, Clone, Unlink)."
                )
            child.tag = f"{NAMESPACE}g"
            parent[i] = ElementTree.Element(f"{NAMESPACE}defs")
            parent[i].append(child)


def _is_visible(shape: Any) -> bool:
    return shape.values.get("visibility", "visible") not in ("hidden", "collapse")


def _box(path: Path, shapes: list[Painted]) -> Page:
    """The page of a drawing that names none: as large as what is on it."""
    boxes = [one.shape.bbox(with_stroke=True) for one in shapes]
    found = np.array([box for box in boxes if box is not None], dtype=np.float64).reshape(-1, 4)
    if not found.size or not np.isfinite(found).all():
        raise SceneError(f"{path.name}: has no page, and nothing is painted. Give it a viewBox.")
    (x, y), (right, bottom) = found[:, :2].min(axis=0), found[:, 2:].max(axis=0)
    if right <= x or bottom <= y:
        raise SceneError(f"{path.name}: what is painted has no area. Give it a viewBox.")
    return Page(float(x), float(y), float(right - x), float(bottom - y))


def _areas(path: Path, shape: Any, page: Page, floor: float) -> Iterator[tuple[BaseGeometry, bool]]:
    """What the fill and the stroke of a shape cover, metres, and whether each is dark."""
    m = shape.transform
    linear, shift = np.array([[m.a, m.c], [m.b, m.d]], dtype=np.float64), np.array([m.e, m.f])
    stretch = float(np.linalg.norm(linear, 2)) if np.isfinite(linear).all() else 0.0
    if not stretch > 0.0:  # scaled to nothing: it is not shown
        return
    tolerance = page.tolerance / stretch
    try:
        lines = lines_of(shape.segments(transformed=False), tolerance)
        paints = _paint(shape.fill, shape), _paint(shape.stroke, shape)
        width = float(shape.stroke_width or 0.0)
    except Exception as error:  # as above
        raise SceneError(
            f"{path.name}{_named(shape)}: can't be read ({one_line(error)})."
        ) from error
    if not all(np.abs(line.points @ linear.T + shift).max() <= LARGEST for line in lines):
        raise SceneError(f"{path.name}{_named(shape)}: lies too far off, beyond {LARGEST:g}.")

    def placed(area: BaseGeometry) -> BaseGeometry:
        return shapely.transform(area, lambda xy: page.metres(xy @ linear.T + shift))

    (fill, fill_opacity), (stroke, stroke_opacity) = paints
    rings = [line.points for line in lines]
    evenodd = shape.values.get("fill-rule") == "evenodd"
    inside = filled(rings, evenodd=evenodd) if fill_opacity else MultiPolygon()
    band = _band(shape, lines, width, tolerance) if stroke_opacity and width > 0.0 else Polygon()
    is_filled, is_stroked = (dark > 0.0 and dark >= floor for dark in (fill, stroke))
    if is_filled and is_stroked:
        yield placed(inside.union(band)), True
        return
    if is_filled or fill_opacity >= 1.0:
        yield placed(inside), is_filled
    if is_stroked or stroke_opacity >= 1.0:
        yield placed(band), is_stroked


def _named(shape: Any) -> str:
    return f", {str(shape.id)[:40]!r}" if shape.id else ""


def _paint(colour: Any, shape: Any) -> tuple[float, float]:
    """How dark paint is on white, 0 to 1, and how opaque; both 0 if there is none."""
    if colour is None or colour.value is None:
        return 0.0, 0.0
    own = float(shape.values.get("opacity", 1.0))
    opacity = min(1.0, max(0.0, own)) * colour.alpha / 255.0
    luminance = (0.2126 * colour.red + 0.7152 * colour.green + 0.0722 * colour.blue) / 255.0
    return (1.0 - luminance) * opacity, opacity


def _band(shape: Any, lines: list[Line], width: float, tolerance: float) -> BaseGeometry:
    """What a stroke covers, before the shape is transformed."""
    style = shape.values
    cap = _CAPS.get(style.get("stroke-linecap", "butt"), "flat")
    join = _JOINS.get(style.get("stroke-linejoin", "miter"), "mitre")
    try:
        limit = max(1.0, float(style.get("stroke-miterlimit", 4.0)))
    except ValueError:
        limit = 4.0
    paths = [
        LinearRing(line.points) if line.closed and len(line.points) > 2 else LineString(line.points)
        for line in lines
    ]
    # Chords of a circle of radius r that are off by no more than t span 2 acos(1 - t / r).
    angle = 2.0 * math.acos(max(0.0, 1.0 - tolerance / (0.5 * width)))
    bands = shapely.buffer(
        paths,
        0.5 * width,
        quad_segs=max(1, math.ceil(0.5 * math.pi / angle)),
        cap_style=cap,
        join_style=join,
        mitre_limit=limit,
    )
    return shapely.union_all(bands)
