"""Many four-gimbal flights at once, against the resolver that flies them one by one."""

import math

import numpy as np
import pytest

from wrist_control import fly
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, Segment, turn
from wrist_control.studies.barker_figure_5 import peak_rates


def flown(pitch, direction, rate=32.0, **dimensions):
    """Give the peak of one maneuver by the package's own wrist and step, rad/s."""
    up = [turn(1, pitch, BARKER_SPEED)] if pitch else []
    p, q, r = (BARKER_SPEED * float(x) for x in direction)
    order = Maneuver('one', (*up, Segment((p, q, r), math.tau / BARKER_SPEED)))
    return np.abs(fly('four_gimbal', order, rate, **dimensions).joint_rates).max()


def drawn(count):
    chance = np.random.default_rng(5)
    directions = chance.normal(size=(count, 3))
    return (
        chance.uniform(0.0, 0.5 * math.pi, count),
        directions / np.linalg.norm(directions, axis=1, keepdims=True),
    )


def test_many_flights_at_once_have_the_peaks_that_each_has_alone():
    pitches, directions = drawn(12)
    alone = [flown(*each) for each in zip(pitches, directions, strict=True)]
    np.testing.assert_allclose(peak_rates(pitches, directions), alone, rtol=1e-9)


def test_gain_and_step_are_those_of_the_flight():
    pitches, directions = drawn(3)
    alone = [flown(*each, 50.0, gain=1.3) for each in zip(pitches, directions, strict=True)]
    found = peak_rates(pitches, directions, gain=1.3, step=0.02)
    np.testing.assert_allclose(found, alone, rtol=1e-9)


def test_without_a_pitch_a_turn_about_one_gimbal_needs_that_gimbal_alone():
    found = peak_rates(np.zeros(2), np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]))
    assert found == pytest.approx(BARKER_SPEED)


def test_the_speed_of_the_hand_is_an_argument():
    yaw = np.array([[0.0, 0.0, 1.0]])
    found = peak_rates(np.array([0.5 * math.pi]), yaw, speed=0.5 * BARKER_SPEED)
    assert np.degrees(found) == pytest.approx(31.84, abs=0.01)  # figure 11
