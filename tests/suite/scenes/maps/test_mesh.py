"""Polygon meshes: versions 2 and 3 told apart, and what is none refused with the place."""

import numpy as np
import pytest
import shapely

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.exact import shortest_path
from tests.suite.scenes.real_maps import FOLDER, MISSING, REASON

SQUARE_2 = """mesh
2
4 2
0.0 0.0 2 0 -1
1.5 0.0 3 0 1 -1
1.5 1.5 2 1 -1
0.0 1.5 3 -1 1 0
3 0 1 3 -1 -1 1
3 1 2 3 0 -1 -1
"""
"""The example of the format of version 2."""

OPEN_3 = """mesh
3
5 4  // 5 vertices 4 faces
0 0   // vertex 1
0 10  // vertex 2
10 10 // vertex 3
10 0  // vertex 4
5 5   // vertex 5
0 3   4 1 5   -4 0 -2
1 3   1 2 5   -1 0 3
1 3   2 3 5   2 0 4
1 3   3 4 5   3 0 -1
"""
"""The example of version 3, comments included: of the four triangles the lower one is closed."""

SCEN = "version 1\n0\tm.mesh\t10\t10\t1\t3\t9\t3\t{}\n3\tm.mesh\t10\t10\t1\t3\t5\t1\t4\n"


def ring(version: int) -> str:
    """A ring of eight square cells around a closed one, whose corners are (1, 1) to (2, 2)."""
    xy = [(x, y) for y in range(4) for x in range(4)]
    cells = [(x, y) for y in range(3) for x in range(3) if version == 3 or (x, y) != (1, 1)]
    first = 1 if version == 3 else 0

    def neighbour(place: tuple[int, int]) -> int:
        if place not in cells:
            return 0 if version == 3 else -1
        return (-1 if place == (1, 1) else 1) * (cells.index(place) + first)

    rows = []
    for x, y in cells:
        corners = [4 * y + x, 4 * y + x + 1, 4 * y + x + 5, 4 * y + x + 4]
        # The j-th neighbour lies beyond the edge from the (j-1)-th corner to the j-th.
        around = [(x - 1, y), (x, y - 1), (x + 1, y), (x, y + 1)]
        free = [int((x, y) != (1, 1))] if version == 3 else []
        if version == 3 and free == [0]:
            beyond = [-(cells.index(place) + first) for place in around]
        else:
            beyond = [neighbour(place) for place in around]
        rows.append([*free, 4, *(corner + first for corner in corners), *beyond])
    points = [[*point, 1, -1] if version == 2 else [*point] for point in xy]
    lines = [["mesh"], [version], [16, len(cells)], *points, *rows]
    return "\n".join(" ".join(map(str, line)) for line in lines)


@pytest.fixture
def mesh(tmp_path):
    def write_and_load(text, scen=None, beside="hall.mesh.scen"):
        (tmp_path / "hall.mesh").write_text(text)
        if scen is not None:
            (tmp_path / beside).write_text(scen)
        return load_scene(tmp_path / "hall.mesh")

    return write_and_load


def test_the_example_of_version_2_is_one_free_square(mesh):
    scene = mesh(SQUARE_2)
    assert (scene.bounds, scene.obstacles, scene.queries) == ((0.0, 0.0, 1.5, 1.5), (), ())


def test_the_example_of_version_3_leaves_the_lower_triangle_closed(mesh):
    scene = mesh(OPEN_3)
    (closed,) = scene.obstacles
    assert closed.polygon.normalize() == shapely.Polygon([(0, 0), (10, 0), (5, 5)]).normalize()
    assert scene.query("1,3:9,3").blocked is None
    assert "obstacle 1" in scene.query("5,1:9,3").blocked


def test_both_versions_of_a_map_are_one_scene(mesh):
    two, three = mesh(ring(2)), mesh(ring(3))
    assert two.hash == three.hash
    assert [o.polygon.bounds for o in two.obstacles] == [(1.0, 1.0, 2.0, 2.0)]
    assert (two.properties["format"], two.properties["cells"]) == ("polygon mesh 2", 8)


def test_white_space_means_nothing(mesh):
    assert mesh(ring(2).replace("\n", " ")).hash == mesh(ring(2).replace(" ", "\n\n")).hash


@pytest.mark.parametrize("beside", ["hall.mesh.scen", "hall.scen"])
def test_queries_beside_it_come_with_their_true_optima(mesh, beside):
    scene = mesh(OPEN_3, SCEN.format(8.94427190999916), beside)
    assert [(q.name, q.stratum) for q in scene.queries] == [("0-1", "0"), ("3-2", "3")]
    assert scene.properties["published_as"] == "euclidean"
    first, second = scene.queries
    found = shortest_path(scene, first).length
    assert scene.properties["published"][first.name] == pytest.approx(found)
    assert "lies inside obstacle 1" in second.blocked


