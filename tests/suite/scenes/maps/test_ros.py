"""Occupancy grids are read as ROS's map_server reads them."""

import numpy as np
import pytest
import shapely

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.maps.raster import Raster
from suite.scenes.maps.ros import MapYaml, occupancy
from tests.suite.scenes.maps.files import ROOM, write_image, write_ros, yaml_text

GREYS = np.array([[0, 89, 90, 204, 205, 206, 255]], dtype=np.uint8)


def said(**changed) -> MapYaml:
    values = {"negate": 0, "occupied_thresh": 0.65, "free_thresh": 0.196} | changed
    return MapYaml("room.png", 0.05, (0.0, 0.0, 0.0), **values)


def values_of(pixels, opacity=None, **changed) -> list[int]:
    level = np.asarray(pixels, dtype=np.uint8)
    opaque = None if opacity is None else np.asarray(opacity) / 255.0
    return occupancy(Raster(level, 255, opaque), said(**changed))[0].astype(int).tolist()


def solid(scene) -> shapely.Geometry:
    return shapely.union_all([obstacle.polygon for obstacle in scene.obstacles])


# What map_server publishes, computed by hand from map_io.cpp: darkness is (255 - grey) / 255.


def test_trinary_is_occupied_above_one_threshold_free_below_the_other_and_else_unknown():
    assert values_of(GREYS) == [100, 100, -1, -1, -1, 0, 0]


def test_a_darkness_of_exactly_a_threshold_is_occupied_or_free():
    greys = np.array([[51, 52, 203, 204]])
    assert values_of(greys, occupied_thresh=0.8, free_thresh=0.2) == [100, -1, -1, 0]


def test_negate_takes_bright_for_occupied():
    assert values_of(GREYS, negate=1) == [0, -1, -1, 100, 100, 100, 100]
    assert values_of(GREYS, negate=True) == values_of(GREYS, negate=1)


def test_what_is_not_opaque_is_unknown():
    opacity = [[255, 254, 0, 255]]
    assert values_of([[0, 0, 255, 255]], opacity) == [100, -1, -1, 0]
    assert values_of([[0, 0, 255, 255]], opacity, mode="scale") == [100, -1, -1, 0]
    assert values_of([[0, 1, 99, 255]], opacity, mode="raw") == [0, 1, 99, -1]


def test_an_alpha_channel_that_is_opaque_changes_nothing(tmp_path):
    opaque = np.dstack([ROOM, ROOM, ROOM, np.full_like(ROOM, 255)])
    scene = load_scene(str(write_ros(tmp_path, opaque, image="room.png")))
    assert scene.hash == load_scene(str(write_ros(tmp_path))).hash


def test_scale_fills_in_what_lies_between():
    greys = [[0, 51, 102, 153, 204, 255]]
    thresholds = {"mode": "scale", "occupied_thresh": 0.8, "free_thresh": 0.2}
    assert values_of(greys, **thresholds) == [100, 100, 67, 33, 0, 0]


def test_raw_takes_the_grey_itself_up_to_a_hundred():
    greys = [[0, 1, 99, 100, 101, 255]]
    assert values_of(greys, mode="raw") == [0, 1, 99, 100, -1, -1]
    assert values_of(greys, mode="raw", negate=1) == [0, 1, 99, 100, -1, -1]


def test_what_is_neither_free_nor_occupied_is_occupied_unless_it_is_said_to_be_free(tmp_path):
    file = write_ros(tmp_path)
    assert len(load_scene(str(file)).obstacles) == 2
    assert len(load_scene(f"{file}@unknown=occupied").obstacles) == 2
    (wall,) = load_scene(f"{file}@unknown=free").obstacles
    # Rows 2 to 4 of 8 from the top, columns 4 and 5; half a metre each, from (-1, 2) on.
    assert wall.polygon.equals(shapely.box(1.0, 3.5, 2.0, 5.0))
    assert load_scene(str(file)).properties["unknown_share"] == pytest.approx(6 / 80)


def test_the_map_is_turned_about_its_lower_left_corner(tmp_path):
    straight = load_scene(str(write_ros(tmp_path)))
    turned = load_scene(str(write_ros(tmp_path, origin=[-1.0, 2.0, 0.7])))
    back = shapely.affinity.rotate(solid(turned), -0.7, origin=(-1.0, 2.0), use_radians=True)
    assert back.hausdorff_distance(solid(straight)) < 1e-9
    assert turned.workspace.area == pytest.approx(20.0)


