"""The edge of every workspace through the graph: a limit at work, reached and left freely."""

import math

import pytest
import rclpy
from geometry_msgs.msg import PoseStamped, TwistStamped
from sensor_msgs.msg import JointState

from wrist_control import WRISTS, make_wrist
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.resolver import Resolver
from wrist_control.resolving import start, step
from wrist_interfaces.msg import LimitAtWork, WristStatus

from .stewart_flown import pose_of

RATE = 50.0
SPEED = 0.5
WITH_EDGES = [name for name in WRISTS if make_wrist(name).clearances(make_wrist(name).home)]


def twist_to_edge(wrist):
    """Return p, q, r about the first hand axis that leads to an edge within four seconds."""
    for axis in wrist.followed_axes:
        rates = [SPEED if other == axis else 0.0 for other in range(3)]
        state = start(wrist)
        for _ in range(round(4.0 * RATE)):
            taken = step(wrist, state, [0.0] * (wrist.twist_size - 3) + rates, 1.0 / RATE)
            state = taken.state
        if any(limit.kind == LimitAtWork.WORKSPACE for limit in taken.limits):
            return rates
    raise AssertionError(f'{wrist} has edges, but none within two radians')


@pytest.fixture
def flown(graph, request):
    """A wrist turned for four seconds, by 115°, then turned back for half a second."""
    name = request.param
    clock = graph.lockstep(1.0 / RATE)
    common = {'use_sim_time': True, 'rate': RATE}
    graph.start(Resolver, name, **common, joint_rate_limits=[10.0])
    clock.listen(
        {'wrist_status': WristStatus, 'joint_command': JointState, 'hand_pose': PoseStamped}
    )
    clock.begin()
    rates = twist_to_edge(make_wrist(name))
    operator = graph.start(Operator, **common, maneuver='constant', constant_rates=rates)
    clock.listen({'cmd_vel': TwistStamped})
    clock.begin()
    for _ in range(round(4.0 * RATE)):
        clock.tick()
    there = len(clock.heard['wrist_status'])
    back = [-rate for rate in rates]
    operator.set_parameters([rclpy.Parameter('constant_rates', value=back)])
    for _ in range(round(0.5 * RATE)):
        clock.tick()
    return name, clock.heard, there


def joints(wrist, message, command):
    """Where the joints are; legs do not say it alone, so the platform's pose is asked."""
    if wrist.twist_size == 3:
        return tuple(command.position)
    return wrist.inverse(pose_of(message.pose), command.position)


@pytest.mark.parametrize('flown', WITH_EDGES, indirect=True)
def test_the_edge_is_a_limit_at_work_that_is_not_overshot_and_left_freely(flown):
    name, heard, there = flown
    wrist = make_wrist(name)
    at_edge = heard['wrist_status'][there - 1]
    assert at_edge.state == WristStatus.LIMITED, at_edge.message
    limit = next(limit for limit in at_edge.limits if limit.kind == LimitAtWork.WORKSPACE)
    assert limit.joint in [clearance.name for clearance in wrist.clearances(wrist.home)]
    assert limit.joint in at_edge.message
    assert 'move the other way' in at_edge.message

    for pose, command in zip(heard['hand_pose'], heard['joint_command'], strict=False):
        assert all(math.isfinite(x) for x in command.position)
        clearances = wrist.clearances(joints(wrist, pose, command))
        assert min(clearance.remaining for clearance in clearances) >= -1e-8

    back = heard['wrist_status'][-1]
    assert back.state == WristStatus.TRACKING, back.message
    asked, achieved = back.commanded.angular, back.achieved.angular
    along = asked.x * achieved.x + asked.y * achieved.y + asked.z * achieved.z
    assert along == pytest.approx(SPEED**2, abs=1e-3)


def test_a_joint_limit_is_a_limit_at_work_that_is_not_overshot_and_left_freely(graph):
    clock = graph.lockstep(1.0 / RATE)
    common = {'use_sim_time': True, 'rate': RATE}
    graph.start(Resolver, 'three_gimbal', **common, joint_upper_limits=[1.0, 0.2, 1.0])
    clock.listen({'wrist_status': WristStatus, 'joint_command': JointState})
    clock.begin()
    operator = graph.start(
        Operator, **common, maneuver='constant', constant_rates=[0.0, SPEED, 0.0]
    )
    clock.listen({'cmd_vel': TwistStamped})
    clock.begin()
    for _ in range(40):
        clock.tick()
    status = clock.heard['wrist_status'][-1]
    assert status.state == WristStatus.LIMITED
    assert (status.limits[0].joint, status.limits[0].kind) == ('theta', LimitAtWork.POSITION)
    assert max(command.position[1] for command in clock.heard['joint_command']) <= 0.2 + 2e-9
    operator.set_parameters([rclpy.Parameter('constant_rates', value=[0.0, -SPEED, 0.0])])
    for _ in range(20):
        clock.tick()
    assert clock.heard['wrist_status'][-1].state == WristStatus.TRACKING
