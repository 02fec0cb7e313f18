"""Packing the arrays and taking them apart again changes nothing."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from suite.geometry.arrangement import arrange
from suite.geometry.kernels import segment_enters
from suite.geometry.packed import pack, packed_segment_enters, unpack
from tests.suite.geometry.lattice import counts, random_segments, random_solid

seeds = st.integers(0, 2**32)


@settings(max_examples=counts(40, 20))
@given(seeds)
def test_unpacked_arrays_are_those_that_were_packed(seed):
    arrays = arrange(*random_solid(np.random.default_rng(seed))).arrays
    again = unpack(*pack(arrays))
    for name in arrays._fields:
        before, after = getattr(arrays, name), getattr(again, name)
        assert before.shape == after.shape, name
        assert np.array_equal(before, after), name


def test_arrays_without_obstacles_can_be_packed():
    room, _ = random_solid(np.random.default_rng(0))
    arrays = arrange(room, []).arrays
    again = unpack(*pack(arrays))
    assert all(np.array_equal(a, b) for a, b in zip(arrays, again, strict=True))


@settings(max_examples=counts(40, 10))
@given(seeds)
def test_packed_and_plain_kernels_agree(seed):
    rng = np.random.default_rng(seed)
    room, obstacles = random_solid(rng)
    arrays = arrange(room, obstacles).arrays
    packed = pack(arrays)
    for s in random_segments(rng, room, 50).tolist():
        assert packed_segment_enters(*s, *packed) == segment_enters(*s, arrays)
