"""What GDAL reads, written by GDAL: polygons in metres, of one layer."""

import numpy as np
import pytest
import shapely

from suite.errors import SceneError
from suite.scenes.catalogue import load_scene
from suite.scenes.maps import vector
from suite.scenes.maps.projection import check_projection
from suite.scenes.scene import SceneWarning

pyogrio = pytest.importorskip("pyogrio", reason="the extra gdal is not installed")

HOUSES = [shapely.box(0, 0, 5, 5), shapely.Polygon([(8, 8), (12, 9), (9, 12)])]
DRIVERS = {
    ".shp": "ESRI Shapefile",
    ".gpkg": "GPKG",
    ".fgb": "FlatGeobuf",
    ".gml": "GML",
    ".tab": "MapInfo File",
}


def write(file, shapes, *, driver=None, crs="EPSG:32633", layer=None, append=False, kind="Unknown"):
    wkb = np.array(shapely.to_wkb(shapes), dtype=object)
    with_field = file.suffix != ".dxf"  # it has fields of its own
    pyogrio.raw.write(
        file,
        wkb,
        [np.arange(len(shapes))] if with_field else [],
        ["number"] if with_field else [],
        geometry_type=kind,
        crs=crs,
        driver=driver or DRIVERS[file.suffix],
        layer=layer,
        append=append,
    )
    return file


@pytest.mark.parametrize("suffix", DRIVERS)
def test_polygons_are_obstacles_in_every_format(tmp_path, suffix):
    scene = load_scene(write(tmp_path / f"town{suffix}", HOUSES, kind="Polygon"))
    areas = sorted(o.polygon.area for o in scene.obstacles)
    assert areas == pytest.approx([7.5, 25.0], rel=1e-5)  # MapInfo rounds
    assert scene.bounds == pytest.approx((0.0, 0.0, 12.0, 12.0), abs=1e-4)


@pytest.mark.filterwarnings("ignore:'crs' was not provided")
def test_closed_lines_of_a_dxf_are_outlines(tmp_path):
    lines = [house.exterior for house in HOUSES] + [shapely.LineString([(0, 0), (9, 9)])]
    file = write(
        tmp_path / "plan.dxf", [shapely.LineString(line) for line in lines], driver="DXF", crs=None
    )
    with pytest.warns(SceneWarning, match=r"^plan\.dxf: 1 line left out"):
        scene = load_scene(f"{file}@scale=0.001")
    assert [o.polygon.area for o in scene.obstacles] == pytest.approx([25e-6, 7.5e-6])


def test_heights_and_what_has_no_geometry_are_left_out(tmp_path):
    shapes = [shapely.force_3d(HOUSES[0], 7.0), None]
    scene = load_scene(write(tmp_path / "town.gpkg", shapes, kind="Polygon Z"))
    assert [o.polygon.has_z for o in scene.obstacles] == [False]


def test_of_several_layers_one_is_named(tmp_path):
    file = tmp_path / "town.gpkg"
    write(file, HOUSES[:1], layer="houses")
    write(file, HOUSES, layer="sheds", append=True)
    with pytest.raises(
        SceneError, match=r"has 2 layers, houses, sheds\. Name one: town\.gpkg@layer="
    ):
        load_scene(file)
    assert len(load_scene(f"{file}@layer=sheds").obstacles) == 2
    with pytest.raises(SceneError, match=r"no layer 'shed'.*Did you mean 'sheds'\?"):
        load_scene(f"{file}@layer=shed")


def test_degrees_are_refused_with_the_command_that_mends_them(tmp_path):
    house = [shapely.box(11.5, -48.2, 11.6, -48.1)]
    file = write(tmp_path / "town.gpkg", house, crs="EPSG:4326")
    with pytest.raises(SceneError) as error:
        load_scene(file)
    assert str(error.value) == (
        "town.gpkg: its coordinates are degrees ('EPSG:4326'), and a scene's are metres. "
        "Project it: ogr2ogr -t_srs EPSG:32732 metres.gpkg town.gpkg"
    )


def test_feet_are_refused(tmp_path):
    file = write(tmp_path / "town.gpkg", [shapely.box(9e5, 2e5, 9.1e5, 2.1e5)], crs="EPSG:2263")
    with pytest.raises(SceneError, match="not known to be planar and in metres"):
        load_scene(file)


@pytest.mark.parametrize(
    ("crs", "planar"),
    [
        (None, True),
        ("EPSG:25832", True),
        ("EPSG:4258", False),
        ('PROJCS["site",GEOGCS["x",UNIT["Degree",0.0174]],PARAMETER["a",1],UNIT["metre",1]]', True),
        ('PROJCS["site",GEOGCS["x",UNIT["Degree",0.0174]],UNIT["Foot_US",0.3048006]]', False),
        ('LOCAL_CS["site",UNIT["m",1.0]]', True),
        ('GEOGCS["WGS 84",UNIT["degree",0.0174532925199433]]', False),
        ("nonsense", False),
    ],
)
def test_a_reference_system_is_planar_metres_or_refused(crs, planar):
    if planar:
        check_projection("a.shp", crs, (0, 0, 1, 1))
    else:
        with pytest.raises(SceneError, match=r"^a\.shp: its coordinates"):
            check_projection("a.shp", crs, (0, 0, 1e6, 1e6))


@pytest.mark.parametrize("name", ["town.gpkg", "town.shp", "town.dxf"])
def test_a_file_that_is_none_says_so(tmp_path, name):
    file = tmp_path / name
    file.write_bytes(b"nothing of the kind")
    with pytest.raises(
        SceneError, match=rf"^{name}: (GDAL can't read it|holds no|no DXF, or cut off)"
    ):
        load_scene(file)
    with pytest.raises(SceneError, match=r"gone\.shp: can't be read \(there is no such file\)"):
        load_scene(tmp_path / "gone.shp")


def test_a_dxf_that_is_cut_off_is_refused_for_which_gdal_would_wait_forever(tmp_path):
    file = tmp_path / "plan.dxf"
    file.write_text(
        "0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n8\nwalls\n90\n4\n70\n1\n10\n0\n20\n0\n10\n3\n20\n0"
    )
    with pytest.raises(
        SceneError, match=r"^plan\.dxf: no DXF, or cut off: its last line is not EOF"
    ):
        load_scene(file)


def test_without_gdal_the_error_says_what_to_install(tmp_path, monkeypatch):
    monkeypatch.setattr(vector, "pyogrio", None)
    file = tmp_path / "town.shp"
    file.write_bytes(b"")
    with pytest.raises(SceneError, match=r"Run: pip install 'kbga-bench\[gdal\]'$"):
        load_scene(file)
