"""Where the platform may have crossed a lock: no wrong pose counts, and home ends the doubt."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from wrist_control import make_wrist
from wrist_control.errors import RefusedError
from wrist_control.resolving.platform_observer import Observer, ObserverSettings
from wrist_control.rotations import IDENTITY, Pose, about_z, turned
from wrist_control.stewart.forward_kinematics import Status

WRIST = make_wrist('stewart')
FK = WRIST.forward_kinematics
NAMES = [joint.name for joint in WRIST.joints]
HOME = WRIST.home.pose
DT = 0.01
LIMIT = 0.5
# Just below the speed that jump_limit allows, in the distance in which proofs are stated.
SPEED = 0.9 * LIMIT
YAW_SPEED = SPEED / (math.sqrt(2.0) * WRIST.size)


def observer(jump_limit=LIMIT):
    return Observer(WRIST, ObserverSettings([1e-4], jump_limit, 1.0))


def yawed(degrees):
    return Pose(about_z(math.radians(degrees)), HOME.position)


def fly(watched, poses, start=0.0):
    """Read the legs at each pose; whatever counts must be the pose where the platform is."""
    found = []
    for count, pose in enumerate(poses):
        observed = watched.take(NAMES, WRIST.assembly_at(pose), start + DT * count)
        if observed.covariance is not None:
            assert FK.apart(observed.solution.pose, pose) < 1e-6
        found.append(observed)
    return found


def yaw(start, end):
    """Return the poses of a yaw at YAW_SPEED, degrees."""
    steps = math.ceil(math.radians(abs(end - start)) / (YAW_SPEED * DT))
    return [yawed(degrees) for degrees in np.linspace(start, end, steps + 1).tolist()]


def statuses(found):
    return [observed.solution.status for observed in found]


def test_beyond_lock_no_pose_counts_until_the_platform_is_home_again():
    """At 126° the lengths fit a pose at 54° as well, and lead there."""
    watched = observer()
    there = fly(watched, yaw(0.0, 126.0))
    assert Status.NEAR_SINGULAR in statuses(there)
    assert there[-1].solution.status == Status.UNPROVEN
    assert 'may have crossed a lock' in there[-1].message
    assert 'drive it home' in there[-1].message
    back = fly(watched, yaw(126.0, 0.0), DT * len(there))
    assert back[-1].solution.status == Status.CONVERGED
    first = statuses(back).index(Status.CONVERGED)
    off = [abs(length - WRIST.home[0]) for length in WRIST.assembly_at(yaw(126.0, 0.0)[first])]
    assert 0.9 * WRIST.far < max(off) <= WRIST.far
    # In doubt, too, each answer is sought near the one before: only beside lock that takes long.
    assert np.mean([observed.solution.iterations for observed in there + back]) < 20


def test_short_of_lock_every_pose_counts():
    assert set(statuses(fly(observer(), yaw(0.0, 84.0)))) == {Status.CONVERGED}


@given(
    st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6).map(np.array),
    st.floats(0.1, 1.0),
    st.floats(0.6, 1.2),
)
@settings(max_examples=20, deadline=None)
def test_after_lock_no_pose_that_counts_is_another_than_the_true_one(direction, share, way):
    """Any straight way, as long as the platform's own size or twice that, and back."""
    twist = direction * np.array([0.1 * share] * 3 + [1.0] * 3)
    pace = math.hypot(*twist[:3], *(math.sqrt(2.0) * WRIST.size * twist[3:]))
    assume(pace > 0.2)
    steps = np.arange(0.0, way, SPEED * DT) / pace
    poses = [
        Pose(
            turned(IDENTITY, tuple((twist[3:] * step).tolist()), 1.0),
            tuple((np.array(HOME.position) + twist[:3] * step).tolist()),
        )
        for step in steps
    ]
    for pose in poses:
        legs = WRIST.assembly_at(pose)
        if legs.hadamard_ratio > 0.0:  # what is taken for granted: home's lengths are home's
            assume(max(abs(length - WRIST.home[0]) for length in legs) > WRIST.far)
    fly(observer(), poses + poses[::-1])


def test_a_lock_crossed_while_readings_are_missed_is_not_taken_for_a_way_short_of_it():
    """From 85° to 93° as fast as before: no reading near lock, and none that has jumped."""
    watched = observer()
    there = fly(watched, yaw(0.0, 85.0))
    assert there[-1].solution.status == Status.CONVERGED
    missed = math.radians(8.0) / YAW_SPEED
    crossed = fly(watched, yaw(93.0, 100.0), DT * (len(there) - 1) + missed)
    assert set(statuses(crossed)) == {Status.UNPROVEN}


