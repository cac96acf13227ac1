"""Whether nodes were in step: each acted at a tick on what the others said at the one before."""

import pytest
from geometry_msgs.msg import Twist, TwistStamped
from sensor_msgs.msg import JointState

from wrist_control.graph.recording import in_step
from wrist_interfaces.msg import WristStatus

ASKED = [0.1, 0.2, 0.3, 0.4]
TOLD = [1.1, 1.2, 1.3, 1.4]


def turning(rate):
    twist = Twist()
    twist.angular.y = rate
    return twist


def heard(followed, seen, warm_up=0):
    """What four ticks bring, after some at which nobody has asked for anything yet."""
    zeros = [0.0] * warm_up
    return {
        'cmd_vel': [TwistStamped(twist=turning(rate)) for rate in ASKED],
        'wrist_status': [WristStatus(commanded=turning(rate)) for rate in zeros + followed],
        'joint_command': [JointState(position=[x]) for x in zeros + TOLD],
        'joint_states': [JointState(position=[x]) for x in zeros + seen],
    }


@pytest.mark.parametrize('warm_up', [0, 3])
def test_nodes_that_follow_one_tick_later_are_in_step(warm_up):
    assert in_step(heard([9.0, *ASKED[:3]], [9.0, *TOLD[:3]], warm_up))


@pytest.mark.parametrize(
    ('followed', 'seen'),
    [
        ([9.0, 0.1, 0.1, 0.3], [9.0, *TOLD[:3]]),  # a command that came a tick too late
        (ASKED, [9.0, *TOLD[:3]]),  # all of them a tick too soon
        ([9.0, *ASKED[:3]], [9.0, 1.1, 1.1, 1.3]),  # joint states that came too late
        ([9.0, *ASKED[:3]], TOLD),
        ([9.0, *ASKED[:3]], [9.0, 1.1, 1.2, 1.3 + 1e-8]),
    ],
)
def test_nodes_that_hear_too_late_or_too_soon_are_not(followed, seen):
    assert not in_step(heard(followed, seen))


def test_joint_states_count_as_the_same_within_rounding():
    assert in_step(heard([9.0, *ASKED[:3]], [9.0, 1.1, 1.2, 1.3 + 1e-12]))
