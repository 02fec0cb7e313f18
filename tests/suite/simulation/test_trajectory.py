"""Where the robot was when: lengths, waiting, the first time near a place, gates passed."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from suite.simulation.trajectory import Trajectory, crossings, make_trajectory

GATE = [(0, 4), (2, 4)]
whole = st.integers(0, 8).map(float)


@st.composite
def trajectories(draw: st.DrawFn) -> Trajectory:
    places = draw(st.lists(st.tuples(whole, whole), min_size=2, max_size=6))
    steps = draw(st.lists(st.integers(1, 5), min_size=len(places), max_size=len(places)))
    return make_trajectory((t, *p) for t, p in zip(np.cumsum(steps).tolist(), places, strict=True))


def test_its_length_and_the_time_that_it_waited():
    way = make_trajectory([(0, 0, 0), (2, 3, 4), (5, 3, 4), (6, 3, 5)])
    assert (way.length, way.waiting_s, way.end) == (6.0, 3.0, 6.0)


@given(trajectories(), st.tuples(whole, whole), st.sampled_from([0.5, 1.0, 3.0]))
def test_the_first_time_near_a_place_is_the_one_that_fine_samples_find(way, place, distance):
    times = np.linspace(way.times[0], way.end, 4001)
    near = np.hypot(*(way.at(times) - place).T) <= distance
    found = way.first_within(place, distance)
    if near.any():
        assert found is not None
        assert times[np.argmax(near)] - 0.011 <= found <= times[np.argmax(near)] + 1e-9
    elif found is not None:  # between two samples
        assert np.hypot(*(way.at(found)[0] - place)) == pytest.approx(distance, abs=1e-9)


@pytest.mark.parametrize(
    ("rows", "times"),
    [
        ([(0, 1, 0), (4, 1, 8)], [2.0]),
        ([(0, 1, 0), (4, 1, 8), (8, 1, 0)], [2.0, 6.0]),
        ([(0, 1, 0), (2, 1, 4), (4, 1, 8)], [2.0]),
        ([(0, 1, 0), (2, 1, 4), (4, 1, 0)], []),
        ([(0, 1, 0), (2, 1, 4), (3, 2, 4), (5, 2, 8)], [3.0]),
        ([(0, 3, 0), (4, 3, 8)], []),
    ],
    ids=["through", "and back", "a bend in it", "touched", "along it and on", "beside it"],
)
def test_a_gate_is_passed_when_the_robot_gets_to_its_other_side(rows, times):
    found = crossings(make_trajectory(rows), "door", GATE)
    assert [crossing.time for crossing in found] == times
