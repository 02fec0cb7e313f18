"""An SVG drawing is read as a browser shows it, the right way up."""

import io
import math
import os
from pathlib import Path

import numpy as np
import pytest
import shapely
from PIL import Image
from playwright.sync_api import sync_playwright

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.maps.options import MapOptions
from suite.scenes.maps.svg import FLATNESS, read_svg
from suite.scenes.scene import SceneWarning
from tests.suite.scenes.maps.drawings import EVERYTHING, svg
from tests.suite.scenes.real_maps import FOLDER, MISSING, REASON

CHROMIUM = Path("/usr/bin/chromium")
WHITE = 250
"""Grey from which a pixel counts as white, beside edges, which are not compared."""


@pytest.fixture(scope="module")
def browser():
    if not os.access(CHROMIUM, os.X_OK):
        pytest.skip(f"no {CHROMIUM}: `make browser` installs it, as root on Debian")
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(
            executable_path=CHROMIUM, args=("--no-sandbox", "--disable-gpu"), timeout=300_000
        )
        yield started
        started.close()


@pytest.fixture
def drawing(tmp_path):
    """Write a drawing, and read it."""

    def write_and_read(text: str, **options):
        file = tmp_path / "hall.svg"
        file.write_text(text, encoding="utf-8")
        return read_svg(file, MapOptions(**options))

    return write_and_read


def areas(drawing) -> list[float]:
    return [polygon.area for polygon in drawing.obstacles]


@pytest.mark.parametrize("name", EVERYTHING)
def test_an_obstacle_is_where_a_browser_paints(name, browser, drawing, tmp_path):
    found = shapely.union_all(drawing(EVERYTHING[name]).obstacles)
    page = browser.new_page(viewport={"width": 400, "height": 300})
    page.goto((tmp_path / "hall.svg").as_uri(), timeout=300_000)
    shown = np.asarray(Image.open(io.BytesIO(page.screenshot(timeout=300_000))).convert("L"))
    page.close()
    height, width = shown.shape
    columns, rows = np.meshgrid(np.arange(width) + 0.5, height - np.arange(height) - 0.5)
    points = shapely.points(columns, rows)
    shapely.prepare(found)
    clear = shapely.distance(found.boundary, points) > 1.0
    assert clear.mean() > 0.9
    painted = shown < WHITE
    assert 0.05 < painted.mean() < 0.5
    np.testing.assert_array_equal(shapely.contains(found, points)[clear], painted[clear])


def test_the_lower_left_corner_of_the_page_is_zero_and_y_is_up(drawing):
    read = drawing(svg('<rect x="20" y="300" width="40" height="15"/>'))
    assert read.workspace.bounds == (0.0, 0.0, 400.0, 300.0)
    assert [p.bounds for p in read.obstacles] == [(10.0, 5.0, 50.0, 20.0)]


def test_a_unit_is_a_metre_unless_the_scale_says_so(tmp_path):
    file = tmp_path / "hall.svg"
    file.write_text(svg('<rect x="20" y="300" width="40" height="15"/>', 'width="90mm"'))
    assert load_scene(file).bounds == (0.0, 0.0, 400.0, 300.0)
    scaled = load_scene(f"{file}@scale=0.05")
    assert np.ptp(np.reshape(scaled.bounds, (2, 2)), axis=0).tolist() == [20.0, 15.0]
    assert scaled.obstacles[0].polygon.area == pytest.approx(600 * 0.05**2)


