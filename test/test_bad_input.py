"""What must never move the hand: it is refused, counted, and named in /diagnostics."""

import math

import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.duration import Duration
from sensor_msgs.msg import JointState

from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus


class Watched:
    """A resolver, and everything that it says."""

    def __init__(self, graph, kind, topic, **parameters):
        self.graph = graph
        self.node = graph.start(Resolver, 'three_gimbal', **parameters)
        self.commands = graph.listen(JointState, 'joint_command')
        self.statuses = graph.listen(WristStatus, 'wrist_status')
        self.diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
        self.publisher = graph.publisher(kind, topic)
        graph.until(lambda: self.commands and self.statuses)

    def refused(self):
        return {
            value.key: int(value.value)
            for array in self.diagnostics[-1:]
            for status in array.status
            if status.name.endswith(': input')
            for value in status.values
        }

    def send_until_refused(self, make, reason):
        def counted():
            self.publisher.publish(make())
            return self.refused().get(f'refused {reason}', 0) >= 3

        self.graph.until(counted)

    def has_not_moved(self):
        return all(command.position == self.commands[0].position for command in self.commands)


def stamped(graph, seconds=0.0, frame='', rate=0.3):
    message = TwistStamped()
    now = graph.outside.get_clock().now()
    message.header.stamp = (now + Duration(seconds=seconds)).to_msg()
    message.header.frame_id = frame
    message.twist.angular.y = rate
    return message


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_a_command_that_is_not_finite_is_refused(graph, value):
    watched = Watched(graph, TwistStamped, 'cmd_vel')
    watched.send_until_refused(lambda: stamped(graph, rate=value), 'cmd_vel: not finite')
    assert watched.has_not_moved()


def test_an_unstamped_command_that_is_not_finite_is_refused(graph):
    watched = Watched(graph, Twist, 'cmd_vel_unstamped')
    bad = Twist()
    bad.linear.x = math.nan
    watched.send_until_refused(lambda: bad, 'cmd_vel_unstamped: not finite')
    assert watched.has_not_moved()


@pytest.mark.parametrize(
    ('seconds', 'frame', 'reason'),
    [
        (0.0, 'base_link', 'unknown frame'),
        (1.0, '', 'stamp in the future'),
        (-1.0, '', 'too old'),
    ],
)
def test_frames_and_stamps_that_say_nothing_good_are_refused(graph, seconds, frame, reason):
    watched = Watched(graph, TwistStamped, 'cmd_vel')
    watched.send_until_refused(lambda: stamped(graph, seconds, frame), f'cmd_vel: {reason}')
    assert watched.has_not_moved()


def test_the_last_good_command_stands_while_bad_ones_come(graph):
    watched = Watched(graph, TwistStamped, 'cmd_vel', command_timeout=5.0)
    watched.publisher.publish(stamped(graph))
    graph.until(lambda: watched.statuses[-1].state == WristStatus.TRACKING)
    watched.send_until_refused(lambda: stamped(graph, rate=math.nan), 'cmd_vel: not finite')
    assert watched.statuses[-1].state == WristStatus.TRACKING


def test_a_command_without_a_stamp_counts_as_just_received(graph):
    watched = Watched(graph, TwistStamped, 'cmd_vel')

    def followed():
        message = stamped(graph)
        message.header.stamp = Time()
        watched.publisher.publish(message)
        return watched.statuses[-1].state == WristStatus.TRACKING

    graph.until(followed)


@pytest.mark.parametrize(
    ('names', 'positions', 'reason'),
    [
        (['a', 'b', 'c'], [1.0, 1.0, 1.0], 'wrong joint names'),
        (['psi', 'theta'], [1.0, 1.0], 'wrong joint names'),
        (['psi', 'theta', 'phi'], [1.0, 1.0], 'wrong length'),
        (['psi', 'theta', 'phi'], [1.0, math.nan, 1.0], 'not finite'),
        (['psi', 'psi', 'theta', 'phi'], [1.0, 1.0, 1.0, 1.0], 'wrong joint names'),
    ],
)
def test_joint_states_that_do_not_fit_are_refused(graph, names, positions, reason):
    watched = Watched(graph, JointState, 'joint_states')
    bad = JointState(name=names, position=positions)
    watched.send_until_refused(lambda: bad, f'joint_states: {reason}')
    assert watched.has_not_moved()


def test_the_joint_simulator_refuses_commands_that_do_not_fit(graph):
    graph.start(JointSimulator, joints=['psi', 'theta', 'phi'])
    states = graph.listen(JointState, 'joint_states')
    diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
    publisher = graph.publisher(JointState, 'joint_command')
    bad = [
        JointState(name=['psi', 'theta', 'phi'], position=[math.nan, 0.0, 0.0]),
        JointState(name=['psi', 'theta'], position=[1.0, 1.0]),
        JointState(name=['psi', 'theta', 'phi'], position=[1.0]),
    ]

    def counted():
        for message in bad:
            publisher.publish(message)
            graph.spin(0.02)
        values = [v for a in diagnostics[-1:] for s in a.status for v in s.values]
        return sum(value.key.startswith('refused') for value in values) == 3

    graph.until(counted)
    assert all(list(state.position) == [0.0, 0.0, 0.0] for state in states)


def test_a_publisher_of_the_wrong_type_is_named_in_one_sentence(graph):
    with graph.stranger(Twist, 'cmd_vel'):
        graph.start(Resolver, 'three_gimbal')
        heard = graph.listen(DiagnosticArray, '/diagnostics')
        expected = (
            'old_teleop publishes geometry_msgs/msg/Twist on /cmd_vel and is not heard; publish '
            'geometry_msgs/msg/TwistStamped, or remap it.'
        )
        graph.until(
            lambda: expected in [v.value for a in heard for s in a.status for v in s.values]
        )


def test_when_commands_stop_the_hand_is_ramped_to_a_stop(graph):
    watched = Watched(graph, TwistStamped, 'cmd_vel', command_timeout=0.2, stop_time=0.3)
    for _ in range(20):
        watched.publisher.publish(stamped(graph))
        graph.spin(0.02)
    graph.until(lambda: watched.statuses[-1].state == WristStatus.STALE)
    graph.until(lambda: not any(watched.commands[-1].velocity))
    speeds = [command.velocity[1] for command in watched.commands]
    peak = speeds.index(max(speeds))
    ramp = [speed for speed in speeds[peak:] if 0.01 < speed < 0.29]
    assert len(ramp) > 5
    assert ramp == sorted(ramp, reverse=True)
    assert 'ramped to a stop' in watched.statuses[-1].message
