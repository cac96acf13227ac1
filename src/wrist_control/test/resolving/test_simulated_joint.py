"""The joint that stands in for hardware keeps its limits on the way to any target."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.resolving.simulated_joint import follow
from wrist_control.wrists import Joint

numbers = st.floats(-100.0, 100.0)
JOINT = Joint('psi', lower=-1.0, upper=2.0, rate_limit=0.5)


@given(st.floats(-1.0, 2.0), numbers, st.floats(1e-3, 1.0))
def test_it_never_leaves_its_range_nor_exceeds_its_rate(position, target, dt):
    after = follow(JOINT, position, target, dt)
    assert -1.0 <= after <= 2.0
    assert abs(after - position) <= 0.5 * dt * (1.0 + 1e-9) + 1e-12


@given(st.floats(-1.0, 2.0), st.floats(-1.0, 2.0), st.floats(1e-3, 1.0))
def test_it_goes_straight_to_its_target_and_stays_there(position, target, dt):
    after = follow(JOINT, position, target, dt)
    assert abs(target - after) <= abs(target - position)
    assert after == target or abs(after - position) == pytest.approx(0.5 * dt)
    assert follow(JOINT, target, target, dt) == target


@given(numbers, numbers)
def test_without_limits_it_is_there_at_once(position, target):
    assert follow(Joint('psi'), position, target, 0.01) == target


@pytest.mark.parametrize('outside', [5.0, -5.0, math.nextafter(2.0, 3.0)])
def test_from_outside_its_range_it_comes_back_no_faster_than_it_may(outside):
    after = follow(JOINT, outside, outside, 0.1)
    assert abs(after - outside) <= 0.05 + 1e-12
    assert abs(after - 0.5) < abs(outside - 0.5)