@pytest.mark.parametrize('gap', [0.2, 0.99, 5.0, -5.0])
def test_after_a_gap_in_which_a_lock_may_have_been_crossed_home_is_needed(gap):
    watched, way = observer(), yaw(0.0, 10.0)
    fly(watched, way)
    now = DT * (len(way) - 1) + gap
    for count in range(3):
        observed = watched.take(NAMES, WRIST.assembly_at(way[-1]), now + DT * count)
        assert observed.solution.status == Status.UNPROVEN
        assert observed.covariance is None
        assert f'In the {abs(gap):.3g} s since' in observed.message
    home = watched.take(NAMES, WRIST.home, now + 0.1)
    assert home.solution.status == Status.CONVERGED


def test_refused_jumps_are_a_gap_too():
    watched = observer()
    fly(watched, yaw(0.0, 20.0))
    now = DT * len(yaw(0.0, 20.0))
    jumped = (WRIST.home[0] + 0.2, *WRIST.home[1:])
    for count in range(20):
        with pytest.raises(RefusedError, match='leg_1 jumped'):
            watched.take(NAMES, jumped, now + DT * count)
    observed = watched.take(NAMES, WRIST.assembly_at(yawed(20.0)), now + 0.2)
    assert observed.solution.status == Status.UNPROVEN


@pytest.mark.parametrize(('reach', 'status'), [(0.55, Status.CONVERGED), (0.65, Status.UNPROVEN)])
def test_travel_and_reach_together_stay_within_the_radius_without_another_pose(reach, status):
    """Shares of that radius: the travel seen is 0.4, and what jump_limit allows is the rest."""
    watched, way = observer(), yaw(0.0, 40.0)
    fly(watched, way)
    radius = FK.solve(WRIST.assembly_at(yawed(42.0)), yawed(42.0)).unique_radius
    turn = math.degrees(0.4 * radius / (math.sqrt(2.0) * WRIST.size))
    later = DT * (len(way) - 1) + reach * radius / LIMIT
    observed = watched.take(NAMES, WRIST.assembly_at(yawed(40.0 + turn)), later)
    assert observed.solution.unique_radius == pytest.approx(radius, rel=0.03)
    assert observed.solution.status == status


def test_a_few_readings_that_are_missed_cost_nothing():
    watched = observer()
    fly(watched, yaw(0.0, 20.0))
    later = DT * (len(yaw(0.0, 20.0)) + 4)
    observed = watched.take(NAMES, WRIST.assembly_at(yawed(21.0)), later)
    assert observed.solution.status == Status.CONVERGED


def test_a_start_away_from_home_has_no_pose_until_home():
    """From home a pose leads there, and the platform may be at another beyond lock."""
    beyond = yawed(126.0)
    assert FK.solve(WRIST.assembly_at(beyond)).status == Status.CONVERGED
    watched = observer()
    for count, pose in enumerate([beyond, yawed(54.0)]):
        observed = watched.take(NAMES, WRIST.assembly_at(pose), count)
        assert observed.solution.status == Status.UNPROVEN
        assert 'There is no pose to go on from' in observed.message
    assert watched.take(NAMES, WRIST.home, 2.0).solution.status == Status.CONVERGED


@pytest.mark.parametrize(
    ('off', 'status'), [(0.0199, Status.CONVERGED), (0.0201, Status.UNPROVEN)]
)
def test_home_is_where_every_leg_is_within_two_centimetres(off, status):
    lengths = (*WRIST.home[:4], WRIST.home[4] - off, WRIST.home[5])
    assert observer().take(NAMES, lengths, 0.0).solution.status == status


def test_other_poses_with_home_lengths_are_overturned_and_beyond_lock():
    """What is taken for granted at home, no one who looks can mistake."""
    others = [one.pose for one in FK.assemblies(WRIST.home) if FK.apart(one.pose, HOME) > 1e-6]
    assert len(others) >= 3
    for pose in others:
        assert pose.rotation[2, 2] < math.cos(math.radians(93.0))
        assert WRIST.assembly_at(pose).hadamard_ratio * WRIST.home.hadamard_ratio < 0.0


def test_without_a_jump_limit_long_steps_are_followed_and_lock_ends_them():
    watched = observer(math.inf)
    there = fly(watched, [yawed(degrees) for degrees in range(0, 88, 3)])
    assert set(statuses(there)) == {Status.CONVERGED}
    beyond = fly(watched, [yawed(degrees) for degrees in (89.5, 92.0, 126.0)], 1.0)
    assert statuses(beyond) == [Status.NEAR_SINGULAR, Status.UNPROVEN, Status.UNPROVEN]
    assert 'near lock' in beyond[0].message
    assert 'may have crossed a lock' in beyond[1].message
    assert watched.take(NAMES, WRIST.home, 2.0).solution.status == Status.CONVERGED
