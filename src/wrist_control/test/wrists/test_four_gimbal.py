"""The four-gimbal wrist against explicit rotations, an ODE solver and [Barker1986]'s figures."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from wrist_control import InvalidValueError, fly, make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, Segment, extended_test
from wrist_control.resolving import start, step
from wrist_control.wrists.four_gimbal import FourGimbal

H = 1.0 / 32.0
WRIST = FourGimbal()
angles = st.floats(-3.0, 3.0)
unlocked = st.floats(-1.4, 1.4)
gimbals = st.tuples(angles, unlocked, angles, angles)
commands = st.tuples(*(st.floats(-1.0, 1.0),) * 3)


def clear_of_either_side(positions):
    """Return whether sin φ is far from 0, where round-off would have to choose a side."""
    return abs(math.sin(positions[2])) > 1e-6


def degrees(x):
    return np.degrees(np.asarray(x))


def peak(flight):
    return np.abs(degrees(flight.joint_rates)).max()


@given(gimbals)
def test_hand_turns_about_z_y_x_z_in_this_order(positions):
    psi, theta, phi, alpha = positions
    turned = Rotation.from_euler('ZYX', [psi, theta, phi]) * Rotation.from_euler('Z', alpha)
    pose = WRIST.forward(positions)
    np.testing.assert_allclose(pose.rotation, turned.as_matrix().T, atol=1e-12)
    assert pose.position == (0.0, 0.0, 0.0)


@given(gimbals)
def test_with_alpha_at_zero_it_is_the_three_gimbal_wrist(positions):
    three = make_wrist('three_gimbal')
    psi, theta, phi, _ = positions
    assert WRIST.forward((psi, theta, phi, 0.0)) == three.forward((psi, theta, phi))


@given(gimbals, st.floats(-0.3, 0.3))
def test_inverse_keeps_alpha_and_finds_the_same_hand(positions, change):
    pose = WRIST.forward(positions)
    near = (*positions[:3], positions[3] + change)
    found = WRIST.inverse(pose, near)
    assert found[3] == near[3]
    np.testing.assert_allclose(WRIST.forward(found).rotation, pose.rotation, atol=1e-9)


@given(gimbals.filter(clear_of_either_side), commands)
def test_rates_spend_the_fourth_gimbal_on_barkers_law(positions, twist):
    _, theta, phi, _ = positions
    law = -0.8 * math.sin(theta) * math.copysign(1.0, math.sin(phi))
    assert WRIST.rates(positions, twist)[3] == pytest.approx(law if any(twist) else 0.0)


@given(unlocked, st.floats(-1e-6, 1e-6), st.sampled_from([0.0, math.pi, -math.pi]))
def test_on_the_way_from_one_side_to_the_other_the_law_is_never_anything_between(theta, phi, base):
    rate = WRIST.rates((0.3, theta, base + phi, 0.5), (0.1, 0.2, 0.3))[3]
    assert abs(rate) == pytest.approx(0.8 * abs(math.sin(theta)))


@given(
    st.floats(0.1, 1.4), st.floats(0.1, 3.0), st.sampled_from([-1, 1]), st.sampled_from([-1, 1])
)
def test_the_fourth_gimbal_always_drives_theta_towards_zero(theta, phi, side, turn):
    positions = (0.3, side * theta, turn * phi, 0.5)
    unmoved = np.array(WRIST.rates(positions, (1e-12, 0.0, 0.0)))
    assert unmoved[1] * side < 0.0
    np.testing.assert_allclose(WRIST.jacobian(positions) @ unmoved, 0.0, atol=1e-9)


@pytest.mark.parametrize('phi', [1e-6, 1e-12, 0.0, -1e-12, -1e-15, math.pi, -math.pi])
def test_sgn_zero_is_positive_and_roundoff_does_not_choose_the_side(phi):
    rate = WRIST.rates((0.0, 0.2, phi, 0.0), (0.0, 0.5, 0.0))[3]
    assert rate == pytest.approx(-0.8 * math.sin(0.2))


@pytest.mark.parametrize('phi', [-1e-6, math.pi + 1e-6])
def test_just_beyond_roundoff_the_side_is_the_other_one(phi):
    rate = WRIST.rates((0.0, 0.2, phi, 0.0), (0.0, 0.5, 0.0))[3]
    assert rate == pytest.approx(0.8 * math.sin(0.2))


@pytest.mark.parametrize('theta', [5e-324, -5e-324, 1e-308])
@pytest.mark.parametrize('upper', [1.0, (0.0, 1.0, 0.0, 0.0)])
def test_a_theta_too_small_to_divide_by_is_stepped_like_zero(theta, upper):
    """The space before a limit is shared out by α̇, which is next to nothing here."""
    wrist = WRIST.with_limits(lower=-1.0, upper=upper)
    there, flat = start(wrist, (0.0, theta, 0.0, 0.0)), start(wrist)
    for twist in ((0.0, 0.3, 0.0), (0.0, 0.0, -0.3)):
        made = step(wrist, there, twist, H)
        assert made.state.positions == pytest.approx(step(wrist, flat, twist, H).state.positions)
        assert made.scale_factor == 1.0


def test_all_four_joints_can_turn_the_hand_where_the_resolver_locks():
    locked, both = (0.0, 0.5 * math.pi, 0.0, 0.0), (0.0, 0.5 * math.pi, 0.5 * math.pi, 0.0)
    assert np.linalg.matrix_rank(WRIST.jacobian(locked), tol=1e-9) == 3
    assert np.linalg.matrix_rank(WRIST.jacobian(both), tol=1e-9) == 2
    assert WRIST.margin(locked) == pytest.approx(0.0, abs=1e-15)
    nearly = (0.0, 0.5 * math.pi - 1e-4, 0.0, 0.0)
    assert WRIST.margin(nearly) == pytest.approx(1e-4)
    assert abs(WRIST.rates(nearly, (0.0, 0.0, 0.5))[0]) > 5000.0
    np.testing.assert_allclose(np.abs(WRIST.lost_axis(nearly)), (0.0, 0.0, 1.0), atol=1e-3)


def alpha_error(rate):
    """Return how far α is from an ODE solver's after pitching for 2 s."""
    pitch = (0.0, BARKER_SPEED, 0.0)
    maneuver = Maneuver('pitch', (Segment(pitch, 2.0),))
    from_here = (0.0, 0.1, 0.1, 0.0)
    flown = fly(WRIST, maneuver, rate, initial_positions=from_here).joint_positions[-1]
    truth = solve_ivp(
        lambda _, q: WRIST.rates(q, pitch), (0.0, 2.0), from_here, rtol=1e-11, atol=1e-12
    ).y[:, -1]
    np.testing.assert_allclose(flown, truth, atol=1e-2)
    return abs(flown[3] - truth[3])


