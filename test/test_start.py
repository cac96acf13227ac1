"""Resolver and joints find each other in either order, and nothing moves that nobody asked for."""

import pytest
from geometry_msgs.msg import Twist
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from wrist_control import WRISTS, make_wrist
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus

NAMES = ['psi', 'theta', 'phi']
NODES = {
    'resolver': lambda graph, wrist: graph.start(Resolver, wrist, require_joint_states=True),
    'joints': lambda graph, wrist: graph.start(JointSimulator),
}


@pytest.mark.parametrize('wrist', WRISTS)
@pytest.mark.parametrize('first', NODES)
def test_a_bare_resolver_and_bare_joints_find_each_other_in_either_order(graph, wrist, first):
    statuses = graph.listen(WristStatus, 'wrist_status')
    states = graph.listen(JointState, 'joint_states')
    NODES[first](graph, wrist)
    graph.spin(0.3)
    (second,) = set(NODES) - {first}
    NODES[second](graph, wrist)
    graph.until(lambda: statuses and statuses[-1].state == WristStatus.IDLE)
    home = list(make_wrist(wrist).home)
    assert all(list(state.position) == pytest.approx(home, abs=1e-12) for state in states)


def test_a_resolver_without_joints_says_what_it_waits_for_and_commands_nothing(graph):
    graph.start(Resolver, 'three_gimbal', require_joint_states=True)
    statuses = graph.listen(WristStatus, 'wrist_status')
    commands = graph.listen(JointState, 'joint_command')
    velocities = graph.listen(Float64MultiArray, 'joint_velocity_command')
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')
    graph.until(lambda: statuses)
    for _ in range(30):
        twist = Twist()
        twist.angular.y = 0.3
        publisher.publish(twist)
        graph.spin(0.02)
    assert {status.state for status in statuses} == {WristStatus.WAITING}
    assert 'no joint_states of psi, theta, phi were heard' in statuses[-1].message
    assert 'require_joint_states' in statuses[-1].message
    assert not commands
    assert not velocities


def test_a_servo_that_settles_beside_its_setpoint_does_not_creep(graph):
    """It hears every joint_command, and rests 2 mrad below it."""
    graph.start(Resolver, 'three_gimbal', require_joint_states=True)
    commands = graph.listen(JointState, 'joint_command')
    publisher = graph.publisher(JointState, 'joint_states')
    seen = [0.4, 0.3, 0.2]
    for _ in range(150):
        if commands:
            seen = [position - 0.002 for position in commands[-1].position]
        publisher.publish(JointState(name=NAMES, position=seen))
        graph.spin(0.01)
    assert len(commands) > 50
    assert {tuple(command.position) for command in commands} == {(0.4, 0.3, 0.2)}


def test_joints_that_die_while_moving_are_a_ramp_a_zero_and_a_fault(graph):
    resolver = graph.start(
        Resolver, 'three_gimbal', require_joint_states=True, command_timeout=5.0
    )
    simulator = graph.start(JointSimulator)
    statuses = graph.listen(WristStatus, 'wrist_status')
    velocities = graph.listen(Float64MultiArray, 'joint_velocity_command')
    graph.until(lambda: statuses and statuses[-1].state == WristStatus.IDLE)
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')
    twist = Twist()
    twist.angular.y = 0.3
    publisher.publish(twist)
    graph.until(lambda: statuses[-1].state == WristStatus.TRACKING)
    graph.spin(0.3)
    assert resolver.set_parameters([Parameter('feedback_timeout', value=0.2)])[0].successful
    before = len(velocities)
    graph.end(simulator)
    graph.until(lambda: statuses[-1].state == WristStatus.FAULT)
    graph.spin(0.3)
    assert 'psi, theta, phi came 0.2' in statuses[-1].message
    rates = [one.data[1] for one in velocities[before:]]
    assert rates[-1] == 0.0
    assert len([rate for rate in rates if 0.0 < rate < 0.29]) >= 5
    assert sum(rates) * 0.01 < 0.3 * (0.2 + 0.1 + 0.1)
