import dataclasses

import pytest
import shapely

from baselines.ompl.adapter import Problem
from baselines.ompl.oneshot import (
    BFMTPlanner,
    BFMTSettings,
    FMTPlanner,
    FMTSettings,
    RRTConnectPlanner,
    RRTConnectSettings,
    RRTPlanner,
    RRTSettings,
)
from baselines.ompl.roadmap import PRMPlanner, PRMSettings, PRMstarPlanner, PRMstarSettings
from baselines.ompl.settings import RangeSettings
from baselines.ompl.shortcut import ShortcutPlanner, ShortcutSettings
from baselines.ompl.watched import (
    AORRTCPlanner,
    BITstarPlanner,
    BITstarSettings,
    InformedRRTstarPlanner,
    InformedRRTstarSettings,
    RRTstarPlanner,
    RRTstarSettings,
    SORRTstarPlanner,
    SORRTstarSettings,
)
from suite.planner import Budget, Recorder
from tests.baselines.ompl.laboratory import SCENES, run, scene_of

TREE = {
    "range": 3.0, "goal_bias": 0.2, "rewire_factor": 1.2, "k_nearest": False, "delay_cc": False,
    "tree_pruning": True, "prune_threshold": 0.1, "new_state_rejection": True,
}  # fmt: skip

MARCHING = {
    "num_samples": 300, "radius_multiplier": 1.3, "nearest_k": False, "cache_cc": False,
    "heuristics": False, "extended": False,
}  # fmt: skip

EVERY_SETTING = (
    RRTstarPlanner(RRTstarSettings(
        **TREE, informed_sampling=True, sample_rejection=False, ordered_sampling=False,
        batch_size=10,
    )),
    InformedRRTstarPlanner(InformedRRTstarSettings(
        **TREE, pruned_measure=False, sampling_attempts=50,
    )),
    SORRTstarPlanner(SORRTstarSettings(
        **TREE, pruned_measure=True, sampling_attempts=50, batch_size=30,
    )),
    BITstarPlanner(BITstarSettings(
        samples_per_batch=50, rewire_factor=1.2, k_nearest=False, strict_queue_ordering=True,
        pruning=True, prune_threshold=0.02, delay_rewiring=True, just_in_time_sampling=True,
        drop_samples_on_prune=True,
    )),
    AORRTCPlanner(RangeSettings(range=2.0)),
    RRTPlanner(RRTSettings(range=2.0, intermediate_states=True, goal_bias=0.2, simplify=False)),
    RRTConnectPlanner(RRTConnectSettings(range=2.0, intermediate_states=True, simplify=False)),
    FMTPlanner(FMTSettings(**MARCHING)),
    BFMTPlanner(BFMTSettings(**MARCHING)),
    ShortcutPlanner(ShortcutSettings(
        range=2.0, reach=0.2, narrowing=0.5, rounds=2, steps=50, empty_steps=20, rope=0.2,
        gain=0.01, hopeless=1.2,
    )),
    PRMPlanner(PRMSettings(
        slice_s=0.01, slice_checks=200, slice_growth=0.2, max_nearest_neighbors=5,
    )),
    PRMstarPlanner(PRMstarSettings(slice_s=0.01, slice_checks=200, slice_growth=0.2)),
)  # fmt: skip


@pytest.mark.parametrize("planner", EVERY_SETTING, ids=lambda p: p.name)
def test_every_setting_reaches_ompl(planner):
    left = [
        field.name
        for field in dataclasses.fields(planner.settings)
        if getattr(planner.settings, field.name) is None and "instead_of" not in field.metadata
    ]
    assert left == []
    assert run(planner, SCENES["one box"], Budget(checks=3000)).path is not None


@pytest.mark.parametrize("planner", EVERY_SETTING[:-1], ids=lambda p: p.name)
def test_settings_of_ompl_change_the_run(planner):
    default = type(planner)()
    costs = [
        run(p, SCENES["one box"], Budget(checks=4000)).claimed_cost for p in (planner, default)
    ]
    assert None not in costs
    assert costs[0] != costs[1]


@pytest.mark.parametrize("planner", [FMTPlanner, BFMTPlanner], ids=lambda p: p.name)
def test_the_number_of_samples_is_a_setting(planner):
    seen = [
        run(planner(planner.Settings(num_samples=n)), SCENES["one box"], Budget(checks=10_000))
        for n in (100, 1000)
    ]
    assert 100 <= seen[0].details["state_checks"] < 300
    assert 1000 <= seen[1].details["state_checks"] < 2000
    assert seen[1].claimed_cost < seen[0].claimed_cost


