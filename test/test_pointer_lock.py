"""A pointer in lock through the graph: calm, and it says which part of a command is lost."""

import math

import pytest
import rclpy
from geometry_msgs.msg import TwistStamped
from sensor_msgs.msg import JointState

from wrist_control.nodes.operator import Operator
from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import LimitAtWork, WristStatus

RATE = 50.0
PITCH, YAW, ROLL = [0.02, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.3]


@pytest.fixture
def flown(graph):
    """A pointer pitched to 90°, within the thousandth that is lock, then asked for other rates."""
    clock = graph.lockstep(1.0 / RATE)
    common = {'use_sim_time': True, 'rate': RATE}
    begin = [0.5 * math.pi - 0.01, 0.3]
    graph.start(Resolver, 'pitch_yaw', **common, initial_positions=begin)
    clock.listen({'wrist_status': WristStatus, 'joint_command': JointState})
    clock.begin()
    operator = graph.start(Operator, **common, maneuver='constant', constant_rates=PITCH)
    clock.listen({'cmd_vel': TwistStamped})
    clock.begin()
    while clock.heard['joint_command'][-1].position[0] < 0.5 * math.pi - 2e-4:
        clock.tick()

    def ask(rates, periods):
        operator.set_parameters([rclpy.Parameter('constant_rates', value=rates)])
        for _ in range(periods):
            clock.tick()
        return clock.heard['wrist_status'][-1], clock.heard['joint_command'][-periods + 2 :]

    return ask


def test_yaw_is_lost_there_and_nothing_moves(flown):
    status, commands = flown(YAW, 100)
    assert status.state == WristStatus.SINGULAR
    assert status.scale_factor == 0.0
    assert [(limit.joint, limit.kind) for limit in status.limits] == [
        ('lock', LimitAtWork.SINGULARITY)
    ]
    assert 'cannot turn about its axis (0.0, 1.0, 0.0)' in status.message
    assert not any(any(command.velocity) for command in commands)


def test_pitch_leads_out_with_yaw_beside_it_and_the_second_joint_never_turns_back(flown):
    status, commands = flown([0.1, 0.3, 0.0], 200)
    assert status.achieved.angular.x > 0.0
    assert commands[-1].position[0] > 0.5 * math.pi + 1e-3
    assert all(command.velocity[1] < 1e-9 for command in commands)


def test_roll_alone_is_not_followed_and_says_so(flown):
    status, commands = flown(ROLL, 20)
    assert status.state == WristStatus.LIMITED
    assert [limit.joint for limit in status.limits] == ['mechanism']
    assert status.message.startswith('Nothing of this command can be done')
    assert not any(any(command.velocity) for command in commands)
