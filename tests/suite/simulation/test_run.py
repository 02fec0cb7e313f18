"""The simulated run: what the robot does while it plans, waits, is hit, and when all that ends."""

import time
from collections.abc import Callable, Sequence

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import box

from baselines.visibility_graph import VisibilityGraphPlanner
from kbga.plugin import KBGAPlanner
from suite.planner import Budget, Plan, PlanAfresh, Planner, PlanStatus, Recorder, Replanner
from suite.scenes.catalogue import load_scene
from suite.scenes.dynamics import Detection, Dynamics, Removal, constant_speed, make_motion
from suite.scenes.scene import Obstacle, Query, Scene, make_scene
from suite.simulation.hits import hits
from suite.simulation.run import ENCLOSED, Outcome, Simulation, simulate
from suite.simulation.settings import Charge, WorldSettings
from tests.strategies import lattice_boxes, lattice_polygons

ROOM = box(0, 0, 20, 20)
ENDS = ((1, 10), (19, 10))
WORLD = WorldSettings(speed=2.0, interval=1.0, sensing_range=4.0, time_limit=60.0)
FREE = WorldSettings(2.0, 1.0, 4.0, 60.0, charge=Charge.ZERO)


def scene_of(*obstacles: Obstacle, ends: tuple = ENDS) -> Scene:
    return make_scene("drawn", ROOM, obstacles, ends)


def exact() -> Replanner:
    return VisibilityGraphPlanner().replanner(np.random.default_rng(0))


def run(
    *obstacles: Obstacle, world: WorldSettings = FREE, replanner: Replanner | None = None
) -> Simulation:
    scene = scene_of(*obstacles)
    return simulate(scene, scene.query(), replanner or exact(), world)


class Scripted(Replanner):
    """Answers as it is told, one answer for each call, the last for all that follow."""

    def __init__(self, *answers: Callable[[Scene, Query], Plan]) -> None:
        self.answers = list(answers)
        self.queries: list[Query] = []
        self.scenes: list[Scene] = []

    def begin(self, scene: Scene, query: Query, budget: Budget, recorder: Recorder) -> Plan:
        return self.update(scene, query, budget, recorder)

    def update(self, scene: Scene, query: Query, *_: Budget | Recorder) -> Plan:
        self.queries.append(query)
        self.scenes.append(scene)
        answer = self.answers.pop(0) if len(self.answers) > 1 else self.answers[0]
        return answer(scene, query)


def over(*places: Sequence[float]) -> Callable[[Scene, Query], Plan]:
    """An answer: the path over these places."""
    return lambda _, query: Plan(
        PlanStatus.SOLVED, np.array([query.start, *places, query.goal], dtype=np.float64)
    )


def nothing(_scene: Scene, _query: Query) -> Plan:
    return Plan(PlanStatus.EXHAUSTED)


@pytest.fixture
def slowly(monkeypatch: pytest.MonkeyPatch):
    """Answers that take so many seconds of a clock that goes for them alone: none of this machine's
    own slowness is in it.
    """
    now = [0.0]
    monkeypatch.setattr(time, "perf_counter", lambda: now[0])

    def slow(seconds: float, answer: Callable[[Scene, Query], Plan]):
        def answered(scene: Scene, query: Query) -> Plan:
            now[0] += seconds
            return answer(scene, query)

        return answered

    return slow


def fail(_scene: Scene, _query: Query) -> Plan:
    raise RuntimeError("out of ideas")


# Driving


def test_the_robot_drives_along_its_path_at_its_speed_and_ends_at_the_goal():
    done = run()
    assert (done.outcome, done.reached) == (Outcome.REACHED, True)
    assert (done.trajectory.end, done.trajectory.length) == (9.0, 18.0)
    assert done.trajectory.xy[-1].tolist() == [19, 10]
    assert [replan.time for replan in done.replans] == list(range(9))
    assert [replan.cost for replan in done.replans] == [18.0 - 2.0 * t for t in range(9)]


def test_the_planner_is_asked_from_where_the_robot_is():
    planner = Scripted(over())
    run(replanner=planner)
    assert [query.start.tolist() for query in planner.queries[:3]] == [[1, 10], [3, 10], [5, 10]]


def test_it_is_handed_the_same_scene_as_long_as_nothing_changes():
    planner = Scripted(over())
    run(Obstacle("late", box(9, 1, 11, 2), Dynamics(appears=3.0)), replanner=planner)
    first, *_ = planner.scenes
    assert [scene is first for scene in planner.scenes[:5]] == [True, True, True, False, False]


def test_an_obstacle_that_is_detected_in_the_way_is_driven_around():
    wall = Obstacle("wall", box(9, 6, 11, 14), Dynamics(detection=Detection()))
    done = run(wall)
    assert done.reached
    assert done.hits == ()
    assert [replan.changed for replan in done.replans].count(True) == 1
    assert done.trajectory.length > 18.0


