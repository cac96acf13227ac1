"""Leg readings in a row: the measure of the published bounds. The rest is tested on the graph."""

import math

import numpy as np
import pytest

from wrist_control import InvalidValueError, make_wrist
from wrist_control.errors import RefusedError
from wrist_control.resolving.platform_observer import (
    Observer,
    ObserverSettings,
    in_metres_and_radians,
)
from wrist_control.rotations import IDENTITY, Pose, rates_between, turned
from wrist_control.stewart.forward_kinematics import Solution, Status

WRIST = make_wrist('stewart')
NAMES = [joint.name for joint in WRIST.joints]
CAREFUL = ObserverSettings([1e-4], 0.5, 1.0)


@pytest.mark.parametrize('size', [0.05, 0.3, 1.0, 4.0])
def test_bounds_stay_sound_in_metres_and_radians(size):
    """A pose at just the library's distance is within the one, and outside the other."""
    rng = np.random.default_rng(2)
    for _ in range(2000):
        turn = rng.normal(size=3)
        turn *= rng.uniform(0.0, math.pi) / np.linalg.norm(turn)
        pose = Pose(turned(IDENTITY, tuple(turn), 1.0), tuple(rng.normal(size=3) * size))
        change = pose.rotation[:2] - np.eye(3)[:2]
        distance = math.sqrt(np.dot(pose.position, pose.position) + size**2 * np.sum(change**2))
        angle = math.hypot(*rates_between(IDENTITY, pose.quaternion, 1.0))
        published = math.hypot(*pose.position, angle)
        solution = Solution(pose, Status.CONVERGED, 0, distance, distance)
        error, unique = in_metres_and_radians(solution, size)
        assert unique * (1.0 - 1e-12) <= published <= error * (1.0 + 1e-12)


def test_where_nothing_is_proved_the_bounds_say_so():
    nothing = Solution(None, Status.DIVERGED, 0, math.inf, 0.0)
    assert in_metres_and_radians(nothing, 0.3) == (math.inf, 0.0)


def test_a_refused_reading_changes_nothing():
    """The next jump is judged by the last good reading and its stamp."""
    observer = Observer(WRIST, CAREFUL)
    observer.take(NAMES, WRIST.home, 0.0)
    jumped = (WRIST.home[0] + 0.1, *WRIST.home[1:])
    with pytest.raises(RefusedError, match=r'leg_1 jumped by 0\.1 m in 0\.1 s'):
        observer.take(NAMES, jumped, 0.1)
    with pytest.raises(RefusedError, match=r'leg_1 jumped by 0\.1 m in 0\.15 s'):
        observer.take(NAMES, jumped, 0.15)
    assert observer.take(NAMES, WRIST.home, 0.15).solution.status == Status.CONVERGED


def test_a_noise_for_half_of_the_legs_is_refused():
    with pytest.raises(InvalidValueError, match='length_noise has 3 values'):
        Observer(WRIST, ObserverSettings([1e-4] * 3, 0.5, 1.0))


def test_lengths_that_no_platform_has_are_answered_without_a_step():
    lengths = (0.1, 2.0, *WRIST.home[2:])
    observed = Observer(WRIST, ObserverSettings([1e-4], math.inf, 1.0)).take(NAMES, lengths, 0.0)
    assert observed.solution == (None, Status.UNREACHABLE, 0, math.inf, 0.0)
    assert (observed.covariance, observed.twist) == (None, None)
    assert 'leg_1' in observed.message
