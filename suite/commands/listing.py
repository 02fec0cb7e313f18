"""What there is: scenes, planners and matrices, as plain data for people and programs.

Each list imports what it needs by itself: of the matrices it takes no library but the reader.
"""

from typing import Any


def scenes_listing() -> list[dict[str, Any]]:
    """Each scene of the catalogue: name, obstacles, vertices, parts, optimum (m), figure, path.

    Dynamic ones are listed as they are drawn; their optimum changes as they do.
    Of generated scenes it says what their names say: to draw them all takes seconds.
    Controls come last: scenes as they were once drawn, with corners on many lattices.
    """
    from suite.scenes.catalogue import aligned_names, dynamic_names, generated_names, scene_names
    from suite.scenes.moving import parse_moving_name
    from suite.scenes.scattered import parse_scattered_name

    rows = [_listed(name) for name in (*scene_names(), *dynamic_names())]
    controls = [_listed(name) for name in aligned_names()]
    for name in generated_names():
        parts, _ = parse_scattered_name(name) or (None, None)
        is_dynamic = parse_moving_name(name) is not None
        known = {"name": name, "parts": parts, "generated": True, "dynamic": is_dynamic}
        rows.append(dict.fromkeys(rows[0]) | known | {"control": False})
    return rows + controls


def _listed(name: str) -> dict[str, Any]:
    """A scene of the catalogue that is a file."""
    from suite.scenes.catalogue import aligned_names, load_scene, scene_file

    scene = load_scene(name)
    return {
        "name": name,
        "obstacles": len(scene.obstacles),
        "vertices": scene.vertex_count,
        "parts": scene.part_count,
        "optimum": scene.stored_optimum(scene.query()),
        "queries": [query.name for query in scene.queries],
        "figure": scene.properties.get("figure"),
        "generated": False,
        "dynamic": scene.is_dynamic,
        "control": name in aligned_names(),
        "path": str(scene_file(name)),
    }


def scene_for_people(row: dict[str, Any]) -> dict[str, Any]:
    """One of :func:`scenes_listing` in few columns: paths are too long for a line."""
    # Each of them has the one query "main".
    chosen = ("name", "obstacles", "parts", "optimum", "figure")
    kinds = [kind for kind in ("generated", "dynamic", "control") if row[kind]]
    return {name: row[name] for name in chosen} | {"kind": kinds}


def planners_listing() -> list[dict[str, Any]]:
    """Each installed planner: name, package and version, whether it can be loaded, abilities."""
    from suite.plugins.discovery import available_planners

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
                "population": can and can.population,
                "budgets": sorted(can.budgets) if can else [],
            }
        )
    return rows


def planner_for_people(row: dict[str, Any]) -> dict[str, Any]:
    """One of :func:`planners_listing` in few columns."""
    abilities = [name for name in ("anytime", "deterministic", "exact", "population") if row[name]]
    return {
        "name": row["name"],
        # Without the hash of its code, which is for programs.
        "from": " ".join([row["distribution"], *_words_but_hashes(row["version"])]),
        "abilities": abilities if row["available"] else row["reason"],
        "budgets": row["budgets"],
    }


def _words_but_hashes(version: str) -> list[str]:
    return [word for word in version.split() if not word.startswith("sha256-")]


def matrix_for_people(row: dict[str, Any]) -> dict[str, Any]:
    """One of :func:`matrices_listing` without its path."""
    return {name: value for name, value in row.items() if name != "path"}


def matrices_listing() -> list[dict[str, Any]]:
    """Each matrix of the catalogue: name, numbers of scenes, planners, seeds and runs, path."""
    from suite.harness.matrix_file import matrix_file, matrix_names, outline

    return [
        {"name": name, **outline(name), "path": str(matrix_file(name))} for name in matrix_names()
    ]
