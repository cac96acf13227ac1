"""Timeouts of a resolver: as they are set now, on the clock that they are meant for."""

import math
import time

import numpy as np
import pytest
import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.clock import ROSClock
from rclpy.duration import Duration
from sensor_msgs.msg import JointState

from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus

RATE = 50.0
PITCH = 0.1
HOUR = Duration(seconds=3600.0)
NODE = 'three_gimbal_resolver'


def change(graph, **parameters):
    request = SetParametersAtomically.Request(
        parameters=[rclpy.Parameter(n, value=v).to_parameter_msg() for n, v in parameters.items()]
    )
    result = graph.call(SetParametersAtomically, f'{NODE}/set_parameters_atomically', request)
    assert result.result.successful, result.result.reason


def pitching():
    twist = Twist()
    twist.angular.y = PITCH
    return twist


def followed_after_one_command(graph, ticks, pause=0.0, **changes):
    """Return what is followed at each tick after a command that comes between two ticks."""
    clock = graph.lockstep(1.0 / RATE)
    graph.start(Resolver, 'three_gimbal', use_sim_time=True, rate=RATE)
    clock.listen({'wrist_status': WristStatus})
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')
    clock.begin()
    if changes:
        change(graph, **changes)
    publisher.publish(pitching())
    graph.spin(0.1)
    time.sleep(pause)
    for _ in range(ticks):
        clock.tick()
    statuses = clock.heard['wrist_status'][-ticks:]
    return np.array([status.commanded.angular.y for status in statuses]), statuses


def ramp(ticks, timeout, stop_time):
    """Return what docs/interfaces.md says of the ticks after a command."""
    ages = np.arange(1, ticks + 1) / RATE
    return PITCH * np.clip(1.0 - (ages - timeout) / stop_time, 0.0, 1.0)


def test_a_command_is_followed_until_its_timeout_and_then_ramped_down(graph):
    followed, statuses = followed_after_one_command(graph, 25)
    np.testing.assert_allclose(followed, ramp(25, 0.25, 0.1), atol=1e-7)
    assert statuses[11].state == WristStatus.TRACKING
    assert statuses[13].state == WristStatus.STALE


def test_changed_timeouts_are_followed_at_once(graph):
    changes = {'command_timeout': 0.41, 'stop_time': 0.33}
    followed, _ = followed_after_one_command(graph, 45, **changes)
    np.testing.assert_allclose(followed, ramp(45, 0.41, 0.33), atol=1e-7)


def test_with_simulated_time_a_command_ages_by_that_time_alone(graph):
    """A debugger, or a simulation that is slow, does not stop the hand."""
    followed, _ = followed_after_one_command(graph, 5, pause=0.6)
    np.testing.assert_allclose(followed, PITCH, atol=1e-12)


def test_the_age_at_which_a_stamp_is_refused_changes_with_the_timeout(graph):
    graph.start(Resolver, 'three_gimbal')
    statuses = graph.listen(WristStatus, 'wrist_status')
    publisher = graph.publisher(TwistStamped, 'cmd_vel')
    message = TwistStamped(twist=pitching())

    def old_command_moves():
        stamp = graph.outside.get_clock().now() - Duration(seconds=1.0)
        message.header.stamp = stamp.to_msg()
        publisher.publish(message)
        graph.spin(0.05)
        return statuses[-1].state == WristStatus.TRACKING

    graph.until(lambda: statuses)
    assert not any(old_command_moves() for _ in range(10))
    change(graph, command_timeout=5.0)
    graph.until(old_command_moves)


class SystemClock:
    """The system's clock, as a resolver reads it, when somebody sets it."""

    def __init__(self):
        self.ahead = Duration()
        self.clock = ROSClock()
        self.clock.now = self.now

    def now(self):
        return ROSClock.now(self.clock) + self.ahead


@pytest.fixture
def settable(monkeypatch):
    system = SystemClock()
    monkeypatch.setattr(Resolver, 'get_clock', lambda self: system.clock)
    return system


@pytest.mark.parametrize('ahead', [HOUR, Duration(seconds=-3600.0)])
def test_a_system_clock_that_is_set_neither_stops_the_hand_nor_keeps_it_moving(
    graph, settable, ahead
):
    graph.start(Resolver, 'three_gimbal', command_timeout=2.0)
    statuses = graph.listen(WristStatus, 'wrist_status')
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')

    def followed():
        publisher.publish(pitching())
        return statuses and statuses[-1].state == WristStatus.TRACKING

    graph.until(followed)
    graph.spin(0.1)  # so that every command is heard before
    settable.ahead = ahead
    heard = len(statuses)
    graph.until(lambda: len(statuses) > heard + 10)
    jump = statuses[-1].header.stamp.sec - statuses[heard - 1].header.stamp.sec
    assert jump == pytest.approx(1e-9 * ahead.nanoseconds, abs=2.0)
    assert statuses[-1].state == WristStatus.TRACKING
    graph.until(lambda: statuses[-1].state == WristStatus.STALE)
    graph.until(lambda: not statuses[-1].commanded.angular.y)


def test_a_joint_that_does_not_follow_is_seen_when_the_system_clock_is_set_back(graph, settable):
    graph.start(Resolver, 'three_gimbal', command_timeout=10.0, joint_rate_limits=[math.inf])
    statuses = graph.listen(WristStatus, 'wrist_status')
    states = graph.publisher(JointState, 'joint_states')
    commands = graph.publisher(Twist, 'cmd_vel_unstamped')
    twist = Twist()
    twist.angular.x = 2.0
    stuck = JointState(name=['psi', 'theta', 'phi'], position=[0.0, 0.0, 0.0])

    def measured_at_last(state):
        states.publish(stuck)
        graph.spin(0.02)
        return statuses and statuses[-1].state == state

    graph.until(lambda: measured_at_last(WristStatus.IDLE))
    told = graph.listen(JointState, 'joint_command')

    def is_led_away():
        commands.publish(twist)
        return measured_at_last(WristStatus.FAULT) or (told and told[-1].position[2] > 0.5)

    # Further than a joint may lag, but not yet for long enough.
    graph.until(is_led_away)
    settable.ahead = Duration(seconds=-3600.0)
    graph.until(lambda: measured_at_last(WristStatus.FAULT))
    assert statuses[-1].message.startswith('phi is at 0.000 but was told ')
