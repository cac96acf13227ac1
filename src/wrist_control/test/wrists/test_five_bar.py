"""The spherical five-bar pointer against its loop closure, drawn with vectors."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import UnreachableError, fly
from wrist_control.operating.maneuvers import Maneuver, Segment
from wrist_control.wrists.five_bar import FiveBar

# The hand stops this far before its edge: `soft_edge`.
STOP = 0.02

WRIST = FiveBar()
inside = st.tuples(st.floats(-1.4, 1.4), st.floats(-1.4, 1.4))


def moving_joints(t1, t2):
    """Return the ends of the actuated links: 90° from the axes y and -x that turn them."""
    return (
        np.array([math.cos(t1), 0.0, -math.sin(t1)]),
        np.array([0.0, math.cos(t2), -math.sin(t2)]),
    )


@given(inside)
def test_both_distal_links_span_a_right_angle_to_the_pointing_axis(positions):
    first, second = moving_joints(*positions)
    rotation = WRIST.forward(positions).rotation
    assert rotation[2] @ first == pytest.approx(0.0, abs=1e-12)
    assert rotation[2] @ second == pytest.approx(0.0, abs=1e-12)
    assert rotation[2, 2] > 0.0
    np.testing.assert_allclose(rotation[0], first, atol=1e-12)


@given(inside)
def test_pointing_direction_has_the_tangents_of_the_joints(positions):
    x, y, z = WRIST.forward(positions).rotation[2]
    assert (x / z, y / z) == pytest.approx(tuple(math.tan(t) for t in positions), abs=1e-9)


@given(st.tuples(st.floats(-4.0, 4.0), st.floats(-4.0, 4.0)))
def test_inverse_undoes_forward_in_every_assembly(positions):
    if min(abs(math.cos(x)) for x in positions) > 1e-3:
        found = WRIST.inverse(WRIST.forward(positions), positions)
        assert found == pytest.approx(positions, abs=1e-9)


def test_both_joints_at_a_right_angle_leave_the_hand_loose():
    with pytest.raises(UnreachableError, match='loose'):
        WRIST.forward((0.5 * math.pi, 0.5 * math.pi))


@pytest.mark.parametrize('limit', [None, 1.0])
@pytest.mark.parametrize('heading', np.linspace(0.0, 6.0, 9))
def test_equator_is_neared_without_overshoot_and_left_freely(heading, limit):
    p, q = math.cos(heading), math.sin(heading)
    there = Maneuver('x', (Segment((p, q, 0.0), 2.5), Segment((-p, -q, 0.0), 0.5)), waits=False)
    flight = fly(WRIST, there, rate=50.0, joint_rate_limits=limit)
    tilt = np.degrees(np.arccos(flight.hand_rotation[:, 2, 2]))
    assert flight.margin.min() >= STOP - 1e-9
    assert 88.0 < tilt.max() < 90.0
    assert tilt[-1] < tilt.max() - 3.0


def test_edge_is_named():
    there = Maneuver('x', (Segment((1.0, 0.3, 0.0), 2.5),), waits=False)
    assert fly(WRIST, there).limited[-2] == ('equator',)


def test_a_long_step_cannot_jump_over_the_equator():
    pose = WRIST.forward((math.radians(85.0), 0.0))
    with pytest.raises(UnreachableError, match='equator'):
        WRIST.target_pose(pose, (0.0, 1.0, 0.0), math.radians(10.0))


def test_the_hand_is_loose_within_a_thousand_millionth_of_both_joints_at_a_right_angle():
    right = 0.5 * math.pi
    WRIST.forward((right - 3e-9, right))
    with pytest.raises(UnreachableError, match='the hand is loose'):
        WRIST.forward((right - 3e-10, right))