WITH_A_RANGE = (
    RRTstarPlanner, InformedRRTstarPlanner, SORRTstarPlanner, AORRTCPlanner, RRTPlanner,
    RRTConnectPlanner, ShortcutPlanner,
)  # fmt: skip


@pytest.mark.parametrize("planner", WITH_A_RANGE, ids=lambda p: p.name)
def test_a_share_of_the_side_of_free_space_is_the_range_that_ompl_reports(planner):
    wall = shapely.box(20, 0, 30, 40)
    scene = scene_of([wall], (1, 5), (9, 5), room=shapely.box(0, 0, 100, 40))
    for query, side in (("1,5:9,5", 40.0), ("31,5:99,5", 70.0)):
        problem = problem_of(planner(planner.Settings(range_share=0.1)), scene, scene.query(query))
        assert problem.planner.getRange() * problem.unit == pytest.approx(0.1 * side, rel=1e-12)


def problem_of(planner, scene, query):
    """What a run sets up, before it runs."""
    problem = Problem(scene, query, planner._build, Budget(checks=10), Recorder())
    problem.set_up()
    return problem


@pytest.mark.parametrize(("settings", "metres", "share"), [
    *((planner.Settings, "range", "range_share") for planner in WITH_A_RANGE),
    (ShortcutSettings, "rope", "rope_share"),
])  # fmt: skip
def test_a_length_in_metres_and_as_a_share_is_refused(settings, metres, share):
    with pytest.raises(ValueError, match=f"^{metres} is 2.0 and {share} is 0.1: .*not both"):
        settings(**{metres: 2.0, share: 0.1})


def test_a_short_range_makes_many_waypoints():
    near = RRTstarPlanner(RRTstarSettings(range=0.5))
    assert len(run(near, SCENES["one box"], Budget(checks=10_000)).path) >= 16


@pytest.mark.parametrize(("settings", "wrong"), [
    (RRTstarSettings, {"range": 0.0}),
    (RRTstarSettings, {"range_share": 0.0}),
    (RRTstarSettings, {"range_share": 10.0}),
    (RRTstarSettings, {"goal_bias": 1.5}),
    (RRTstarSettings, {"rewire_factor": 0.5}),
    (RRTstarSettings, {"batch_size": 0}),
    (RRTstarSettings, {"default_wall_s": 0.0}),
    (InformedRRTstarSettings, {"prune_threshold": -0.1}),
    (InformedRRTstarSettings, {"sampling_attempts": 0}),
    (SORRTstarSettings, {"batch_size": 0}),
    (BITstarSettings, {"samples_per_batch": 0}),
    (BITstarSettings, {"prune_threshold": 2.0}),
    (RangeSettings, {"range": -1.0}),
    (RRTConnectSettings, {"range": 0.0}),
    (RRTSettings, {"goal_bias": -0.1}),
    (FMTSettings, {"num_samples": 0}),
    (FMTSettings, {"nearest_k": False}),
    (BFMTSettings, {"radius_multiplier": 0.9}),
    (PRMSettings, {"max_nearest_neighbors": 0}),
    (ShortcutSettings, {"range": 0.0}),
    (ShortcutSettings, {"reach": 0.0}),
    (ShortcutSettings, {"narrowing": 0.0}),
    (ShortcutSettings, {"rounds": 0}),
    (ShortcutSettings, {"steps": 0}),
    (ShortcutSettings, {"empty_steps": 0}),
    (ShortcutSettings, {"rope": 0.0}),
    (ShortcutSettings, {"rope_share": 2.0}),
    (ShortcutSettings, {"gain": 2.0}),
    (ShortcutSettings, {"hopeless": 0.9}),
    (PRMstarSettings, {"slice_s": 0}),
    (PRMstarSettings, {"slice_checks": 0}),
    (PRMstarSettings, {"slice_growth": 0}),
    (PRMstarSettings, {"default_wall_s": 0}),
])  # fmt: skip
def test_settings_that_make_no_sense_are_refused(settings, wrong):
    (name,) = wrong
    with pytest.raises(ValueError, match=f"{name} is .*It must"):
        settings(**wrong)
