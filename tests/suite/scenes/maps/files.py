"""Small maps, written to be read."""

from pathlib import Path

import numpy as np
from PIL import Image

GRID = ["..@@......", ".T.@..WW..", ".......W..", "@@@..S....", "....G..@@."]
"""Of Moving AI, five rows; the upper left cell is (0, 0)."""

QUERIES = [(0, (0, 0), (9, 0), 11.0), (1, (1, 1), (9, 4), 9.5), (1, (4, 4), (6, 4), 2.0)]
"""Bucket, start, goal and length; the second starts in a tree."""

ROS = {
    "image": "room.pgm",
    "resolution": 0.5,
    "origin": [-1.0, 2.0, 0.0],
    "negate": 0,
    "occupied_thresh": 0.65,
    "free_thresh": 0.196,
}

ROOM = np.full((8, 10), 254, dtype=np.uint8)
"""Grey: white with a wall in black, and a corner of which nothing is known."""
ROOM[2:5, 4:6] = 0
ROOM[6:, 7:] = 205


def grid_text(rows: list[str] = GRID) -> str:
    header = ["type octile", f"height {len(rows)}", f"width {len(rows[0])}", "map"]
    return "\n".join([*header, *rows, ""])


def scen_text(name: str = "cave.map", rows: list[str] = GRID) -> str:
    size = f"{len(rows[0])}\t{len(rows)}"
    lines = [
        f"{bucket}\t{name}\t{size}\t{x}\t{y}\t{to_x}\t{to_y}\t{length}"
        for bucket, (x, y), (to_x, to_y), length in QUERIES
    ]
    return "\n".join(["version 1", *lines, ""])


def yaml_text(**changed) -> str:
    lines = {**ROS, **changed}
    return "".join(f"{key}: {value}\n" for key, value in lines.items() if value is not None)


def write_grid(folder: Path, name: str = "cave.map", scen: str | None = "cave.map.scen") -> Path:
    (folder / name).write_text(grid_text())
    if scen is not None:
        (folder / scen).write_text(scen_text(name))
    return folder / name


def write_ros(folder: Path, pixels=ROOM, **changed) -> Path:
    write_image(folder / str(changed.get("image", ROS["image"])), pixels)
    file = folder / "room.yaml"
    file.write_text(yaml_text(**changed))
    return file


def write_image(file: Path, pixels) -> Path:
    """Pixels (rows, columns) grey, or with two to four channels."""
    Image.fromarray(np.asarray(pixels)).save(file)
    return file
