"""The operator on a graph: whom it waits for, what it asks, and what it hears of the hand."""

import math

import numpy as np
import pytest
import rclpy
from builtin_interfaces.msg import Time
from geometry_msgs.msg import TwistStamped
from sensor_msgs.msg import Joy

from wrist_control.nodes.operator import Operator
from wrist_interfaces.msg import WristStatus

RATE = 50.0
PITCH, YAW = 1, 2


def asked(commands):
    """Return p, q, r of every command."""
    turns = [command.twist.angular for command in commands]
    return np.array([(turn.x, turn.y, turn.z) for turn in turns])


def begun(graph, **parameters):
    """Return a simulated clock, and the commands of an operator at its ticks."""
    clock = graph.lockstep(1.0 / RATE)
    graph.start(Operator, use_sim_time=True, rate=RATE, **parameters)
    clock.listen({'cmd_vel': TwistStamped})
    clock.begin()
    return clock, clock.heard['cmd_vel']


def test_a_maneuver_begins_when_as_many_listen_as_it_was_told(graph):
    clock, commands = begun(graph, maneuver='basic_test', speed=1.0, listeners=2)
    for _ in range(10):
        clock.tick()
    assert not asked(commands).any()
    graph.listen(TwistStamped, 'cmd_vel')
    graph.until(lambda: graph.outside.count_subscribers('cmd_vel') == 2)
    graph.spin(0.1)
    before = len(commands)
    for _ in range(5):
        clock.tick()
    np.testing.assert_array_equal(asked(commands[before:]), [[0.0, 1.0, 0.0]] * 5)


def test_a_maneuver_that_waits_for_nobody_begins_unheard(graph):
    clock, commands = begun(graph, maneuver='basic_test', speed=1.0, listeners=0)
    clock.tick()
    assert asked(commands)[-1, PITCH] == 1.0


def test_commands_are_stamped_now_and_say_their_frame(graph):
    clock, commands = begun(
        graph, maneuver='constant', constant_rates=[0.1, 0.2, 0.3], frame_id='forearm'
    )
    clock.tick()
    stamps = [c.header.stamp.sec + 1e-9 * c.header.stamp.nanosec for c in commands[-2:]]
    assert stamps[1] - stamps[0] == pytest.approx(1.0 / RATE)
    assert commands[-1].header.frame_id == 'forearm'
    np.testing.assert_array_equal(asked(commands)[-1], [0.1, 0.2, 0.3])
    linear = commands[-1].twist.linear
    assert (linear.x, linear.y, linear.z) == (0.0, 0.0, 0.0)


def test_constant_rates_change_while_it_runs_and_bad_ones_change_nothing(graph):
    graph.start(Operator, maneuver='constant', constant_rates=[0.1, 0.2, 0.3])
    (node,) = [node for node in graph.executor.get_nodes() if node.get_name() == 'operator']
    commands = graph.listen(TwistStamped, 'cmd_vel')

    def set_rates(rates):
        return node.set_parameters([rclpy.Parameter('constant_rates', value=rates)])[0]

    assert set_rates([0.0, 0.5, 0.0]).successful
    refused = set_rates([0.0, 0.5])
    assert not refused.successful
    assert refused.reason == 'constant_rates has 2 values; give three: for p, q and r.'
    assert not set_rates([0.0, math.nan, 0.0]).successful
    graph.until(lambda: len(commands) > 3)
    np.testing.assert_array_equal(asked(commands)[-1], [0.0, 0.5, 0.0])


def flown_pitch(graph, time_lost):
    """Return for how many ticks a quarter turn is pitched, the hand losing time as it says."""
    clock, commands = begun(graph, maneuver='basic_test', speed=math.pi, listeners=1)
    statuses = graph.publisher(WristStatus, 'wrist_status')
    said = None
    for tick in range(60):
        if (lost := time_lost(tick)) != said:
            message = WristStatus(time_lost=lost)
            message.header.stamp = commands[-1].header.stamp
            statuses.publish(message)
            graph.spin(0.1)
            said = lost
        clock.tick()
    return np.count_nonzero(asked(commands)[:, PITCH])


def test_a_hand_that_loses_nothing_is_pitched_for_the_maneuvers_own_time(graph):
    assert flown_pitch(graph, lambda tick: 0.0) == round(0.5 * RATE)


def test_the_maneuver_waits_while_the_hand_loses_time(graph):
    """Ten ticks long it stands still, and the pitch takes ten ticks more."""
    lost = flown_pitch(graph, lambda tick: min(max(tick - 5, 0), 10) / RATE)
    assert lost == pytest.approx(round(0.5 * RATE) + 10, abs=1)


def test_a_status_without_a_finite_time_is_not_heard(graph):
    lost = flown_pitch(graph, lambda tick: math.nan if tick == 5 else math.inf)
    assert lost == round(0.5 * RATE)


def test_axes_scales_and_deadzone_of_a_joystick_are_those_of_the_parameters(graph):
    graph.start(
        Operator,
        maneuver='joystick',
        joy_axes=[2, 0, 1],
        joy_scales=[1.0, -2.0, 4.0],
        joy_deadzone=0.2,
        enable_button=1,
    )
    commands = graph.listen(TwistStamped, 'cmd_vel')
    publisher = graph.publisher(Joy, 'joy')

    publisher.publish(Joy(axes=[0.0, 0.0, 0.0], buttons=[0, 1]))
    graph.spin(0.2)

    def moved():
        publisher.publish(Joy(axes=[0.6, 0.1, -1.0], buttons=[0, 1]))
        return commands and asked(commands)[-1].any()

    graph.until(moved)
    np.testing.assert_allclose(asked(commands)[-1], [-1.0, -1.0, 0.0], atol=1e-6)


def test_a_joystick_that_falls_silent_counts_as_released_after_its_own_timeout(graph):
    """On a simulated clock: a held stick is followed for just so long."""
    clock, commands = begun(
        graph, maneuver='joystick', joy_timeout=0.3, enable_button=-1, joy_axes=[0, 1, 2]
    )
    publisher = graph.publisher(Joy, 'joy')
    for deflection in (0.0, 1.0):
        publisher.publish(Joy(header=TwistStamped().header, axes=[0.0, deflection, 0.0]))
        graph.spin(0.1)
    before = len(commands)
    for _ in range(25):
        clock.tick()
    followed = asked(commands[before:])[:, PITCH] != 0.0
    assert followed[: round(0.3 * RATE) - 1].all()
    assert not followed[round(0.3 * RATE) + 1 :].any()


def test_a_status_without_a_stamp_counts_at_once(graph):
    clock, commands = begun(graph, maneuver='basic_test', speed=math.pi, listeners=1)
    statuses = graph.publisher(WristStatus, 'wrist_status')
    for _ in range(5):
        clock.tick()
    message = WristStatus(time_lost=10.0)
    message.header.stamp = Time()
    statuses.publish(message)
    graph.spin(0.1)
    for _ in range(40):
        clock.tick()
    assert asked(commands)[-1, PITCH] == math.pi
    assert not asked(commands)[:, YAW].any()
