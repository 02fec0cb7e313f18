"""Well-known text: one geometry or one a line, however nested, flat or not, in metres."""

import pytest
import shapely

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.maps.options import MapOptions
from suite.scenes.maps.wkt import read_wkt
from suite.scenes.scene import SceneWarning

SQUARE = "POLYGON ((0 0, 2 0, 2 2, 0 2, 0 0))"
FAR = "POLYGON ((7 5, 9 5, 9 6, 7 6, 7 5), (7.5 5.2, 8 5.2, 8 5.8, 7.5 5.2))"


@pytest.fixture
def read(tmp_path):
    def write_and_read(text: str, **options):
        file = tmp_path / "hall.wkt"
        file.write_text(text)
        return read_wkt(file, MapOptions(**options))

    return write_and_read


@pytest.mark.parametrize(
    "text",
    [
        f"{SQUARE}\n{FAR}",
        f"\n{SQUARE}\n\n  {FAR}\n",
        f"GEOMETRYCOLLECTION ({SQUARE}, GEOMETRYCOLLECTION (GEOMETRYCOLLECTION ({FAR})))",
        f"GEOMETRYCOLLECTION (\n  {SQUARE},\n  {FAR}\n)".replace("2 0,", "2 0,\n"),
        f"SRID=32632;{SQUARE}\nSRID=32632;\n{FAR}",
        f"SRID=0;{SQUARE}\nPOLYGON EMPTY\n{FAR}",
        "MULTIPOLYGON (" + ", ".join(p.removeprefix("POLYGON ") for p in (SQUARE, FAR)) + ")",
        shapely.to_wkt(
            shapely.force_3d(shapely.from_wkt([SQUARE, FAR]), 4.5)[0], output_dimension=3
        )
        + f"\n{FAR}",
    ],
)
def test_its_polygons_are_the_obstacles_and_their_box_the_workspace(read, text):
    found = read(text)
    assert found.workspace.bounds == (0.0, 0.0, 9.0, 6.0)
    assert [p.area for p in found.obstacles] == pytest.approx([4.0, 1.85])
    assert not any(p.has_z for p in found.obstacles)


def test_lines_and_points_are_left_out_and_counted(read):
    with pytest.warns(SceneWarning, match=r"^hall\.wkt: 2 lines and 1 point left out: obstacles"):
        found = read(f"{SQUARE}\nMULTILINESTRING ((0 0, 9 9), (1 1, 2 3))\nPOINT (50 50)")
    assert found.workspace.bounds == (0.0, 0.0, 2.0, 2.0)


def test_an_outline_is_simplified_on_request(read):
    dented = "POLYGON ((0 0, 4 0, 4 4, 2 3.9, 0 4, 0 0))"
    assert len(read(dented).obstacles[0].exterior.coords) == 6
    assert len(read(dented, simplify=0.2).obstacles[0].exterior.coords) == 5


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"^hall\.wkt: holds no polygon\. Draw obstacles as polygons"),
        ("POLYGON EMPTY", r"^hall\.wkt: holds no polygon"),
        ("LINESTRING (0 0, 1 1)", r"^hall\.wkt: holds 1 line, and no polygon\. .*buffer"),
        (f"{SQUARE}\n\nPOLYGON ((0 0, 1 x))\n{FAR}", r"^hall\.wkt, line 3: no well-known text"),
        (f"{SQUARE} and more", r"^hall\.wkt, line 1: no well-known text"),
        (f"{SQUARE}\n{FAR}\nPOLYGON ((0 0, 1 0,", r"^hall\.wkt, line 3: no well-known text"),
        ("POLYGON ((0 0, 1 0, 0 1))", r"^hall\.wkt, line 1: no well-known text"),
        (
            f"SRID=4326;{SQUARE}",
            r"^hall\.wkt, line 1: its coordinates are degrees \('EPSG:4326'\).* "
            r"ogr2ogr -t_srs EPSG:32631 metres\.gpkg hall\.wkt$",
        ),
    ],
)
def test_a_text_that_can_not_be_read_says_where_and_why(read, text, message):
    with pytest.raises(SceneError, match=message):
        read(text)


def test_minus_zero_is_zero(tmp_path):
    file = tmp_path / "hall.wkt"
    hashes = set()
    for text in (SQUARE, SQUARE.replace("(0 0,", "(-0 0,")):
        file.write_text(text)
        hashes.add(load_scene(file).hash)
    assert len(hashes) == 1
