"""The edge of every workspace through the graph: a limit at work, reached and left freely."""

import math

import pytest
import rclpy
from geometry_msgs.msg import PoseStamped, TwistStamped
from sensor_msgs.msg import JointState

from wrist_control import make_wrist
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.resolver import Resolver
from wrist_control.rotations import Pose
from wrist_interfaces.msg import LimitAtWork, WristStatus

RATE = 50.0
SPEED = 0.5
EDGES = {
    'single_hooke': 'cone',
    'double_hooke': 'cone',
    'omni_wrist': 'cone',
    'carpal': 'closure',
    'five_bar': 'equator',
    'stewart': 'lock',
}


@pytest.fixture
def flown(graph, request):
    """A wrist pitched for four seconds, by 115°, then pitched back for half a second."""
    wrist = request.param
    clock = graph.lockstep(1.0 / RATE)
    common = {'use_sim_time': True, 'rate': RATE}
    graph.start(Resolver, wrist, **common, joint_rate_limits=[10.0])
    clock.listen(
        {'wrist_status': WristStatus, 'joint_command': JointState, 'hand_pose': PoseStamped}
    )
    clock.begin()
    operator = graph.start(
        Operator, **common, maneuver='constant', constant_rates=[0.0, SPEED, 0.0]
    )
    clock.listen({'cmd_vel': TwistStamped})
    clock.begin()
    for _ in range(round(4.0 * RATE)):
        clock.tick()
    there = len(clock.heard['wrist_status'])
    operator.set_parameters([operator_rates(-SPEED)])
    for _ in range(round(0.5 * RATE)):
        clock.tick()
    return wrist, clock.heard, there


def operator_rates(q):
    return rclpy.Parameter('constant_rates', value=[0.0, q, 0.0])


def taken(wrist, message, command):
    """Where the joints are; legs do not say it alone, so the platform's pose is asked."""
    if wrist.twist_size == 3:
        return tuple(command.position)
    where, turn = message.pose.position, message.pose.orientation
    pose = Pose((turn.w, turn.z, turn.y, turn.x), (where.x, where.y, where.z))
    return wrist.inverse(pose, command.position)


@pytest.mark.parametrize('flown', EDGES, indirect=True)
def test_the_edge_is_a_limit_at_work_that_is_not_overshot_and_left_freely(flown):
    name, heard, there = flown
    wrist = make_wrist(name)
    at_edge = heard['wrist_status'][there - 1]
    assert at_edge.state == WristStatus.LIMITED, at_edge.message
    limit = next(limit for limit in at_edge.limits if limit.kind == LimitAtWork.WORKSPACE)
    assert EDGES[name] in limit.joint
    assert 'move the other way' in at_edge.message

    for pose, command in zip(heard['hand_pose'], heard['joint_command'], strict=False):
        assert all(math.isfinite(x) for x in command.position)
        all_remaining = [
            clearance.remaining for clearance in wrist.clearances(taken(wrist, pose, command))
        ]
        assert min(all_remaining) >= -1e-8

    back = heard['wrist_status'][-1]
    assert back.state == WristStatus.TRACKING, back.message
    assert back.achieved.angular.y == pytest.approx(-SPEED, abs=1e-3)


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
    operator.set_parameters([operator_rates(-SPEED)])
    for _ in range(10):
        clock.tick()
    assert clock.heard['wrist_status'][-1].state == WristStatus.TRACKING