def test_one_that_is_detected_too_late_is_a_hit():
    wall = Obstacle("wall", box(8, 6, 11, 14), Dynamics(detection=Detection(0.0)))
    done = run(wall)
    assert [hit.obstacle for hit in done.hits] == ["wall"]
    assert done.hits[0].time == pytest.approx(3.5, abs=1e-5)
    assert done.replans[-1].status == ENCLOSED


# Waiting


def test_without_a_path_it_waits_and_asks_again():
    gate = Obstacle("gate", box(9, 0, 11, 20), Dynamics(removal=Removal(time=2.5)))
    done = run(gate)
    assert done.reached
    assert done.hits == ()
    assert [replan.status for replan in done.replans[:4]] == [*["infeasible"] * 3, "solved"]
    assert done.trajectory.waiting_s == pytest.approx(3.0)


def test_a_planner_that_finds_nothing_leaves_it_on_its_old_path_while_that_is_free():
    done = run(replanner=Scripted(over(), nothing))
    assert done.reached
    assert done.trajectory.waiting_s == 0.0


def test_it_leaves_an_old_path_that_is_known_to_be_blocked():
    late = Obstacle("late", box(15, 5, 16, 15), Dynamics(appears=2.0))
    done = run(late, replanner=Scripted(over(), nothing))
    assert (done.outcome, done.hits) == (Outcome.OUT_OF_TIME, ())
    assert done.trajectory.xy[-1].tolist() == [5, 10]


def test_a_path_that_the_referee_rejects_is_none():
    wall = Obstacle("wall", box(9, 6, 11, 14))
    done = run(wall, replanner=Scripted(over()))
    assert {replan.status for replan in done.replans} == {"invalid"}
    assert "enters wall at (9, 10)" in str(done.replans[0].reason)
    assert done.trajectory.length == 0.0


def count_oddly(*_):
    return Plan(PlanStatus.EXHAUSTED, checks=float("nan"))


@pytest.mark.parametrize(
    "answer",
    [fail, lambda *_: None, count_oddly],
    ids=["raises", "returns nothing", "counts NaN checks"],
)
def test_a_planner_that_fails_is_an_update_without_a_path(answer):
    done = run(replanner=Scripted(over(), answer))
    assert done.reached
    assert {replan.status for replan in done.replans[1:]} == {"error"}
    assert all(replan.reason for replan in done.replans[1:])


def test_every_run_ends_at_its_time_limit():
    done = run(replanner=Scripted(nothing), world=WorldSettings(2.0, 0.7, 4.0, 5.0))
    assert (done.outcome, done.trajectory.end) == (Outcome.OUT_OF_TIME, 5.0)


# The time that planning takes


def test_the_robot_waits_for_its_first_path(slowly):
    done = run(world=WORLD, replanner=Scripted(slowly(0.2, over()), over()))
    assert done.trajectory.waiting_s == pytest.approx(0.2)
    assert done.trajectory.end == pytest.approx(9.2)


def test_it_goes_on_along_its_old_path_while_it_plans_and_joins_the_new_one_straight(slowly):
    done = run(world=WORLD, replanner=Scripted(over(), slowly(0.2, over((12, 12))), over()))
    way = done.trajectory
    assert way.at(1.2)[0].tolist() == pytest.approx([3.4, 10.0], abs=0.05)
    after = way.at(1.9)[0]
    assert after[1] > 10.0
    assert way.waiting_s == pytest.approx(0.0, abs=1e-9)


def test_it_does_not_drive_into_what_it_knows_while_it_plans(slowly):
    late = Obstacle("late", box(6, 5, 7, 15), Dynamics(appears=2.0))
    planner = Scripted(over(), over(), slowly(0.8, over((6, 4), (7, 4))), over())
    done = run(late, world=WORLD, replanner=planner)
    assert done.reached
    assert done.hits == ()
    assert done.trajectory.at(2.7)[0].tolist() == pytest.approx([5.0, 10.0], abs=0.05)


def test_an_update_that_finds_the_planner_at_work_does_not_ask_it(slowly):
    planner = Scripted(over(), slowly(1.3, over()), over())
    done = run(world=WORLD, replanner=planner)
    times = [round(replan.time) for replan in done.replans[:4]]
    assert times == [0, 1, 3, 4]


def test_a_path_that_comes_late_is_not_taken_into_what_is_known_by_then(slowly):
    late = Obstacle("late", box(12, 5, 13, 15), Dynamics(appears=2.0))
    planner = Scripted(over(), slowly(1.3, over()), nothing)
    done = run(late, world=WORLD, replanner=planner)
    assert done.hits == ()
    assert not done.reached


# Hits