def test_alpha_is_integrated_to_second_order():
    coarse, fine = alpha_error(32.0), alpha_error(128.0)
    assert coarse < 1e-3
    assert coarse / fine == pytest.approx(16.0, rel=0.15)


def test_a_pause_changes_nothing():
    pitch, still = Segment((0.0, 0.5, 0.0), 1.0), Segment((0.0, 0.0, 0.0), 0.5)
    straight = fly(WRIST, Maneuver('straight', (pitch, pitch)))
    paused = fly(WRIST, Maneuver('paused', (pitch, still, pitch)))
    during = paused.joint_positions[(paused.time > 1.0) & (paused.time < 1.5)]
    assert np.ptp(during, axis=0).max() == 0.0
    np.testing.assert_allclose(
        paused.joint_positions[-1], straight.joint_positions[-1], atol=1e-12
    )


def test_rate_scaling_slows_all_four_joints_and_keeps_the_path():
    free, limit = fly('four_gimbal'), math.radians(40.0)
    scaled = fly('four_gimbal', joint_rate_limits=limit)
    assert scaled.completed
    assert np.abs(scaled.joint_rates).max() <= limit * (1.0 + 1e-9)
    assert scaled.time_lost[-1] > 0.4
    # The tip stays on the two arcs, at 6 in. from the centre.
    # Within the one step that holds the end of the pitch and the start of the yaw they mix.
    np.testing.assert_allclose(scaled.tip[-1], free.tip[-1], atol=1e-4)
    on_first, on_second = np.abs(scaled.tip[:, 1]) < 1e-4, np.abs(scaled.tip[:, 0]) < 1e-4
    assert (on_first | on_second).all()
    # α follows its law along the path, not along the clock.
    assert scaled.joint_positions[-1, 3] == pytest.approx(free.joint_positions[-1, 3], abs=1e-2)


def test_alpha_at_its_own_limit_does_not_hold_the_hand():
    wrist = WRIST.with_limits(lower=(-9.0, -9.0, -9.0, -0.3), upper=(9.0, 9.0, 9.0, 0.3))
    flight = fly(wrist, 'basic_test')
    assert flight.completed
    assert flight.joint_positions[:, 3].min() >= -0.3
    assert flight.joint_positions[:, 3].min() < -0.25


def test_alpha_does_not_push_another_joint_against_its_limit():
    wrist = WRIST.with_limits(lower=(-0.5, -9.0, -9.0, -9.0), upper=(0.5, 9.0, 9.0, 9.0))
    state = start(wrist, (0.5, 0.6, 0.3, 0.0))
    assert wrist.rates(state.positions, (0.0, 1e-9, 0.0))[0] == pytest.approx(0.0, abs=1e-8)
    assert WRIST.rates(state.positions, (0.0, 1e-9, 0.0))[0] > 0.4
    inward = -np.sign(WRIST.rates(state.positions, (0.0, 0.0, 1.0))[0])
    made = step(wrist, state, (0.0, 0.0, 0.01 * inward), H)
    assert made.scale_factor == 1.0
    assert made.state.positions[0] < 0.5


@pytest.mark.parametrize('gain', [0.0, -0.8, math.nan, math.inf, 11.0, '0.8'])
def test_a_gain_that_cannot_work_is_refused(gain):
    with pytest.raises(InvalidValueError, match=r'gain is .*valid is 0.001 to 10 rad/s'):
        make_wrist('four_gimbal', gain=gain)


