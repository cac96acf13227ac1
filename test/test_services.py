"""Enable, disable and reset: never by a jump, always from where the joints really are."""

import itertools
import time

import pytest
from geometry_msgs.msg import Twist
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, Trigger

from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus

NODE = 'three_gimbal_resolver'
NAMES = ['psi', 'theta', 'phi']
LIMIT = 1.0


def pitch_until(graph, publisher, condition):
    """Command a pitch of 0.8 rad/s, again and again, until something is true."""
    twist = Twist()
    twist.angular.y = 0.8

    def commanded():
        publisher.publish(twist)
        return condition()

    graph.until(commanded)


def enable(graph, wanted):
    assert graph.call(SetBool, f'{NODE}/enable', SetBool.Request(data=wanted)).success


@pytest.fixture
def moved(graph):
    """A resolver whose hand has been pitched, and everything that it says."""
    graph.start(Resolver, 'three_gimbal', joint_rate_limits=[LIMIT])
    commands = graph.listen(JointState, 'joint_command')
    statuses = graph.listen(WristStatus, 'wrist_status')
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')
    pitch_until(graph, publisher, lambda: commands and commands[-1].position[1] > 0.2)
    publisher.publish(Twist())
    graph.until(lambda: statuses[-1].state == WristStatus.IDLE)
    return commands, statuses, publisher


def test_reset_goes_back_at_the_rate_limits_and_clears_the_time_lost(graph, moved):
    commands, statuses, _ = moved
    before = len(commands)
    answer = graph.call(Trigger, f'{NODE}/reset', Trigger.Request())
    assert answer.success, answer.message
    graph.until(lambda: statuses[-1].state == WristStatus.IDLE and commands[-1].position[1] == 0.0)
    way = [command.position[1] for command in commands[before - 1 :]]
    assert max(abs(a - b) for a, b in itertools.pairwise(way)) <= LIMIT / 100.0 + 1e-9
    assert statuses[-1].time_lost == 0.0


def test_a_disabled_resolver_sends_nothing_to_the_joints(graph, moved):
    commands, statuses, publisher = moved
    enable(graph, False)
    graph.until(lambda: statuses[-1].state == WristStatus.DISABLED)
    count = len(commands)
    ended = time.monotonic() + 0.2
    pitch_until(graph, publisher, lambda: time.monotonic() > ended)
    assert len(commands) == count
    assert not graph.call(Trigger, f'{NODE}/reset', Trigger.Request()).success


def test_enabling_goes_on_from_where_the_joints_really_are(graph, moved):
    commands, statuses, _ = moved
    enable(graph, False)
    graph.until(lambda: statuses[-1].state == WristStatus.DISABLED)
    measured = graph.publisher(JointState, 'joint_states')
    where = JointState(name=['phi', 'psi', 'theta'], position=[0.3, 0.1, 0.2])
    for _ in range(5):
        measured.publish(where)
        graph.spin(0.02)
    count = len(commands)
    enable(graph, True)
    graph.until(lambda: len(commands) > count)
    assert list(commands[count].position) == [0.1, 0.2, 0.3]


def test_a_resolver_that_starts_takes_over_without_a_jump(graph):
    """The joints stand elsewhere than initial_positions says: they are believed."""
    graph.start(JointSimulator, joints=NAMES, initial_positions=[0.4, 0.3, 0.2])
    states = graph.listen(JointState, 'joint_states')
    graph.until(lambda: states)
    graph.start(Resolver, 'three_gimbal', require_joint_states=True)
    commands = graph.listen(JointState, 'joint_command')
    graph.until(lambda: len(commands) > 20)
    assert all(list(command.position) == [0.4, 0.3, 0.2] for command in commands)
    assert all(list(state.position) == [0.4, 0.3, 0.2] for state in states)


def test_a_joint_that_does_not_follow_stops_the_hand(graph):
    graph.start(Resolver, 'three_gimbal', joint_rate_limits=[LIMIT], command_timeout=5.0)
    graph.start(JointSimulator, joints=NAMES, joint_upper_limits=[1.0, 0.1, 1.0])
    statuses = graph.listen(WristStatus, 'wrist_status')
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')
    pitch_until(graph, publisher, lambda: statuses and statuses[-1].state == WristStatus.FAULT)
    assert 'theta' in statuses[-1].message
    graph.until(lambda: '~/enable' in statuses[-1].message)