def test_what_moves_onto_the_robot_is_a_hit_and_the_run_goes_on():
    slides = Obstacle("slides", box(0, 4, 3, 8), Dynamics(constant_speed((0.0, 1.0), 0.0, 20.0)))
    done = run(slides, replanner=Scripted(nothing, nothing, nothing, nothing, over()))
    assert [hit.obstacle for hit in done.hits] == ["slides"]
    assert done.hits[0].time == pytest.approx(2.0, abs=1e-5)


def test_what_appears_on_the_robot_is_a_hit_and_no_error():
    lid = Obstacle("lid", box(3, 8, 7, 12), Dynamics(appears=1.5, removal=Removal(time=5.5)))
    done = run(lid)
    assert [(hit.obstacle, hit.time) for hit in done.hits] == [("lid", 1.5)]
    assert [r.status for r in done.replans if 1.5 < r.time < 5.5] == [ENCLOSED] * 4
    assert done.reached, "the run goes on when it is gone"


# What must hold of every run


def random_dynamics(draw: st.DrawFn) -> Dynamics | None:
    shift = st.integers(-6, 6)
    motion = draw(st.none() | st.tuples(st.integers(1, 9), shift, shift))
    return draw(
        st.sampled_from(
            [
                None,
                Dynamics(make_motion([(0, 0, 0), motion])) if motion else None,
                Dynamics(detection=Detection(2.0)),
                Dynamics(appears=2.0),
                Dynamics(removal=Removal(time=3.0)),
                Dynamics(removal=Removal(None, (3.0, 3.0), 1.5)),
            ]
        )
    )


@st.composite
def dynamic_scenes(draw: st.DrawFn) -> Scene:
    polygons = draw(st.lists(lattice_boxes() | lattice_polygons(), min_size=1, max_size=5))
    obstacles = [
        Obstacle(f"o{i}", polygon, random_dynamics(draw)) for i, polygon in enumerate(polygons)
    ]
    return make_scene("random", box(0, 0, 9, 9), obstacles, ((9, 0), (0, 9)))


PLANNERS: list[type[Planner]] = [VisibilityGraphPlanner, KBGAPlanner]


@pytest.mark.parametrize("planner", PLANNERS)
@settings(max_examples=20)
@given(dynamic_scenes(), st.sampled_from([0.4, 1.0]), st.integers(0, 3))
def test_every_run_ends_and_its_story_is_consistent(planner, scene, interval, seed):
    world = WorldSettings(2.0, interval, 1.5, 25.0, charge=Charge.ZERO)
    replanner = planner().replanner(np.random.default_rng(seed))
    done = simulate(scene, scene.query(), replanner, world, Budget(generations=30))
    way = done.trajectory
    assert done.reached == np.array_equal(way.xy[-1], scene.query().goal)
    assert done.reached or way.end == 25.0
    assert np.all(np.diff(way.times) >= 0.0)
    steps, spans = np.hypot(*np.diff(way.xy, axis=0).T), np.diff(way.times)
    assert np.all(steps <= world.speed * spans + 2e-6), "faster than it can be"
    assert {r.status for r in done.replans} <= {"solved", "infeasible", "exhausted", ENCLOSED}
    assert done.hits == tuple(hits(scene, way))
    static = {o.name for o in scene.obstacles if o.dynamics is None}
    assert not static & {hit.obstacle for hit in done.hits}, "it drove into what it always knew"


def test_the_same_seed_gives_the_same_trajectory_when_planning_is_free():
    slides = Obstacle("slides", box(6, 4, 8, 12), Dynamics(constant_speed((0.5, 0.0), 0.0, 9.0)))

    def once(seed: int) -> Simulation:
        planner = KBGAPlanner().replanner(np.random.default_rng(seed))
        return run(slides, Obstacle("low", box(9, 0, 11, 9)), replanner=planner)

    one, same = once(5), once(5)
    assert one.trajectory.times.tobytes() == same.trajectory.times.tobytes()
    assert one.trajectory.xy.tobytes() == same.trajectory.xy.tobytes()


def test_any_planner_plans_afresh_at_each_update():
    replanner = VisibilityGraphPlanner().replanner(np.random.default_rng(0))
    assert isinstance(replanner, PlanAfresh)


@pytest.mark.parametrize("place", ["shift=691608.2:5334765.7", "turn=33,shift=-13500000.5:9000000"])
def test_the_same_scene_at_the_coordinates_of_a_map_has_the_same_story(place):
    world = WorldSettings(2.0, 2.0, 20.0, 200.0, charge=Charge.ZERO)
    here, there = (
        simulate(scene, scene.query(), exact(), world)
        for scene in (load_scene("door"), load_scene(f"door@{place}"))
    )
    assert here.reached
    assert there.reached
    assert not there.hits
    assert there.trajectory.end == pytest.approx(here.trajectory.end, abs=1e-4)
    assert len(there.replans) == len(here.replans)
