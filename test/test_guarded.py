"""Nothing kills a moving node: what nobody expected stops the hand, is told once, and is over."""

import itertools
import os
import subprocess

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Twist, TwistStamped
from rcl_interfaces.srv import SetParameters
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool, Trigger

from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_control.resolving.supervisor import Supervisor
from wrist_control.wrists import Wrist
from wrist_interfaces.msg import WristStatus

from .test_processes import EXECUTABLES

NODE = 'three_gimbal_resolver'
NAMES = ['psi', 'theta', 'phi']
# A step of a busy machine may be late; to unpack a million names takes twice as long.
PAUSE = 0.25  # s; to look at every name takes 0.4 s


class Turning:
    """A resolver that turns the hand, and everything that it says."""

    def __init__(self, graph):
        self.graph = graph
        self.node = graph.start(Resolver, 'three_gimbal')
        self.statuses = graph.listen(WristStatus, 'wrist_status')
        self.velocities = graph.listen(Float64MultiArray, 'joint_velocity_command')
        self.diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
        self.publisher = graph.publisher(Twist, 'cmd_vel_unstamped')
        self.until_state(WristStatus.TRACKING)
        graph.until(lambda: 0.4 in self.speeds())

    def until_state(self, state):
        twist = Twist()
        twist.angular.x = 0.4

        def commanded():
            self.publisher.publish(twist)
            return self.statuses and self.statuses[-1].state == state

        self.graph.until(commanded)

    def speeds(self):
        return [round(message.data[2], 9) for message in self.velocities]

    def errors(self):
        return [
            status
            for array in self.diagnostics[-1:]
            for status in array.status
            if status.level == DiagnosticStatus.ERROR
        ]

    def missed_steps(self):
        return sum(
            int(value.value)
            for status in self.diagnostics[-1].status
            for value in status.values
            if value.key == 'missed steps'
        )

    def enable(self, wanted=True):
        return self.graph.call(SetBool, f'{NODE}/enable', SetBool.Request(data=wanted))


@pytest.fixture
def turning(graph):
    return Turning(graph)


@pytest.fixture
def break_once(monkeypatch):
    """Let a method raise what nobody expects the first time that it is called."""

    def broken(kind, name, error=ZeroDivisionError):
        original = getattr(kind, name)
        calls = []

        def method(*arguments, **named):
            calls.append(name)
            if len(calls) == 1:
                raise error('of all things\n[FATAL] E-stop released')
            return original(*arguments, **named)

        monkeypatch.setattr(kind, name, method)

    return broken


def measured(graph):
    graph.publisher(JointState, 'joint_states').publish(JointState(name=NAMES, position=[0.0] * 3))


def reset(graph):
    answer = graph.call(Trigger, f'{NODE}/reset', Trigger.Request())
    assert not answer.success
    assert 'of all things' in answer.message


def slow_down(graph):
    request = SetParameters.Request(
        parameters=[Parameter('command_timeout', value=0.3).to_parameter_msg()]
    )
    (result,) = graph.call(SetParameters, f'{NODE}/set_parameters', request).results
    assert not result.successful
    assert 'of all things' in result.reason


@pytest.mark.parametrize(
    ('kind', 'name', 'trigger'),
    [
        (Supervisor, 'tick', lambda graph: None),
        (Supervisor, 'take_command', lambda graph: None),
        (Supervisor, 'take_measured', measured),
        (Supervisor, 'reset', reset),
        (Wrist, 'with_limits', slow_down),
        (DiagnosticArray, '__init__', lambda graph: None),
    ],
)
def test_an_error_in_any_callback_ramps_the_hand_into_a_fault_that_enable_clears(
    graph, turning, break_once, capfd, kind, name, trigger
):
    break_once(kind, name)
    trigger(graph)
    turning.until_state(WristStatus.FAULT)
    assert 'of all things' in turning.statuses[-1].message
    graph.until(lambda: turning.speeds()[-1] == 0.0)
    ramp = turning.speeds()
    down = ramp[len(ramp) - ramp[::-1].index(0.4) - 1 :]
    ramped = len([speed for speed in down if 0.0 < speed < 0.4])
    assert all(b <= a for a, b in itertools.pairwise(down))
    assert down[-1] == 0.0
    graph.until(lambda: len(turning.errors()) == 2)
    assert all('of all things' in error.message for error in turning.errors())
    # A machine that does not let it run lets a part of the ramp of 0.1 s pass meanwhile.
    assert ramped + turning.missed_steps() >= 7
    assert turning.enable().success
    turning.until_state(WristStatus.TRACKING)
    graph.until(lambda: not turning.errors())
    said = capfd.readouterr().err
    assert said.count('Traceback') == 1
    assert not any(line.startswith('[FATAL]') for line in said.splitlines())