@pytest.mark.parametrize(
    ("attributes", "size"),
    [
        ('width="100" height="50"', (100.0, 50.0)),
        ('width="25.4mm" height="1in"', (96.0, 96.0)),
        ('viewBox="-5,-5,30,20" width="100%" height="100%"', (30.0, 20.0)),
        ('viewBox="0 0 30 20" preserveAspectRatio="none" width="10" height="90"', (30.0, 20.0)),
        ("", (13.0, 7.0)),
        ('width="100%" height="50%"', (13.0, 7.0)),
    ],
)
def test_the_page_is_the_view_box_or_the_size_or_what_is_painted(drawing, attributes, size):
    body = '<rect x="2" y="3" width="13" height="7"/>'
    read = drawing(f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>{body}</svg>')
    assert read.workspace.bounds == (0.0, 0.0, *size)
    assert sum(areas(read)) == pytest.approx(91.0)


@pytest.mark.parametrize("scale", [1.0, 25.0])
def test_chords_are_off_their_curves_by_no_more_than_is_said(drawing, scale):
    body = f'<g transform="scale({scale})"><circle cx="{{0}}" cy="{{0}}" r="{{1}}"/></g>'
    read = drawing(svg(body.format(160.0 / scale, 80.0 / scale)))
    middle = shapely.Point(150.0, 160.0)
    outline = read.obstacles[0].exterior
    farthest = FLATNESS * 400.0
    assert 80.0 - farthest <= outline.distance(middle) <= 80.0
    assert outline.hausdorff_distance(middle) == pytest.approx(80.0)
    # As few as that allows: the sagitta of a chord goes with its square.
    assert len(outline.coords) < 2.0 * math.pi / math.sqrt(8.0 * farthest / 80.0) + 8


def test_chords_of_bezier_curves_are_off_by_no_more_than_is_said(drawing):
    ends = np.array([(50.0, 70.0), (180.0, -300.0), (300.0, 500.0), (330.0, 150.0)])
    d = "M{} {} C{} {} {} {} {} {}".format(*ends.ravel())
    read = drawing(svg(f'<path d="{d} L330 310 H50 z"/>'))
    t = np.linspace(0.0, 1.0, 2001)[:, None]
    curve = sum(math.comb(3, i) * t**i * (1 - t) ** (3 - i) * end for i, end in enumerate(ends)) * [
        1.0,
        -1.0,
    ] + [-10.0, 320.0]
    outlines = shapely.union_all([p.boundary for p in read.obstacles])
    off = shapely.distance(outlines, shapely.points(curve[curve[:, 1] < 300.0]))
    assert off.max() <= FLATNESS * 400.0


def test_what_is_painted_is_dark_from_the_threshold_on(drawing):
    body = (
        '<rect x="20" y="30" width="10" height="10" fill="#c7c7c7"/>'
        '<rect x="40" y="30" width="20" height="10" fill="#444" opacity="0.9"/>'
        '<rect x="70" y="30" width="30" height="10" fill="url(#wood)"/>'
    )
    assert areas(drawing(svg(body))) == pytest.approx([100.0, 200.0, 300.0])
    assert areas(drawing(svg(body), threshold=0.5)) == pytest.approx([200.0, 300.0])
    assert areas(drawing(svg(body), threshold=0.9)) == pytest.approx([300.0])


def test_an_obstacle_is_simplified_on_request_and_only_grows(drawing):
    exact, plain = (drawing(svg('<path d="M60 60 h60 v30 l-30 -1 -30 1z"/>'), simplify=s)
                    for s in (None, 1.5))  # fmt: skip
    assert len(exact.obstacles[0].exterior.coords) == 6
    assert len(plain.obstacles[0].exterior.coords) == 5
    assert plain.obstacles[0].covers(exact.obstacles[0])


def test_text_and_images_are_left_out_and_said_to_be(drawing):
    body = (
        '<rect width="90" height="90"/><text x="50" y="50">Hall</text>'
        '<image width="9" height="9" href="a.png"/>'
    )
    with pytest.warns(SceneWarning, match=r"^hall\.svg: 1 images and 1 texts left out\. Turn them"):
        assert len(drawing(svg(body)).obstacles) == 1


CLIP = '<clipPath id="c"><rect x="60" y="60" width="50" height="50"/></clipPath>'
MASK = '<mask id="m"><rect x="60" y="60" width="50" height="50" fill="white"/></mask>'
BLACK = '<rect x="50" y="50" width="100" height="100"{}/>'


@pytest.mark.parametrize(
    "body",
    [
        CLIP + BLACK.format(' clip-path="url(#c)"'),
        BLACK.format(' clip-path="url(#c)"') + CLIP,
        CLIP + BLACK.format(' style="clip-path: url(#c)"'),
        f"<style>.part {{clip-path: url(#c)}}</style>{CLIP}" + BLACK.format(' class="part"'),
        f'{CLIP}<g clip-path="url(#c)"><g clip-path="none">{BLACK.format("")}</g></g>',
        CLIP + "<defs>" + BLACK.format(' id="r"') + '</defs><use href="#r" clip-path="url(#c)"/>',
        MASK + BLACK.format(' mask="url(#m)"'),
        f'{MASK}<g mask="url(#m)">{BLACK.format("")}</g>',
    ],
)
def test_what_is_cut_off_by_a_clip_path_or_a_mask_is_an_obstacle_and_said_to_be(drawing, body):
    other = '<rect x="200" y="50" width="10" height="10" clip-path="none"/>'
    with pytest.warns(
        SceneWarning, match=r"^hall\.svg: 1 of 2 shapes are clipped or masked, which"
    ):
        found = drawing(svg(body + other))
    assert areas(found) == pytest.approx([10_000.0, 100.0])


@pytest.mark.parametrize("cut", [' clip-path="url(#c)"', ' mask="url(#m)"'])
def test_white_that_is_cut_hides_nothing(drawing, cut):
    """Or an obstacle that is drawn outside the clip would be free."""
    white = BLACK.format(' fill="white"' + cut)
    with pytest.warns(SceneWarning, match="1 of 2 shapes are clipped or masked"):
        assert areas(drawing(svg(CLIP + MASK + BLACK.format("") + white))) == [10_000.0]
    with pytest.raises(SceneError, match="nothing on its page is painted"):
        drawing(svg(CLIP + MASK + BLACK.format("") + white.replace(cut, "")))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", r"hall\.svg: no XML \(no element found: line 1, column 0\)\."),
        ("<svg><g></svg>", r"hall\.svg: no XML \(mismatched tag: line 1, column 10\)\."),
        ("<html/>", r"hall\.svg: its root is 'html', not 'svg'\."),
        ('<svg viewBox="0 0 9"/>', r"its viewBox is '0 0 9'\. It is four numbers"),
        ('<svg viewBox="0 0 a b"/>', r"its viewBox is '0 0 a b'\. It is four numbers"),
        ('<svg viewBox="0 0 0 9"/>', r"its page is 0 by 9\. Give it some size"),
        ('<svg viewBox="0 0 nan 9"/>', r"its page is nan by 9\. Give it some size"),
        ('<svg width="wide" height="9"/>', r"'wide' is no length\. Write it like 80mm"),
        ("<svg/>", r"has no page, and nothing is painted\. Give it a viewBox"),
        (svg(""), r"nothing on its page is painted darker than 0.001 of black"),
        (svg('<rect width="90" height="90" fill="none"/>'), "nothing on its page is painted"),
        (svg('<rect x="999" width="90" height="90"/>'), "nothing on its page is painted"),
        (svg('<symbol id="s" viewBox="0 0 9 9"/>'), "the symbol 's' has a viewBox.* Unlink"),
        (svg('<g id="a"><use href="#a"/></g>'), "an element uses itself, or lies too deep"),
        (svg('<path id="p" d="M1e300 0 L1e301 9 L5 5z"/>'), "'p': lies too far off, beyond 1e"),
    ],
)
def test_a_drawing_that_can_not_be_read_says_why(drawing, text, message):
    with pytest.raises(SceneError, match=message):
        drawing(text)


@pytest.mark.skipif(MISSING, reason=REASON)
def test_the_warehouse_is_read_as_it_is_drawn():
    scene = load_scene(FOLDER / "warehouse.svg")
    assert len(scene.obstacles) == 88
    assert scene.bounds == (0.0, 0.0, 85.772506, 80.471351)
    solid = shapely.union_all([o.polygon for o in scene.obstacles])
    # The first vertex of its first path, moved by its layer's transform, y up.
    first = (678.25477 - 655.71631, 80.471351 - (599.46082 - 577.30802))
    assert solid.boundary.distance(shapely.Point(first)) < 0.1
    # Two rows of boxes stand along the lower wall, and one along the upper.
    for y, boxes in ((2.0, 20), (7.0, 20), (78.5, 20)):
        line = shapely.LineString([(0.0, y), (85.7, y)])
        assert len(shapely.get_parts(solid.intersection(line))) == boxes
    assert not solid.intersects(shapely.box(4.5, 10.0, 80.0, 15.0))
