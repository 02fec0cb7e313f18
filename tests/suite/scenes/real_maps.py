"""The public maps beside the checkout, and a reader of the one that is a mesh."""

from functools import lru_cache
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon, box

from suite.scenes.scene import Scene, make_scene

FOLDER = Path(__file__).resolve().parents[4] / "shared" / "maps"
MISSING = not FOLDER.is_dir()
REASON = "the public maps are not there: ../shared/maps beside the checkout"


def queries(name: str) -> NDArray[np.float64]:
    """Rows of a .scen file: start x, start y, goal x, goal y, optimal length."""
    rows = (FOLDER / f"{name}.scen").read_text().splitlines()[1:]
    return np.array([line.split()[4:9] for line in rows if line.strip()], dtype=np.float64)


@lru_cache(maxsize=1)
def mesh_scene(name: str) -> Scene:
    """The free cells of a polygon mesh (v3) as a scene: what lies between them is obstacle."""
    lines = (FOLDER / name).read_text().splitlines()
    vertex_count, cell_count = map(int, lines[2].split())
    xy = np.array([line.split() for line in lines[3 : 3 + vertex_count]], dtype=np.float64)
    cells = []
    for line in lines[3 + vertex_count : 3 + vertex_count + cell_count]:
        traversable, n, *numbers = map(int, line.split())
        if traversable:
            cells.append(Polygon(xy[np.array(numbers[:n]) - 1]))
    free = shapely.union_all(cells)
    room = box(*free.bounds)
    start, goal = np.split(queries(name)[0, :4], 2)
    return make_scene(name, room, _solids(room.difference(free)), {"main": (start, goal)})


def _solids(geometry: shapely.Geometry) -> list[Polygon]:
    parts = shapely.get_parts(geometry)
    return [p for p in parts if isinstance(p, Polygon) and p.area > 0.0]
