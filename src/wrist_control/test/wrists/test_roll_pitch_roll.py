"""The conventional industrial wrist against explicit rotations. [McKinney1988], figs. 1 and 2."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import InvalidValueError, fly
from wrist_control.operating.maneuvers import Maneuver, turn
from wrist_control.resolving import start, step
from wrist_control.wrists.roll_pitch_roll import RollPitchRoll

WRIST = RollPitchRoll()


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0))
def test_at_lock_the_hand_roll_stays_and_the_forearm_roll_takes_the_whole_turn(first, third):
    pose = WRIST.forward((first, 0.0, third))
    near = (first + 0.2, 0.0, third - 0.2)
    found = WRIST.inverse(pose, near)
    assert found[2] == pytest.approx(near[2], abs=1e-7)
    assert found[1] == pytest.approx(0.0, abs=1e-7)
    assert math.cos(found[0] + found[2] - first - third) == pytest.approx(1.0)


def test_it_locks_where_hand_and_forearm_are_in_line():
    assert WRIST.margin((0.3, 0.0, -0.7)) == 0.0
    assert WRIST.margin((0.3, math.pi, -0.7)) == pytest.approx(0.0, abs=1e-15)
    assert WRIST.margin((0.0, 0.5 * math.pi, 0.0)) == 1.0
    # Lost is the rotation square to the pitch axis and to the two rolls, which are in line.
    assert np.linalg.matrix_rank(WRIST.jacobian((0.3, 0.0, 0.0)), tol=1e-9) == 2
    np.testing.assert_allclose(np.abs(WRIST.lost_axis((0.3, 0.0, 0.0))), (0.0, 0.0, 1.0))


def test_home_is_refused_at_lock_and_is_halfway_from_it():
    assert WRIST.margin(WRIST.home) == pytest.approx(0.5)
    with pytest.raises(InvalidValueError, match='at lock'):
        start(WRIST, (0.0, 0.0, 0.0))


def test_pitching_through_the_middle_of_the_workspace_is_easy_but_yawing_there_is_not():
    limit = math.radians(32.0)
    through = Maneuver('through', (turn(1, math.radians(-60.0), limit),))
    straight = fly(WRIST, through, 64.0, limit)
    assert straight.time_lost[-1] == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(
        straight.joint_positions[-1], (0.0, math.radians(-30.0), 0.0), atol=1e-9
    )
    aside = Maneuver('aside', (turn(1, math.radians(-29.0), limit), turn(2, 0.5, limit)))
    held_up = fly(WRIST, aside, 64.0, limit)
    assert held_up.completed
    assert held_up.time_lost[-1] > 2.0
    assert np.abs(held_up.joint_rates).max() <= limit * (1.0 + 1e-9)


def test_stopped_exactly_at_lock_it_gets_out_late_but_never_fast():
    limit = math.radians(32.0)
    state = start(WRIST.with_limits(rates=limit))
    wrist = WRIST.with_limits(rates=limit)
    # 30 steps of 1° to θ5 = 0, then yaw: θ4 and θ6 must turn by 90° first.
    for _ in range(30):
        state = step(wrist, state, (0.0, -limit, 0.0), 1.0 / 32.0).state
    assert wrist.margin(state.positions) < 1e-12
    lost = state.time_lost
    for _ in range(200):
        made = step(wrist, state, (0.0, 0.0, limit), 1.0 / 32.0)
        assert np.abs(made.joint_rates).max() <= limit * (1.0 + 1e-9)
        state = made.state
    assert wrist.margin(state.positions) > 0.5
    assert state.time_lost - lost == pytest.approx(2.8, abs=0.1)
