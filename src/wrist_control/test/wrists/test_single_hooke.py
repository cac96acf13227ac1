"""The single Hooke joint against explicit rotations and spherical trigonometry. [McKinney1988]."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import InvalidValueError, fly, make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, turn
from wrist_control.resolving import start, step
from wrist_control.wrists.single_hooke import SingleHooke

WRIST = SingleHooke()
angles = st.floats(-3.0, 3.0)
bends = st.floats(-1.4, 1.4)
joints = st.tuples(angles, bends, bends)


@given(joints)
def test_the_room_is_that_of_a_cone_about_the_forearm(positions):
    (cone,) = WRIST.clearances(positions)
    cos_bend = WRIST.forward(positions).rotation[0, 0]  # x of the hand along x of the forearm
    assert cone.remaining == pytest.approx(cos_bend - math.cos(math.radians(45.0)), abs=1e-12)


def test_on_the_cone_a_command_that_leads_barely_inward_still_moves():
    """A whole step would curve back out of the cone, a shorter one does not."""
    state = start(WRIST, (0.0, math.radians(45.0), 0.0))
    made = step(WRIST, state, (0.0, -0.002, 0.5), 0.05)
    assert 0.0 < made.scale_factor < 1.0
    assert WRIST.clearances(made.state.positions)[0].remaining >= -1e-9
    outward = step(WRIST, state, (0.0, 0.002, 0.5), 0.05)
    assert outward.scale_factor < 1e-4


@pytest.mark.parametrize('speed', [1e-6, 1e-3, 0.5])
def test_pushing_against_the_cone_for_long_does_not_creep_out_of_it(speed):
    state = start(WRIST, (0.0, math.radians(45.0), 0.0))
    for _ in range(1000):
        state = step(WRIST, state, (0.0, speed, 0.2 * speed), 0.01).state
    assert WRIST.clearances(state.positions)[0].remaining > -2.1e-9


def test_the_basic_maneuver_ends_at_the_cone():
    flight = fly('single_hooke', 'basic_test', patience=2.0)
    assert not flight.completed
    np.testing.assert_allclose(np.degrees(flight.joint_positions[-1]), (0.0, 45.0, 0.0), atol=1e-6)
    assert flight.limited[-2] == ('cone',)


@pytest.mark.parametrize('azimuth', np.radians([0.0, 20.0, 90.0, 200.0]))
@pytest.mark.parametrize('bend', np.radians([10.0, 44.0]))
def test_equation_5_holds_for_the_driver_angle_gamma(azimuth, bend):
    """Roll the hand with its direction held, as in Shigley: gamma falls by what phi rises."""
    to_bend = Maneuver('bend', (turn(1, bend * math.cos(azimuth), 0.5),))
    aside = Maneuver('aside', (turn(2, bend * math.sin(azimuth), 0.5),))
    there = fly(WRIST, to_bend, 50.0).joint_positions[-1]
    there = fly(WRIST, aside, 50.0, initial_positions=there).joint_positions[-1]
    roll = fly(WRIST, Maneuver('roll', (turn(0, math.tau, 1.0),)), 50.0, initial_positions=there)
    rows = list(zip(roll.joint_positions[:-1], roll.command[:-1], strict=True))
    ratios, sums = [], []
    for (phi, theta, psi), command in rows:
        gamma = math.atan2(math.sin(psi), math.sin(theta) * math.cos(psi))
        cos_bend = math.cos(theta) * math.cos(psi)
        printed = cos_bend / (1.0 - math.sin(gamma) ** 2 * (1.0 - cos_bend**2))
        ratios.append(command[0] / WRIST.rates((phi, theta, psi), command)[0] / printed)
        sums.append(phi + gamma)
    np.testing.assert_allclose(ratios, 1.0, atol=1e-9)
    np.testing.assert_allclose(np.ptp(np.unwrap(sums)), 0.0, atol=1e-9)


def test_pure_roll_is_uneven_by_the_square_of_the_bend():
    roll = Maneuver('roll', (turn(0, math.tau, BARKER_SPEED),))
    flight = fly(WRIST, roll, initial_positions=(0.0, math.radians(45.0), 0.0))
    assert flight.completed
    rates = np.array(
        [WRIST.rates(*row)[0] for row in zip(flight.joint_positions, flight.command, strict=True)]
    )[:-1]
    # From p cos β (bent in the plane of θ) to p / cos β (in the plane of ψ), or the other way.
    assert rates.max() / BARKER_SPEED == pytest.approx(math.sqrt(2.0), abs=1e-3)
    assert rates.min() / BARKER_SPEED == pytest.approx(math.sqrt(0.5), abs=1e-3)


@pytest.mark.parametrize('half_angle', [0.0, math.radians(90.0), 2.0, -0.5, math.nan])
def test_a_cone_past_90_deg_is_refused(half_angle):
    with pytest.raises(InvalidValueError, match=r'cone_half_angle is .*below 90 deg'):
        make_wrist('single_hooke', cone_half_angle=half_angle)
