"""What there is: scenes, planners and matrices, as plain data for people and programs."""

from typing import Any

from suite.harness.matrix import load_matrix, matrix_file, matrix_names
from suite.plugins import available_planners
from suite.scenes.catalogue import load_scene, scene_file, scene_names


def scenes_listing() -> list[dict[str, Any]]:
    """Each scene of the catalogue: name, path, obstacles, vertices, parts, optimum (m), figure."""
    rows = []
    for name in scene_names():
        scene = load_scene(name)
        rows.append(
            {
                "name": name,
                "obstacles": len(scene.obstacles),
                "vertices": scene.vertex_count,
                "parts": scene.part_count,
                "optimum": scene.stored_optimum(scene.query()),
                "queries": [query.name for query in scene.queries],
                "figure": scene.properties.get("figure"),
                "path": str(scene_file(name)),
            }
        )
    return rows


def planners_listing() -> list[dict[str, Any]]:
    """Each installed planner: name, package and version, whether it can be loaded, abilities."""
    rows: list[dict[str, Any]] = []
    for plugin in available_planners():
        can = plugin.abilities
        rows.append(
            {
                "name": plugin.name,
                "distribution": plugin.distribution,
                "version": plugin.version,
                "available": plugin.available,
                "reason": plugin.reason,
                "anytime": can and can.anytime,
                "deterministic": can and can.deterministic,
                "exact": can and can.exact,
                "budgets": sorted(can.budgets) if can else [],
            }
        )
    return rows


def matrices_listing() -> list[dict[str, Any]]:
    """Each matrix of the catalogue: name, numbers of scenes, planners, seeds and runs, path."""
    rows = []
    for name in matrix_names():
        matrix = load_matrix(name)
        rows.append(
            {
                "name": name,
                "description": matrix.description,
                "scenes": len(matrix.scenes),
                "planners": len(matrix.variants),
                "seeds": len(matrix.seeds),
                "runs": len(matrix.cells()),
                "path": str(matrix_file(name)),
            }
        )
    return rows