# [Barker1986], figures 9 to 11, h = 1/32 s and K = 0.8 unless said otherwise.


def test_figure_9_peak_rate_is_57_deg_s_and_theta_stays_within_45_deg():
    flight = fly('four_gimbal', 'basic_test')
    assert peak(flight) == pytest.approx(57.1723, abs=5e-4)  # paper: about 57
    assert peak(flight) / 32.0 == pytest.approx(1.8, abs=0.02)
    assert np.abs(degrees(flight.joint_positions[:, 1])).max() == pytest.approx(43.4254, abs=5e-4)
    assert flight.time_lost[-1] == 0.0
    np.testing.assert_allclose(flight.tip[90] / 0.0254, (0.0, 0.0, -6.0), atol=1e-12)
    np.testing.assert_allclose(flight.tip[-1] / 0.0254, (0.0, 6.0, 0.0), atol=1e-12)


def test_figure_9_instantaneous_rates_peak_where_the_increments_do():
    flight = fly('four_gimbal', 'basic_test')
    rates = [WRIST.rates(*row) for row in zip(flight.joint_positions, flight.command, strict=True)]
    assert np.abs(degrees(rates)).max() == pytest.approx(57.1816, abs=5e-4)


def test_figure_10_theta_approaches_44_deg_and_alpha_takes_over():
    flight = fly('four_gimbal', 'extended_test')
    psi, theta, phi, _ = degrees(flight.joint_positions[-1])
    limit = -math.degrees(math.asin(BARKER_SPEED / 0.8))  # where α̇ = r
    assert limit == pytest.approx(-44.2773, abs=5e-4)  # paper: -44
    assert theta == pytest.approx(limit, abs=0.1)
    assert (psi, phi) == pytest.approx((90.0, 90.0), abs=1e-9)
    rates = degrees(flight.joint_rates[-2])
    np.testing.assert_allclose(rates, (0.0, 0.0, 0.0, 32.0), atol=0.05)
    second = flight.tip[91:] / 0.0254
    np.testing.assert_allclose(second[:, 0], 0.0, atol=1e-12)


def test_the_other_sign_of_sgn_zero_mirrors_figure_10(monkeypatch):
    monkeypatch.setattr('wrist_control.wrists.four_gimbal.SIDE', 1e-9)
    psi, theta, phi, _ = degrees(fly('four_gimbal', 'extended_test').joint_positions[-1])
    assert (psi, phi) == pytest.approx((-90.0, -90.0), abs=1e-9)
    assert theta == pytest.approx(44.25, abs=0.1)


def test_sgn_zero_as_zero_would_drive_the_basic_maneuver_into_lock():
    class NoSide(FourGimbal):
        def _alpha_rate(self, positions):
            law, share = super()._alpha_rate(positions)
            return (law if abs(positions[2]) > 1e-12 else 0.0), share

    flight = fly(NoSide(), 'basic_test')
    assert flight.margin.min() < 1e-9
    assert peak(flight) == pytest.approx(90.0 * 32.0)


def test_figure_11_sixteen_deg_s_at_gain_08_stays_under_32():
    speed = math.radians(16.0)
    assert peak(fly('four_gimbal', extended_test(speed))) == pytest.approx(31.8366, abs=5e-4)


@pytest.mark.parametrize('speed', [32.0, 16.0])
def test_figure_11_has_its_lowest_peak_where_the_gain_is_a_little_above_the_rate(speed):
    gains = math.radians(speed) * np.array([1.1, 1.43, 1.8, 2.5, 4.0])
    peaks = [
        peak(fly('four_gimbal', extended_test(math.radians(speed)), gain=gain)) / speed
        for gain in gains
    ]
    assert peaks[-1] > peaks[-2]
    assert 1.7 < min(peaks) < 1.9


def test_figure_11_a_gain_below_the_rate_lets_theta_run_through_lock():
    flight = fly('four_gimbal', 'extended_test', gain=0.4)
    assert flight.margin.min() < 1e-3
    assert degrees(flight.joint_positions[-1, 1]) < -90.0
    # Exactly through lock nothing jumps on the nearest branch. The peak is |r| + 2 K, in the one
    # step after α̇ changes its sign; arctangents of a fixed range turn by 180° in a step instead.
    assert peak(flight) == pytest.approx(32.0 + 2.0 * degrees(0.4), abs=0.01)
    folded = np.cos(flight.joint_positions[:, 1]) < 0.0
    psi = flight.joint_positions[:, 0] + np.where(folded, math.pi, 0.0)
    assert np.abs(degrees(np.diff(psi)) * 32.0).max() == pytest.approx(180.0 * 32.0, rel=0.01)


@pytest.mark.parametrize(('phi', 'sign'), [(0.0, -1.0), (-5e-10, -1.0), (-5e-9, 1.0)])
def test_round_off_below_a_thousand_millionth_does_not_choose_the_side(phi, sign):
    """sgn 0 must be +1, and a φ that should be 0 and is not, the same."""
    rate = WRIST.rates((0.0, 0.5, phi, 0.0), (0.0, 0.1, 0.0))[3]
    assert rate == pytest.approx(sign * 0.8 * math.sin(0.5))
