"""Moving AI's grids and queries are read as their format says."""

import pytest
import shapely

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from tests.suite.scenes.maps.files import GRID, QUERIES, grid_text, scen_text, write_grid


def solid(scene) -> shapely.Geometry:
    return shapely.union_all([obstacle.polygon for obstacle in scene.obstacles])


def test_free_are_passable_terrain_and_swamp_and_all_else_is_blocked(tmp_path):
    scene = load_scene(str(write_grid(tmp_path)))
    height = len(GRID)
    for y, row in enumerate(GRID):
        for x, letter in enumerate(row):
            centre = shapely.Point(x + 0.5, height - (y + 0.5))
            assert solid(scene).contains(centre) == (letter in "@OTW"), (x, y, letter)
    assert scene.bounds == (0.0, 0.0, 10.0, 5.0)
    assert scene.properties["blocked_letters"] == "@TW"


@pytest.mark.parametrize("name", ["cave.map.scen", "cave.scen"])
def test_queries_beside_a_map_come_along_with_buckets_and_published_lengths(tmp_path, name):
    scene = load_scene(str(write_grid(tmp_path, scen=name)))
    assert [query.name for query in scene.queries] == ["0-1", "1-2", "1-3"]
    assert [query.stratum for query in scene.queries] == ["0", "1", "1"]
    assert scene.properties["published"] == {"0-1": 11.0, "1-2": 9.5, "1-3": 2.0}
    assert scene.properties["published_as"] == "octile"
    # Cell (9, 4) is in the lowest of five rows.
    assert scene.query("1-2").goal.tolist() == [9.5, 0.5]


def test_a_map_without_queries_has_none(tmp_path):
    assert load_scene(str(write_grid(tmp_path, scen=None))).queries == ()


@pytest.mark.parametrize("named", ["cave.map", "maps/of/games/cave.map", "maps\\cave.map"])
def test_a_file_of_queries_names_its_map(tmp_path, named):
    write_grid(tmp_path, scen=None)
    (tmp_path / "some.scen").write_text(scen_text(named))
    scene = load_scene(str(tmp_path / "some.scen"))
    assert len(scene.queries) == len(QUERIES)
    assert scene.hash == load_scene(str(tmp_path / "cave.map")).hash


def test_a_query_whose_end_is_blocked_stays_and_says_so(tmp_path):
    scene = load_scene(str(write_grid(tmp_path)))
    assert [query.blocked is None for query in scene.queries] == [True, False, True]
    assert "start of query '1-2': (1.5, 3.5) lies inside obstacle" in scene.query("1-2").blocked


def test_the_shortest_path_cuts_corners_that_the_grid_may_not(tmp_path):
    scene = load_scene(str(write_grid(tmp_path)))
    found = shortest_path(scene, scene.query("0-1"))
    assert found.path is not None
    assert found.length < 11.0


ERRORS = {
    "type": (grid_text().replace("octile", "hex"), "line 1: not 'type octile'"),
    "height": (grid_text().replace("height 5", "height five"), "line 2: not 'height H'"),
    "no header": ("\n".join(GRID), "line 1: not 'type octile'"),
    "empty": ("", "line 1: not 'type octile'"),
    "too few rows": (grid_text(GRID).replace("height 5", "height 6"), "has 5 rows of cells, but"),
    "too many rows": (grid_text(GRID) + "..........\n", "has 6 rows of cells, but its height is 5"),
    "short row": (grid_text([*GRID[:2], "....", *GRID[3:]]), "line 7: a row of 4 cells, but its"),
    "no size": ("type octile\nheight 0\nwidth 0\nmap\n", "0 x 0 cells. Give 1 to"),
    "too large": ("type octile\nheight 9999999\nwidth 1\nmap\n", "1 x 9999999 cells. Give 1 to"),
    "blank": (grid_text().replace("G", " "), "line 9: cells are letters"),
    "no text": (b"type octile\xff\xfe", "is no text"),
}


@pytest.mark.parametrize(("content", "words"), ERRORS.values(), ids=ERRORS)
def test_an_error_of_a_map_says_what_is_wrong_and_where(tmp_path, content, words):
    file = tmp_path / "cave.map"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(SceneError, match=r"^cave\.map") as raised:
        load_scene(str(file))
    assert words in str(raised.value)


SCEN_ERRORS = {
    "version": (scen_text().replace("version 1", "version 2"), "line 1: not 'version 1'"),
    "a field too few": (scen_text().replace("\t11.0", ""), "line 2: no query. Give bucket, map,"),
    "no number": (scen_text().replace("11.0", "long"), "line 2: no query"),
    "bucket": (scen_text().replace("\n0\t", "\nnone\t"), "line 2: bucket is 'none'"),
    "other size": (scen_text().replace("\t10\t5", "\t20\t10"), "query 0-1: is of a map of 20 x 10"),
}


@pytest.mark.parametrize(("content", "words"), SCEN_ERRORS.values(), ids=SCEN_ERRORS)
@pytest.mark.parametrize("name", ["cave.map", "cave.map.scen"])
def test_an_error_of_queries_names_their_file(tmp_path, name, content, words):
    write_grid(tmp_path)
    (tmp_path / "cave.map.scen").write_text(content)
    with pytest.raises(SceneError, match=r"^cave\.map\.scen") as raised:
        load_scene(str(tmp_path / name))
    assert words in str(raised.value)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (scen_text("mine.map"), "its map, mine.map, is not beside it"),
        (scen_text("m" * 999 + ".map"), "mmm..., is not beside it"),
        (scen_text("m\0.map"), "its map, m.map, is not beside it"),
        (scen_text().replace("cave.map", "mine.map", 1), "its queries are of 2 maps"),
        (scen_text("level.mesh"), "is of level.mesh, which is no grid. Name that"),
        ("version 1\n", "has no queries, and so names no map"),
    ],
)
def test_queries_without_a_map_say_how_to_mend_it(tmp_path, content, words):
    (tmp_path / "level.mesh").write_text("mesh")
    (tmp_path / "some.scen").write_text(content)
    with pytest.raises(SceneError, match=r"^some\.scen") as raised:
        load_scene(str(tmp_path / "some.scen"))
    assert words in str(raised.value)
