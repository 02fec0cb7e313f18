"""The hostile planners as a distribution that is installed like anyone's, and their scene."""

import importlib
import inspect
import shutil
import sys
from pathlib import Path

import shapely

from suite.scenes.geojson import write_scene
from suite.scenes.scene import make_scene

PLANNERS = Path(__file__).parent / "hostile_planners.py"


def make_site(site: Path) -> Path:
    """Fill a folder with the planners and their metadata, as an installer would leave it."""
    shutil.copy(PLANNERS, site / "hostile_planners.py")
    (site / "broken_planner.py").write_text("import no_such_module\n")
    info = site / "hostile-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: hostile\nVersion: 1.0\n")
    sys.path.insert(0, str(site))
    try:
        module = importlib.import_module("hostile_planners")
    finally:
        sys.path.remove(str(site))
    planners = {
        found.name: kind
        for kind, found in inspect.getmembers(module, inspect.isclass)
        if found.__module__ == "hostile_planners" and hasattr(found, "name")
    }
    lines = [f"{name} = hostile_planners:{kind}" for name, kind in planners.items()]
    lines.append("broken = broken_planner:Broken")
    (info / "entry_points.txt").write_text("[kbga_bench.planners]\n" + "\n".join(lines) + "\n")
    return site


def write_wall(file: Path) -> None:
    """Write a scene with a wall between start and goal."""
    scene = make_scene(
        "wall",
        shapely.box(0, 0, 10, 10),
        [shapely.box(4, 0, 6, 7)],
        {"main": ((1, 3), (9, 3))},
    )
    write_scene(scene, file)