def test_a_step_that_can_never_be_made_again_leaves_a_zero_and_the_node_alive(
    graph, turning, monkeypatch
):
    def broken(*arguments, **named):
        raise TypeError('the mathematics are gone')

    monkeypatch.setattr(Supervisor, 'tick', broken)
    graph.until(lambda: turning.speeds()[-1] == 0.0)
    graph.until(turning.errors)
    count = len(turning.velocities)
    graph.spin(0.2)
    assert len(turning.velocities) == count
    monkeypatch.undo()
    graph.until(lambda: turning.enable().success)
    turning.until_state(WristStatus.TRACKING)


def test_a_type_whose_name_is_not_text_is_named_and_stops_nothing(graph, turning, monkeypatch):
    def undecodable(self, topic):
        raise UnicodeDecodeError('utf-8', b'\xff', 0, 1, 'invalid start byte')

    monkeypatch.setattr(Node, 'get_publishers_info_by_topic', undecodable)
    expected = 'somebody publishes a type whose name is not text on /cmd_vel and is not heard'

    def told():
        turning.until_state(WristStatus.TRACKING)
        values = [v.value for a in turning.diagnostics[-1:] for s in a.status for v in s.values]
        return any(value.startswith(expected) for value in values)

    graph.until(told)
    assert not turning.errors()


def test_another_node_lives_too_and_shows_its_error(graph, break_once):
    graph.start(JointSimulator, joints=NAMES)
    states = graph.listen(JointState, 'joint_states')
    diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
    graph.until(lambda: states)
    break_once(JointState, '__init__')
    graph.until(
        lambda: any(
            s.level == DiagnosticStatus.ERROR and s.name == 'joint_simulator: errors'
            for a in diagnostics
            for s in a.status
        )
    )
    count = len(states)
    graph.until(lambda: len(states) > count)


def process(graph, executable, **parameters):
    return subprocess.Popen(
        [str(EXECUTABLES / executable), '--ros-args']
        + [part for name, value in parameters.items() for part in ('-p', f'{name}:={value}')],
        env={**os.environ, 'ROS_DOMAIN_ID': str(graph.domain)},
        stderr=subprocess.PIPE,
        text=True,
    )


def refused(diagnostics):
    return {
        value.key: int(value.value)
        for array in diagnostics[-1:]
        for status in array.status
        if status.name.endswith(': input')
        for value in status.values
    }


def test_a_million_joint_names_are_refused_without_a_pause(graph):
    running = process(graph, NODE)
    statuses = graph.listen(WristStatus, 'wrist_status')
    diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
    publisher = graph.publisher(JointState, 'joint_states')
    huge = JointState(name=['x'] * 10**6)
    graph.until(lambda: len(statuses) > 20)
    began = len(statuses)

    def told():
        publisher.publish(huge)
        graph.spin(0.3)
        return 'refused joint_states: too large' in refused(diagnostics)

    graph.until(told)
    running.terminate()
    running.communicate(timeout=10.0)
    stamps = [s.header.stamp.sec + 1e-9 * s.header.stamp.nanosec for s in statuses[began:]]
    assert max(b - a for a, b in itertools.pairwise(stamps)) < PAUSE


@pytest.mark.parametrize(('count', 'reason'), [(1001, 'too many joints'), (10**6, 'too large')])
def test_too_many_joint_names_are_refused_before_anything_is_done_with_them(
    graph, turning, count, reason
):
    message = JointState(name=['x'] * count)
    publisher = graph.publisher(JointState, 'joint_states')

    def told():
        publisher.publish(message)
        graph.spin(0.1)
        return f'refused joint_states: {reason}' in refused(turning.diagnostics)

    graph.until(told)


def test_a_frame_can_forge_no_line_of_the_log_and_hide_no_other(graph):
    running = process(graph, NODE)
    diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
    publisher = graph.publisher(TwistStamped, 'cmd_vel')
    message = TwistStamped()
    message.header.frame_id = 'hand\n[FATAL] E-stop released\n' + 'x' * 10000

    def told():
        publisher.publish(message)
        graph.spin(0.1)
        return 'refused cmd_vel: unknown frame' in refused(diagnostics)

    graph.until(told)
    running.terminate()
    said = running.communicate(timeout=10.0)[1]
    assert 'E-stop' in said
    assert not any(line.startswith('[FATAL]') for line in said.splitlines())
    assert max(len(line) for line in said.splitlines()) < 500