@pytest.mark.parametrize("suffix", ["png", "bmp", "pgm"])
def test_images_of_each_kind_make_the_same_map(tmp_path, suffix):
    scene = load_scene(str(write_ros(tmp_path, image=f"room.{suffix}")))
    assert scene.hash == load_scene(str(write_ros(tmp_path))).hash


def test_the_image_is_found_from_the_folder_of_the_yaml(tmp_path):
    (tmp_path / "pictures").mkdir()
    file = write_ros(tmp_path, image="pictures/room.png")
    assert len(load_scene(str(file)).obstacles) == 2
    absolute = write_ros(tmp_path, image=str(write_image(tmp_path / "other.png", ROOM)))
    assert len(load_scene(str(absolute)).obstacles) == 2


@pytest.mark.parametrize(
    "changed",
    [{"resolution": "5e-1"}, {"negate": "false"}, {"mode": "trinary"}, {"voxels": [1]}],
    ids=str,
)
def test_what_map_server_reads_is_read(tmp_path, changed):
    assert load_scene(str(write_ros(tmp_path, **changed))).bounds == (-1.0, 2.0, 4.0, 6.0)


ERRORS = {
    "no image named": ({"image": None}, "'image' is missing: give the path of the map's image"),
    "no resolution": ({"resolution": None}, "'resolution' is missing: give the metres of a pixel"),
    "no thresholds": ({"free_thresh": None}, "'free_thresh' is missing: give a share from 0 to 1"),
    "resolution 0": ({"resolution": 0}, "resolution is 0. Give metres of a pixel, above 0"),
    "not square": ({"resolution": [0.1, 0.2]}, "resolution is [0.1, 0.2]. Give the metres of a"),
    "not finite": ({"resolution": ".nan"}, "resolution is nan"),
    "short origin": ({"origin": [0, 0]}, "origin is [0, 0]. Give x, y and yaw"),
    "endless origin": ({"origin": "[0, .inf, 0]"}, "Give finite numbers"),
    "negate": ({"negate": 2}, "negate is 2. Give 0 where dark pixels are occupied"),
    "mode": ({"mode": "ternary"}, "mode is 'ternary'. Give one of 'raw', 'scale', 'trinary'"),
    "thresholds": ({"free_thresh": 0.7}, "free_thresh is 0.7 and occupied_thresh 0.65. Give two"),
    "percent": ({"occupied_thresh": 65}, "free_thresh is 0.196 and occupied_thresh 65. Give two"),
    "no YAML": ({"origin": "[0, 0"}, "no YAML"),
    "no date": ({"image": "2026-13-77"}, "no YAML"),
}


@pytest.mark.parametrize(("changed", "words"), ERRORS.values(), ids=ERRORS)
def test_an_error_of_the_yaml_says_what_is_wrong_and_what_to_give(tmp_path, changed, words):
    file = write_ros(tmp_path)
    file.write_text(yaml_text(**changed))
    with pytest.raises(SceneError, match=r"^room\.yaml") as raised:
        load_scene(str(file))
    assert words in str(raised.value)


@pytest.mark.parametrize("text", ["", "- image", "room", "{}"])
def test_a_yaml_of_another_kind_says_what_is_wanted(tmp_path, text):
    (tmp_path / "room.yaml").write_text(text)
    with pytest.raises(SceneError, match=r"^room\.yaml: .*(image, resolution|'image' is missing)"):
        load_scene(str(tmp_path / "room.yaml"))


def test_an_image_that_is_not_there_is_named(tmp_path):
    file = write_ros(tmp_path)
    (tmp_path / "room.pgm").unlink()
    with pytest.raises(SceneError, match=r"^room\.yaml, image room\.pgm: can't be read \(No such"):
        load_scene(str(file))


def test_an_image_that_is_cut_off_is_named(tmp_path):
    file = write_ros(tmp_path)
    data = (tmp_path / "room.pgm").read_bytes()
    (tmp_path / "room.pgm").write_bytes(data[:-20])
    with pytest.raises(SceneError, match=r"^room\.yaml, image room\.pgm: is damaged, or cut off"):
        load_scene(str(file))


def test_options_that_the_yaml_answers_itself_are_refused(tmp_path):
    file = write_ros(tmp_path)
    with pytest.raises(SceneError, match=r"resolution says nothing of ROS map_server"):
        load_scene(f"{file}@resolution=0.1")
