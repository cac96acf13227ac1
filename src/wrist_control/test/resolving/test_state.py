"""What a step hands on: the rates that it was made at, and the twist that it made."""

import math

import numpy as np
import pytest

from wrist_control import make_wrist
from wrist_control.resolving import start
from wrist_control.resolving.state import increments, resting, step_between, twist_between
from wrist_control.rotations import IDENTITY, Pose, turned

GIMBALS = make_wrist('three_gimbal')


def test_a_step_between_two_states_has_the_rates_that_lead_from_one_to_the_other():
    before = start(GIMBALS, (0.1, 0.2, 0.3))._replace(time_lost=1.0)
    after = start(GIMBALS, (0.1, 0.25, 0.2))
    taken = step_between(before, after, 0.5, 0.25, 0.7, True, ())
    assert taken.joint_rates == pytest.approx((0.0, 0.1, -0.2))
    assert taken.state.joint_rates == taken.joint_rates
    assert taken.state.positions == after.positions
    assert taken.state.time_lost == pytest.approx(1.0 + 0.75 * 0.5)
    assert (taken.scale_factor, taken.margin, taken.singular) == (0.25, 0.7, True)


def test_a_state_at_rest_has_no_rates():
    state = start(GIMBALS)
    assert step_between(state, state, 0.5, 1.0, 1.0, False, ()).state == state
    moving = state._replace(joint_rates=(1.0, 0.0, 0.0))
    assert resting(GIMBALS, moving).state == state
    assert resting(GIMBALS, moving).joint_rates == (0.0, 0.0, 0.0)


def test_increments_are_differences_over_time():
    assert increments((1.0, 2.0), (1.5, 1.0), 0.25) == (2.0, -4.0)


def test_a_twist_between_two_poses_is_in_the_axes_of_the_first():
    quarter = turned(IDENTITY, (0.0, 0.0, math.pi / 2.0), 1.0)
    before = Pose(quarter, (0.0, 0.0, 0.0))
    after = Pose(turned(quarter, (0.1, -0.2, 0.3), 2.0), (0.0, 1.0, 0.0))
    np.testing.assert_allclose(
        twist_between(before, after, 2.0), (0.5, 0.0, 0.0, 0.1, -0.2, 0.3), atol=1e-12
    )
