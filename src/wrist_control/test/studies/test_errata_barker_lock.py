"""[Barker1986], text on figure 11: how fast the gimbals must be with K below the hand's rate."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from wrist_control import fly
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, extended_test, turn

GAIN = 0.4
BY_THE_CLOCK = 'by the clock'


def maneuver(beyond):
    """Give the extended test maneuver with the pitch ending beyond vertical, deg."""
    if beyond == BY_THE_CLOCK:
        return Maneuver('late', extended_test(BARKER_SPEED).segments, waits=False)
    pitch = turn(1, math.radians(90.0 + beyond), BARKER_SPEED)
    return Maneuver('beyond', (pitch, turn(2, math.tau, BARKER_SPEED)))


def flown(beyond, rate):
    return fly('four_gimbal', maneuver(beyond), rate, gain=GAIN)


def peak(flight):
    return np.degrees(np.abs(flight.joint_rates).max())


def peak_of_figure_5(beyond, rate):
    """Step through figure 5 with SciPy's rotations; its θ lies within ±90°. Peak in deg/s."""
    h, order = 1.0 / rate, maneuver(beyond)
    hand, gimbals, alpha, before, fastest, time = (
        Rotation.identity(),
        np.zeros(3),
        0.0,
        0.0,
        0.0,
        0,
    )
    for k in range(math.ceil(order.duration * rate - 1e-9) + 1):
        command = order.order(time if order.waits else k * h, h)
        if not any(command.rates):
            break
        time += command.share * h
        _, theta, phi = gimbals
        rate_now = -GAIN * math.sin(theta) * (1.0 if math.sin(phi) >= -1e-9 else -1.0)
        alpha += h * (1.5 * rate_now - 0.5 * before)
        before = rate_now
        hand = hand * Rotation.from_rotvec(h * np.array(command.rates))
        found = (hand * Rotation.from_euler('z', -alpha)).as_euler('ZYX')
        moved = (found - gimbals + math.pi) % math.tau - math.pi
        fastest, gimbals = max(fastest, np.abs(moved).max() * rate), found
    return math.degrees(fastest)


@pytest.mark.parametrize('rate', [32.0, 50.0, 100.0, 1000.0])
def test_figure_11_passes_exactly_through_lock_where_the_pitch_ends_exactly(rate):
    """θ then goes on beyond −90° as fast as α and the hand turn it, whatever h is."""
    flight = flown(0.0, rate)
    beyond = np.degrees(flight.joint_positions[-1, 1])
    assert beyond < -100.0
    assert peak(flight) < 80.0


# docs/results/gimbal-wrists.md
@pytest.mark.parametrize(
    ('rate', 'beyond', 'shown'),
    [
        (32.0, 1.0, 2045.0),
        (32.0, 5.0, 815.0),
        (50.0, 0.1, 3916.0),
        (50.0, 1.0, 2666.0),
        (50.0, 5.0, 862.0),
        (50.0, BY_THE_CLOCK, 2619.0),
        (100.0, 0.1, 5870.0),
        (100.0, 1.0, 3644.0),
        (100.0, 5.0, 884.0),
        (100.0, BY_THE_CLOCK, 6294.0),
        (1000.0, BY_THE_CLOCK, 63926.0),
    ],
)
def test_figure_11_a_near_miss_of_lock_needs_the_extremely_large_rates(rate, beyond, shown):
    found = peak(flown(beyond, rate))
    assert found == pytest.approx(shown, abs=0.6)
    assert found == pytest.approx(peak_of_figure_5(beyond, rate), rel=1e-6)


def test_figure_11_a_near_miss_within_one_step_needs_up_to_90_deg_in_it():
    assert peak(flown(0.1, 32.0)) == pytest.approx(2614.0, abs=0.6)
    assert peak(flown(0.1, 32.0)) < 90.0 * 32.0


@pytest.mark.parametrize('rate', [32.0, 320.0])
@pytest.mark.parametrize('beyond', [1.0, 3.0, -5.0])
def test_figure_11_lock_is_missed_by_what_the_pitch_missed_the_vertical_by(rate, beyond):
    """The yaw's axis z keeps its height, so cos θ cos φ = c33 = ∓sin δ all the way."""
    flight = flown(beyond, rate)
    miss = math.sin(math.radians(abs(beyond)))
    yawing = flight.time > (90.0 + beyond) / 32.0 + 1.0 / rate
    heights = flight.hand_rotation[yawing, 2, 2]
    np.testing.assert_allclose(heights, -math.sin(math.radians(beyond)), atol=1e-9)
    assert miss <= flight.margin[yawing].min() * (1.0 + 1e-9)
    hand, alpha = math.degrees(BARKER_SPEED), math.degrees(GAIN)
    # Where sgn(sin φ) changes, Adams and Bashforth's rule doubles α̇ for a step.
    assert peak(flight) < (hand + 2.0 * alpha) / miss
    if rate > 100.0:
        assert peak(flight) > (hand + alpha) / miss
