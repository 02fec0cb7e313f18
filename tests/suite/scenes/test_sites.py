"""Random building sites hold at places on earth, and in rooms from 1 mm to 1,000 km."""

import numpy as np
import pytest
import shapely

from suite.errors import SceneError
from tests.perf.sites import TOO_COARSE, Findings, Judges, as_scene, examined, sites
from tests.sites import PLACES, ROOMS, Site, draw_site, placed

ROUGH = "1 mm"
"""In a room of this size, float64 can't tell places apart anywhere on a map of the earth."""

GOOD = [room for room in ROOMS if room not in (ROUGH, "10 cm")]

SAMPLE = 3


def said(found: Findings) -> str:
    return f"{found}"[:2000]


@pytest.mark.parametrize("room", GOOD)
@pytest.mark.parametrize("place", PLACES)
def test_a_sample_of_sites_is_the_same_there_as_at_the_origin(place, room):
    found = examined(place, room, SAMPLE)
    assert found.holds, said(found)
    assert found.draws - found.too_coarse == SAMPLE


@pytest.mark.slow
@pytest.mark.parametrize("room", GOOD)
@pytest.mark.parametrize("place", PLACES)
def test_a_thousand_sites_are_the_same_there_as_at_the_origin(place, room):
    found = examined(place, room, 1000)
    assert found.holds, said(found)
    assert found.too_coarse == 0


@pytest.mark.parametrize("room", [ROUGH, "10 cm"])
def test_sites_of_a_hand_and_smaller_hold_at_the_origin(room):
    found = examined("the origin", room, 2 * SAMPLE)
    assert found.holds, said(found)
    assert found.too_coarse == 0


def test_sites_of_a_hand_hold_on_a_map():
    found = examined("Lambert-93 Paris", "10 cm", SAMPLE)
    assert found.holds, said(found)


@pytest.mark.parametrize("place", [place for place in PLACES if place != "the origin"])
def test_where_float64_is_too_coarse_for_a_room_that_is_said(place):
    (site,) = sites(place, ROUGH, 1)
    with pytest.raises(SceneError) as caught:
        as_scene(site)
    assert str(caught.value).endswith(TOO_COARSE)


def test_a_site_is_the_decimal_numbers_of_the_map_and_at_the_origin_not_rounded_again():
    drawn = draw_site(np.random.default_rng(5))
    site = placed(drawn, "UTM 32N Munich", "100 m")
    xy, units = (shapely.get_coordinates(s.buildings) for s in (site, drawn))
    x, y = 691608.2, 5334765.7
    wanted = [[round(x + n / 1000, 3), round(y + m / 1000, 3)] for n, m in units]
    assert xy.tolist() == wanted
    at_origin = shapely.get_coordinates(site.at_origin().buildings)
    assert (at_origin + site.corner).tolist() == xy.tolist()
    assert np.abs(at_origin - units / 1000).max() < 1e-9


def test_a_lost_obstacle_is_found_lost_and_another_optimum_another():
    # What the study says of a site of which a building is left out behind its back.
    (site,) = sites("UTM 32N Munich", "100 m", 1)
    whole = as_scene(site)
    site_without = Site(site.room, site.buildings[1:], site.queries, site.unit)
    judges = Judges(as_scene(site_without), site, site.at_origin())
    assert judges.has_lost()
    assert not Judges(whole, site, site.at_origin()).has_lost()
    middle = np.array(site.buildings[0].representative_point().coords[0])
    assert not judges.agree(np.array([middle, middle + 0.001]))
