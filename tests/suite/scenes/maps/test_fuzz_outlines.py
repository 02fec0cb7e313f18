"""A map of outlines that went wrong is an error of a line or two, or a right scene."""

import json
import random
from pathlib import Path

import pytest
import shapely

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.geojson import read_scene, write_scene
from suite.scenes.scene import Scene
from tests.mutations import as_json, check_files, mutated_bytes, mutated_document
from tests.suite.scenes.maps.drawings import EVERYTHING
from tests.suite.scenes.maps.test_features import HOUSES, METRES, document
from tests.suite.scenes.maps.test_fuzz import LONGEST, LOTS, check_right, spoiled_maps
from tests.suite.scenes.maps.test_mesh import OPEN_3, SCEN, SQUARE_2, ring
from tests.suite.scenes.maps.test_wkt import FAR, SQUARE

DXF = "0\nSECTION\n2\nENTITIES\n" + "".join(
    f"0\nLWPOLYLINE\n8\nwalls\n90\n4\n70\n1\n10\n{x}\n20\n{y}\n10\n{x + 3}\n20\n{y}\n10\n{x + 3}\n"
    f"20\n{y + 2}\n10\n{x}\n20\n{y + 2}\n"
    for x, y in ((0, 0), (5, 1), (2, 6))
) + "0\nENDSEC\n0\nEOF\n"  # fmt: skip

TEXTS = {
    ".mesh": [SQUARE_2, OPEN_3, ring(2), ring(3)],
    ".svg": list(EVERYTHING.values()),
    ".wkt": [f"{SQUARE}\n{FAR}", f"SRID=32632;GEOMETRYCOLLECTION ({SQUARE}, {FAR})"],
    ".dxf": [DXF],
}


def spoiled(folder: Path, seed: int) -> tuple[Path, Path]:
    """A map of which one file went wrong: what to load, and the file."""
    rng = random.Random(seed)
    own = rng.getrandbits(32)
    suffix = rng.choice([*TEXTS, ".geojson", ".scen"])
    if suffix == ".geojson":
        bad = folder / "hall.geojson"
        bad.write_text(as_json(mutated_document(document(HOUSES, **METRES), own)))
        return bad, bad
    if suffix == ".scen":
        named, bad = folder / "hall.mesh", folder / "hall.mesh.scen"
        named.write_text(OPEN_3)
        bad.write_bytes(mutated_bytes(SCEN.format(8.94427190999916), own))
        return named, bad
    bad = folder / f"hall{suffix}"
    bad.write_bytes(mutated_bytes(rng.choice(TEXTS[suffix]), own))
    return bad, bad


@pytest.mark.parametrize("first", LOTS)
def test_a_map_of_outlines_that_went_wrong_is_an_error_or_a_right_scene(first, tmp_path):
    pytest.importorskip("pyogrio", reason="the extra gdal is not installed")

    def right(scene: Scene) -> None:
        check_right(scene)
        check_written(scene, tmp_path / "again.geojson")

    files = spoiled_maps(tmp_path, first, spoiled)
    check_files(files, load_scene, right, SceneError, LONGEST)


def check_written(scene: Scene, file: Path) -> None:
    """It is the same when it is written and read."""
    write_scene(scene, file)
    again = read_scene(file)
    assert again.hash == scene.hash
    assert json.dumps(dict(again.properties)) == json.dumps(dict(scene.properties))
    assert [q.blocked is None for q in again.queries] == [q.blocked is None for q in scene.queries]


def test_what_is_spoiled_is_right_before(tmp_path):
    pytest.importorskip("pyogrio", reason="the extra gdal is not installed")
    for suffix, texts in TEXTS.items():
        for text in texts:
            file = tmp_path / f"hall{suffix}"
            file.write_text(text)
            scene = load_scene(file)
            assert shapely.is_valid([o.polygon for o in scene.obstacles]).all()
