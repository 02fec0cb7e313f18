"""The hostile planners as a distribution that is installed like anyone's, and their scene."""

import importlib
import inspect
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

import shapely

from suite.scenes.geojson import write_scene
from suite.scenes.scene import make_scene

PLANNERS = Path(__file__).parent / "hostile"


def make_site(site: Path) -> Path:
    """Fill a folder with the planners and their metadata, as an installer would leave it."""
    shutil.copytree(PLANNERS, site / "hostile", ignore=shutil.ignore_patterns("__pycache__"))
    (site / "broken_planner.py").write_text("import no_such_module\n")
    info = site / "hostile-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: hostile\nVersion: 1.0\n")
    sys.path.insert(0, str(site))
    try:
        lines = [
            f"{found.name} = {found.__module__}:{kind}"
            for module in _modules()
            for kind, found in inspect.getmembers(module, inspect.isclass)
            if found.__module__ == module.__name__ and hasattr(found, "name")
        ]
    finally:
        sys.path.remove(str(site))
    lines.append("broken = broken_planner:Broken")
    (info / "entry_points.txt").write_text("[kbga_bench.planners]\n" + "\n".join(lines) + "\n")
    return site


def _modules() -> Iterator[ModuleType]:
    for file in PLANNERS.glob("[!_]*.py"):
        yield importlib.import_module(f"hostile.{file.stem}")


def write_wall(file: Path) -> None:
    """Write a scene with a wall between start and goal."""
    scene = make_scene(
        "wall",
        shapely.box(0, 0, 10, 10),
        [shapely.box(4, 0, 6, 7)],
        {"main": ((1, 3), (9, 3))},
    )
    write_scene(scene, file)