def test_a_cell_without_area_is_no_room(mesh):
    flat = OPEN_3.replace("5 4  //", "5 5  //") + "1 3 1 2 1 0 0 0\n"
    assert mesh(flat).hash == mesh(OPEN_3).hash


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"hall\.mesh: no polygon mesh\. Its first line is 'mesh'"),
        ("mesh\n1\n", r"a mesh of version '1'\. Give one of version 2 or 3"),
        ("mesh\n", r"a mesh of version ''"),
        ("mesh\n2\n4\n", "the number of cells: the file ends here"),
        ("mesh\n2\nfour 2\n", "the number of vertices: 'four' is no whole number"),
        ("mesh\n2\n-4 2\n", r"it says that it has -4 vertices"),
        ("mesh\n2\n99999999999 2\n", r"it says that it has 99999999999 vertices"),
        (SQUARE_2.replace("1.5 1.5", "1.5 nan"), r"vertex 2: \(1\.5, nan\)\. Coordinates must be"),
        (SQUARE_2.replace("1.5 1.5 2", "1.5 1.5 two"), "vertex 2: 'two' is no whole number"),
        (SQUARE_2.replace("3 1 2 3 0", "3 1 2 4 0"), "cell 1: there is no vertex 4.* from 0 to 3"),
        (OPEN_3.replace("1 3   3 4 5", "1 3   0 4 5"), "cell 4: there is no vertex 0.* 1 to 5"),
        (OPEN_3.replace("1 3   3 4 5", "1 2   3 4"), r"cell 4: 2 vertices\. A cell has three"),
        (SQUARE_2.replace("0 -1 -1\n", "0 -1"), "cell 1: the file ends here"),
        (SQUARE_2 + "3 0 1 3 -1 -1 1", r"'3' stands behind the last cell\. Mend the counts"),
        (OPEN_3.replace("1 3   ", "0 3   "), r"no cell is free\. There is nowhere to go"),
        (SQUARE_2.replace("3 0 1 3 -1 -1 1", "4 0 1 3 2 -1 -1 1 -1"), "cell 0: its edges cross"),
        (
            OPEN_3.replace("2 0 4", "2 0 -4").replace("3 0 -1", "-3 0 -1"),
            "between the free cells 3 and 4 is a wall without width",
        ),
        (
            SQUARE_2.replace("3 1 2 3 0 -1 -1", "3 1 2 3 -1 -1 -1"),
            "between the free cells 1 and 0 is a wall without width",
        ),
        (
            SQUARE_2.replace("4 2\n", "4 3\n") + "4 0 1 2 3 -1 -1 -1 -1",
            r"cells overlap, by 2\.25 of 2\.25 square metres\. A scene is flat",
        ),
    ],
)  # fmt: skip
def test_a_mesh_that_can_not_be_read_says_where_and_why(mesh, text, message):
    with pytest.raises(SceneError, match=message):
        mesh(text)


def test_a_broken_file_of_queries_is_named(mesh):
    with pytest.raises(SceneError, match=r"hall\.mesh\.scen, line 3: no query"):
        mesh(OPEN_3, SCEN.format(8.9).replace("5\t1\t4", "5\t1\tx"))


@pytest.mark.skipif(MISSING, reason=REASON)
def test_the_game_level_is_read_with_its_queries():
    scene = load_scene(FOLDER / "ironharvest_scene_mp_2p_01.mesh")
    assert scene.bounds == (-100.0, -105.0, 100.0, 105.0)
    assert len(scene.queries) == 2000
    assert len(scene.obstacles) == 274
    assert all(query.blocked is None for query in scene.queries)
    # Nothing is lost: what is free is what its cells cover.
    free = scene.workspace.area - shapely.area([o.polygon for o in scene.obstacles]).sum()
    assert free == pytest.approx(cells_area(), rel=1e-9)


def cells_area() -> float:
    """Of the free cells, by the trapezoid rule and no library."""
    lines = (FOLDER / "ironharvest_scene_mp_2p_01.mesh").read_text().splitlines()
    vertices, cells = map(int, lines[2].split())
    xy = np.array([line.split() for line in lines[3 : 3 + vertices]], dtype=np.float64)
    total = 0.0
    for line in lines[3 + vertices : 3 + vertices + cells]:
        free, n, *numbers = map(int, line.split())
        x, y = xy[np.array(numbers[:n]) - 1].T
        total += free * 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
    return total
