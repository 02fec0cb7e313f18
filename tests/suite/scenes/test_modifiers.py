import re

import numpy as np
import pytest

from suite.errors import SceneError
from suite.scenes.catalogue import has_scene, load_scene, scene_file
from suite.scenes.modifiers import expand_twins, parse_modifiers, split_modifiers


def parsed(text: str):
    return parse_modifiers(text, f"zigzag@{text}")


def test_modifiers_are_read_in_any_order():
    ordered, reversed_ = (
        parsed("turn=17,shift=0.37:-2,scale=1.5"),
        parsed("scale=1.5,shift=0.37:-2,turn=17"),
    )
    assert (ordered.turn, ordered.shift, ordered.scale) == (17.0, (0.37, -2.0), 1.5)
    assert (reversed_.turn, reversed_.shift, reversed_.scale) == (17.0, (0.37, -2.0), 1.5)


def test_a_single_shift_is_to_the_right():
    assert parsed("shift=0.37").shift == (0.37, 0.0)


def test_a_twin_is_drawn_from_its_seed_and_added_to_the_others():
    twin, again, other = parsed("twin=3"), parsed("twin=3"), parsed("twin=4")
    assert twin == again
    assert twin.turn != other.turn
    assert twin.scale == 1.0
    both = parsed("twin=3,turn=10,shift=1:1")
    assert both.turn == twin.turn + 10.0
    assert both.shift == (twin.shift[0] + 1.0, twin.shift[1] + 1.0)


def test_twins_are_turned_all_round_and_shifted_by_up_to_a_metre():
    twins = [parsed(f"twin={seed}") for seed in range(200)]
    turns, shifts = np.array([t.turn for t in twins]), np.array([t.shift for t in twins])
    assert 0.0 <= turns.min() < 10.0
    assert 350.0 < turns.max() < 360.0
    assert -1.0 <= shifts.min() < -0.9
    assert 0.9 < shifts.max() <= 1.0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "trun=17",
            "no modifier 'trun'. It takes turn, shift, scale, twin, radius, unknown, resolution, "
            "threshold, simplify. Did you mean 'turn'?",
        ),
        ("radius=-1", "radius is '-1'. Write radius=0.2, in metres, of 0 or more."),
        ("unknown=maybe", "unknown is 'maybe'. Write unknown=occupied or unknown=free."),
        ("resolution=0", "resolution is '0'. Write resolution=0.05, metres of a pixel, above 0."),
        ("turn", "turn has no value. Write turn=17, in degrees."),
        ("turn=", "turn has no value. Write turn=17, in degrees."),
        ("turn=east", "turn is 'east'. Write turn=17, in degrees."),
        ("turn=nan", "turn is 'nan'. Write turn=17, in degrees."),
        ("turn=1,turn=2", "turn comes twice. Give it once."),
        ("scale=0", "scale is '0'. Write scale=1.0137, above 0."),
        ("shift=1:2:3", "shift is '1:2:3'. Write shift=0.37 or shift=0.37:-0.21, in metres."),
        ("shift=1:", "shift is ''. Write shift=0.37 or shift=0.37:-0.21, in metres."),
        ("twin=-1", "twin is '-1'. Write twin=3, a whole number of 0 or more."),
        (
            "twin=1..9",
            "twin is '1..9'. Write twin=3, a whole number of 0 or more. Several at once, as in "
            "twin=1..10, are for matrices.",
        ),
    ],
)  # fmt: skip
def test_a_bad_modifier_is_named_with_how_to_mend_it(text, message):
    with pytest.raises(SceneError, match=f"^{re.escape(f'zigzag@{text}: {message}')}$"):
        load_scene(f"zigzag@{text}")


@pytest.mark.parametrize(("name", "what"), [("zigzag@", "a modifier"), ("@turn=3", "a scene")])
def test_a_mark_with_nothing_beside_it_is_refused(name, what):
    with pytest.raises(SceneError, match=f"{what} is missing beside the '@'"):
        load_scene(name)


def test_an_unknown_scene_is_named_without_its_modifiers():
    with pytest.raises(SceneError, match=r"^no scene 'mase'.*Did you mean 'maze'\?$"):
        load_scene("mase@turn=3")
    assert has_scene("maze@turn=3")
    assert not has_scene("mase@turn=3")


def test_a_file_may_be_modified_and_may_have_the_mark_in_its_own_name(tmp_path, monkeypatch):
    text = scene_file("zigzag").read_text(encoding="utf-8")
    folder = tmp_path / "me@home"
    folder.mkdir()
    mine, marked = folder / "mine.geojson", tmp_path / "mine.geojson@turn=5"
    mine.write_text(text, encoding="utf-8")
    assert load_scene(str(mine)).name == "zigzag"
    assert load_scene(f"{mine}@turn=5").name == "zigzag@turn=5"
    monkeypatch.chdir(folder)
    assert load_scene("mine.geojson@turn=5").name == "zigzag@turn=5"
    marked.write_text(text, encoding="utf-8")
    assert split_modifiers(str(marked)) == (str(marked), "")


def test_a_missing_file_with_the_mark_in_its_name_is_called_missing():
    with pytest.raises(SceneError, match=r"me@home\.geojson: can't be read"):
        load_scene("me@home.geojson")


def test_a_range_of_twins_stands_for_each_of_them():
    assert expand_twins("maze@turn=4,twin=9..11,scale=2") == [
        "maze@turn=4,twin=9,scale=2",
        "maze@turn=4,twin=10,scale=2",
        "maze@turn=4,twin=11,scale=2",
    ]
    with pytest.raises(SceneError, match=r"go from 3 to 1\. Give the lower one first\.$"):
        expand_twins("maze@twin=3..1")
