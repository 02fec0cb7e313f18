"""Plain images: what is dark is occupied, what is transparent is not."""

import numpy as np
import pytest
import shapely
from PIL import Image

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.maps import raster
from tests.suite.scenes.maps.files import ROOM, write_image

CORNER = np.full((4, 6), 255, dtype=np.uint8)
CORNER[0, :2] = 0
"""Two black pixels in the upper left corner of 6 x 4."""


def solid(scene) -> shapely.Geometry:
    return shapely.union_all([obstacle.polygon for obstacle in scene.obstacles])


@pytest.mark.parametrize("suffix", ["png", "pgm", "bmp", "tif", "tiff"])
def test_a_pixel_is_a_metre_unless_it_is_said(tmp_path, suffix):
    file = write_image(tmp_path / f"corner.{suffix}", CORNER)
    scene = load_scene(str(file))
    assert solid(scene).equals(shapely.box(0, 3, 2, 4))
    assert (scene.properties["resolution"], scene.properties["resolution_is"]) == (1.0, "assumed")
    finer = load_scene(f"{file}@resolution=0.25")
    assert finer.bounds == (0.0, 0.0, 1.5, 1.0)
    assert finer.properties["resolution_is"] == "given"


def test_a_photograph_is_read_too(tmp_path):
    file = write_image(tmp_path / "corner.jpg", np.kron(CORNER, np.ones((8, 8), dtype=np.uint8)))
    assert solid(load_scene(str(file))).equals(shapely.box(0, 24, 16, 32))


def test_the_threshold_is_the_share_of_black_from_which_a_pixel_is_occupied(tmp_path):
    file = write_image(tmp_path / "greys.png", np.array([[0, 51, 127, 128, 204, 255]] * 2, "u1"))
    shares = {None: 3, 0.8: 2, 0.81: 1, 1.0: 1, 0.2: 5, 0.1: 5}
    for threshold, columns in shares.items():
        name = str(file) if threshold is None else f"{file}@threshold={threshold}"
        assert solid(load_scene(name)).area == 2 * columns, threshold
    with pytest.raises(SceneError, match=r"greys\.png: threshold is 65\. Give the share of black"):
        load_scene(f"{file}@threshold=65")


def test_colours_count_by_their_mean(tmp_path):
    red, dark = (255, 0, 0), (0, 80, 0)
    file = write_image(tmp_path / "colours.png", np.array([[red, dark]], dtype=np.uint8))
    assert solid(load_scene(f"{file}@threshold=0.7")).equals(shapely.box(1, 0, 2, 1))
    assert solid(load_scene(f"{file}@threshold=0.6")).area == 2.0


def test_what_is_transparent_is_white(tmp_path):
    pixels = np.zeros((1, 3, 4), dtype=np.uint8)
    pixels[0, :, 3] = (255, 0, 100)
    file = write_image(tmp_path / "ink.png", pixels)
    assert solid(load_scene(str(file))).equals(shapely.box(0, 0, 1, 1))


def test_a_palette_and_single_bits_and_sixteen_of_them_are_read(tmp_path):
    grey = Image.fromarray(ROOM)
    expected = load_scene(str(write_image(tmp_path / "grey.png", ROOM))).hash
    for mode in ("1", "P", "LA", "RGBA"):
        grey.convert(mode, dither=Image.Dither.NONE).save(tmp_path / f"{mode}.png")
        assert load_scene(str(tmp_path / f"{mode}.png")).hash == expected, mode
    sixteen = write_image(tmp_path / "16.png", ROOM.astype(np.uint16) * 257)
    assert load_scene(str(sixteen)).hash == expected
    (tmp_path / "16.pgm").write_bytes(
        b"P5\n10 8\n65535\n" + (ROOM.astype(np.uint16) * 257).astype(">u2").tobytes()
    )
    assert load_scene(str(tmp_path / "16.pgm")).hash == expected


def test_thirty_two_bits_are_refused(tmp_path):
    file = write_image(tmp_path / "deep.tif", ROOM.astype(np.float32))
    with pytest.raises(SceneError, match=r"deep\.tif: its pixels are of 32 bits"):
        load_scene(str(file))


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "is no image. Give one of PNG"),
        (b"not an image", "is no image"),
        (b"P5\n10 8\n255\n" + bytes(30), "is damaged, or cut off"),
        (b"P5\n0 8\n255\n", "is no image"),
        (b"P5\n100000 100000\n255\n", "has far too many pixels: at most 50,000,000"),
        (b"P5\n8000 8000\n255\n", "8000 x 8000 pixels: at most 50,000,000 can be read"),
    ],
)
def test_an_error_says_what_is_wrong_with_the_file(tmp_path, content, words):
    file = tmp_path / "room.pgm"
    file.write_bytes(content)
    with pytest.raises(SceneError, match=r"^room\.pgm") as raised:
        load_scene(str(file))
    assert words in str(raised.value)


def test_an_image_of_more_pixels_than_can_be_read_is_refused_unread(tmp_path, monkeypatch):
    file = write_image(tmp_path / "corner.png", CORNER)
    monkeypatch.setattr(raster, "MOST_PIXELS", 23)
    with pytest.raises(SceneError, match=r"6 x 4 pixels: at most 23 can be read"):
        load_scene(str(file))
