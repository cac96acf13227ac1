"""The first reading of a platform, before there is a pose to go on from: what its status says."""

import math

import numpy as np
import pytest

from wrist_control import make_wrist
from wrist_control.errors import RefusedError
from wrist_control.resolving.platform_observer import MEANINGS, Observer, ObserverSettings
from wrist_control.rotations import IDENTITY, Pose, turned
from wrist_control.stewart.forward_kinematics import Status

WRIST = make_wrist('stewart')
NAMES = [joint.name for joint in WRIST.joints]


@pytest.fixture
def observer():
    return Observer(WRIST, ObserverSettings([1e-4], 0.5, 1.0))


def lengths_turned_by(degrees):
    turn = turned(IDENTITY, (0.0, 0.0, math.radians(degrees)), 1.0)
    return tuple(WRIST.assembly_at(Pose(turn, (0.0, 0.0, WRIST.home_height))))


@pytest.mark.parametrize(
    ('degrees', 'status'), [(89.0, Status.NEAR_SINGULAR), (90.0, Status.DIVERGED)]
)
def test_near_lock_it_says_so(observer, degrees, status):
    lengths = lengths_turned_by(degrees)
    for count in range(3):
        observed = observer.take(NAMES, lengths, 0.1 * count)
        assert observed.solution.status == status
        assert observed.covariance is None


def test_once_found_the_pose_is_gone_on_from_and_the_sentence_says_so(observer):
    first = observer.take(NAMES, lengths_turned_by(5.0), 0.0)
    second = observer.take(NAMES, lengths_turned_by(6.0), 0.02)
    assert 'home' in first.message
    assert second.message == MEANINGS[Status.CONVERGED]
    np.testing.assert_allclose(second.solution.pose.rotation[0, 1], math.sin(math.radians(6.0)))


def test_rates_as_fast_as_the_jump_limit_count_and_faster_ones_do_not(observer):
    observed = observer.take(NAMES, WRIST.home, 0.0)
    level = observer.with_twist(observed, NAMES, [0.5] * 6)
    lines = np.array(WRIST.home.lines)
    np.testing.assert_allclose(lines @ level.twist, 0.5, atol=1e-12)
    for wrong in (0.5 + 1e-9, -0.5 - 1e-9, math.inf, math.nan):
        with pytest.raises(RefusedError, match='The velocity of leg_6 is'):
            observer.with_twist(observed, NAMES, [0.0] * 5 + [wrong])
    assert observer.with_twist(observed, NAMES, [math.nan] * 6) is observed
    assert observer.with_twist(observed, NAMES, []) is observed


def test_without_a_jump_limit_any_finite_rate_counts_and_an_infinite_one_does_not():
    observer = Observer(WRIST, ObserverSettings([1e-4], math.inf, 1.0))
    observed = observer.take(NAMES, WRIST.home, 0.0)
    assert observer.with_twist(observed, NAMES, [1e6] * 6).twist is not None
    with pytest.raises(RefusedError, match='is inf m/s'):
        observer.with_twist(observed, NAMES, [math.inf] * 6)


@pytest.mark.parametrize('side', ['lower', 'upper'])
def test_a_length_at_its_limit_counts_and_one_beyond_does_not(side):
    home = WRIST.home[0]
    wrist = WRIST.with_limits(**{side: home})
    observer = Observer(wrist, ObserverSettings([1e-4], 0.5, 1.0))
    assert observer.take(NAMES, WRIST.home, 0.0).solution.status == Status.CONVERGED
    beyond = home + (1e-4 if side == 'upper' else -1e-4)
    with pytest.raises(RefusedError, match=r'leg_1 is at .* m; valid is') as refused:
        observer.take(NAMES, (beyond, *WRIST.home[1:]), 0.1)
    assert refused.value.reason == 'outside its limits'


def test_a_gap_as_long_as_the_limit_is_still_followed_and_a_longer_one_is_not():
    """Without a jump limit the gap alone says how long a straight way is believed."""
    observer = Observer(WRIST, ObserverSettings([1e-4], math.inf, 1.0))
    observer.take(NAMES, WRIST.home, 0.0)
    moved = lengths_turned_by(10.0)
    assert observer.take(NAMES, moved, 1.0).message == MEANINGS[Status.CONVERGED]
    assert observer.take(NAMES, moved, 2.0 + 1e-6).solution.status == Status.UNPROVEN
