"""Lengths alone can fit several poses: what is measured or interpolated keeps to the right one."""

import math

import numpy as np
import pytest

from wrist_control import InvalidValueError, UnreachableError, make_wrist
from wrist_control.errors import RefusedError
from wrist_control.resolving.homing import check_way_home, has_reached, step_home
from wrist_control.resolving.period import Mode, SupervisorSettings
from wrist_control.resolving.step import start, step
from wrist_control.resolving.supervisor import Supervisor
from wrist_control.rotations import Pose

WRIST = make_wrist('stewart')
NAMES = [joint.name for joint in WRIST.joints]
SETTINGS = SupervisorSettings(
    0.01, 0.25, 0.1, tuple(WRIST.home), (0.005,) * 6, require_joint_states=False
)


# Commands of 1.2 s each that lead, without stroke limits, to where lengths mislead.
WALKS = [
    [
        (0.0, -0.2, 0.0, -0.4, -1.0, 0.1),
        (0.2, 0.0, 0.1, 0.0, -1.1, 0.2),
        (0.0, -0.1, 0.1, 0.1, -0.3, 0.4),
        (-0.1, 0.1, -0.1, 0.3, -0.6, 0.7),
    ],
    [
        (0.0, 0.0, 0.1, 0.0, -1.5, 0.8),
        (0.1, 0.0, 0.0, 0.1, -0.6, 0.2),
        (0.0, 0.0, -0.1, -0.3, 0.6, 0.7),
    ],
]


def walked():
    """Return every tenth state on the walks."""
    states = []
    for twists in WALKS:
        state = start(WRIST)
        for count in range(60 * len(twists)):
            state = step(WRIST, state, twists[count // 60], 0.02).state
            if count % 10 == 9:
                states.append(state)
    return states


def misleads(state):
    """Return whether home is proved to lead the lengths of a state to another pose."""
    solution = WRIST.forward_kinematics.solve(tuple(state.positions))
    return solution.status == 0 and math.dist(solution.pose.position, state.pose.position) > 1e-6


FAR_STATES = walked()
MISLED = [state for state in FAR_STATES if misleads(state)]


def test_lengths_that_are_far_from_home_and_fit_other_poses_are_refused():
    assert len(MISLED) > 2
    for state in MISLED:
        with pytest.raises(UnreachableError, match='fit more than one pose'):
            WRIST.resolve_assembly(tuple(state.positions), WRIST.home.pose)


def test_lengths_a_tenth_of_a_metre_from_home_that_fit_other_poses_are_refused():
    rng, cold_start = np.random.default_rng(0), WRIST.forward_kinematics.cold_start
    readings = (tuple((WRIST.home[0] + rng.choice([-0.1, 0.1], 6)).tolist()) for _ in range(100))
    lengths = next(
        reading
        for reading in readings
        if (cold := cold_start(reading)).others and cold.solution.status == 0
    )
    with pytest.raises(UnreachableError, match='fit more than one pose'):
        WRIST.resolve_assembly(lengths, WRIST.home.pose)


@pytest.mark.parametrize('travel', [1e-3, 0.015])
def test_lengths_close_to_a_pose_belong_to_it_wherever_it_is(travel):
    for state in MISLED:
        x, y, z = state.pose.position
        moved = WRIST.assembly_at(Pose(state.pose.quaternion, (x + travel, y, z)))
        found = WRIST.resolve_assembly(tuple(moved), state.pose)
        assert found.pose.position == pytest.approx(moved.pose.position, abs=1e-9)


@pytest.mark.parametrize('seconds', [0.2, 0.8, 1.2])
def test_the_way_home_never_jumps_and_ends_at_home(seconds):
    before = start(WRIST)
    for _ in range(round(seconds / 0.02)):
        before = step(WRIST, before, WALKS[0][0], 0.02).state
    while not has_reached(before, WRIST.home):
        state = step_home(WRIST, before, WRIST.home, 0.01).state
        assert math.dist(state.pose.position, before.pose.position) < 0.01
        before = state
    assert before.pose.position == pytest.approx(WRIST.home.pose.position)


def test_the_way_home_is_not_followed_into_lock():
    """From here the way straight in the lengths leads there; the operator can drive another."""
    state = MISLED[0]
    with pytest.raises(InvalidValueError, match='the straight way back crosses'):
        check_way_home(WRIST, state, WRIST.home)
    for _ in range(2000):
        before, state = state, step_home(WRIST, state, WRIST.home, 0.01).state
        assert math.dist(state.pose.position, before.pose.position) < 0.01
    assert state == before
    assert not has_reached(state, WRIST.home)


def test_a_first_reading_that_fits_several_poses_is_a_fault_and_not_a_jump():
    supervisor = Supervisor(WRIST, SETTINGS)
    for _ in range(2):
        supervisor.take_measured(NAMES, tuple(MISLED[0].positions), 0.0)
    with pytest.raises(UnreachableError):
        supervisor.take_measured(NAMES, tuple(MISLED[0].positions), 0.0)
    assert supervisor.mode is Mode.FAULT
    assert not supervisor.tick(stamp_time=0.0, receipt_time=0.0).moving_allowed


def test_a_reading_that_cannot_be_after_a_good_one_changes_nothing():
    supervisor = Supervisor(WRIST, SETTINGS)
    for _ in range(3):
        supervisor.take_measured(NAMES, tuple(WRIST.home), 0.0)
    before = supervisor.state
    for _ in range(3):
        supervisor.take_measured(NAMES, tuple(MISLED[0].positions), 0.0)
    with pytest.raises(RefusedError):
        supervisor.take_measured(NAMES, (math.nan,) * 6, 0.0)
    assert supervisor.state is before
    assert supervisor.mode is Mode.FOLLOWING


def test_a_measured_start_is_adopted_with_its_pose():
    pose = Pose(WRIST.home.pose.quaternion, (0.01, -0.02, 0.45))
    supervisor = Supervisor(WRIST, SETTINGS)
    for _ in range(3):
        supervisor.take_measured(NAMES, tuple(WRIST.assembly_at(pose)), 0.0)
    assert supervisor.state.pose.position == pytest.approx(pose.position, abs=1e-12)
