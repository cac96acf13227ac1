"""What /diagnostics says, once a second: how each node is, and what it has refused."""

import math
import time

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Twist, TwistStamped
from sensor_msgs.msg import JointState, Joy

from wrist_control import make_wrist
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics

NAMES = ['psi', 'theta', 'phi']
OK, WARN, ERROR = DiagnosticStatus.OK, DiagnosticStatus.WARN, DiagnosticStatus.ERROR


def parts(array):
    """Return the parts of one message by the last word of their names."""
    return {status.name.rpartition(': ')[2]: status for status in array.status}


def values(status):
    return {value.key: value.value for value in status.values}


class Told:
    """What a node says of itself on /diagnostics."""

    def __init__(self, graph):
        self.graph = graph
        self.heard = graph.listen(DiagnosticArray, '/diagnostics')

    def next(self):
        count = len(self.heard)
        self.graph.until(lambda: len(self.heard) > count)
        return parts(self.heard[-1])


def twist(x=0.0, y=0.0):
    message = Twist()
    message.angular.x, message.angular.y = x, y
    return message


def test_a_resolver_at_rest_is_ok_by_its_name_and_shows_its_numbers(graph):
    graph.start(Resolver, 'three_gimbal', namespace='left', initial_positions=[0.0, 1.0, 0.0])
    told = Told(graph)
    first = told.next()
    assert (first['input'].level, first['input'].message) == (OK, '0 messages refused so far')
    assert not first['input'].values
    state = first['state']
    assert state.name == 'left/three_gimbal_resolver: state'
    assert state.hardware_id == 'wrist_control'
    assert (state.level, state.message) == (OK, 'Ready: no motion is commanded.')
    shown = values(state)
    assert shown.pop('missed steps').isdecimal()
    assert shown.pop('lateness of a step').startswith('p50 ')
    assert shown == {
        'state': 'IDLE',
        'scale factor': '1.0000',
        'time lost': '0.0000 s',
        'margin': f'{math.cos(1.0):.4f}',
    }
    stamp = told.heard[-1].header.stamp
    age = graph.outside.get_clock().now().nanoseconds - (stamp.sec * 10**9 + stamp.nanosec)
    assert abs(age) < 5e9


def test_it_comes_once_a_second_and_warns_once_of_what_was_refused_since(graph):
    graph.start(Resolver, 'three_gimbal')
    heard = graph.listen(DiagnosticArray, '/diagnostics')
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')
    graph.until(lambda: heard)
    heard.clear()
    bad = twist(x=math.nan)
    began = time.monotonic()
    for _ in range(2):
        publisher.publish(bad)
        graph.spin(0.1)
    graph.until(lambda: len(heard) == 4)
    assert 3.0 < time.monotonic() - began < 5.0
    inputs = [parts(array)['input'] for array in heard]
    levels = [one.level for one in inputs]
    assert levels.count(WARN) == 1
    told = levels.index(WARN)
    assert levels == [OK] * told + [WARN] + [OK] * (3 - told)
    assert inputs[-1].name == 'three_gimbal_resolver: input'
    assert inputs[-1].message == '2 messages refused so far'
    assert values(inputs[-1]) == {'refused cmd_vel_unstamped: not finite': '2'}


@pytest.mark.parametrize(
    ('positions', 'command', 'state', 'level'),
    [
        ([0.0, 0.5, 0.0], twist(y=0.3), 'LIMITED', WARN),
        ([0.0, 0.0, 0.0], twist(x=1.0), 'SCALED', OK),
        ([0.0, 0.0, 0.0], twist(x=0.1), 'TRACKING', OK),
    ],
)
def test_the_level_is_that_of_the_state(graph, positions, command, state, level):
    graph.start(
        Resolver, 'three_gimbal', initial_positions=positions, joint_upper_limits=[9.0, 0.5, 9.0]
    )
    told = Told(graph)
    publisher = graph.publisher(Twist, 'cmd_vel_unstamped')

    def shown():
        publisher.publish(command)
        last = parts(told.heard[-1])['state'] if told.heard else None
        return last and values(last)['state'] == state

    graph.until(shown)
    assert parts(told.heard[-1])['state'].level == level


def test_a_held_command_that_has_run_out_is_a_warning_and_a_fault_is_an_error(graph):
    graph.start(Resolver, 'three_gimbal')
    told = Told(graph)
    graph.publisher(Twist, 'cmd_vel_unstamped').publish(twist(x=0.1))
    graph.until(lambda: told.heard and values(told.next()['state'])['state'] == 'STALE')
    assert told.next()['state'].level == WARN
    graph.start(Resolver, 'omni_wrist')
    measured = graph.publisher(JointState, 'joint_states', listeners=2)
    beyond = JointState(name=['phi', 'theta_a', 'psi_a'], position=[0.0, math.pi / 2, math.pi / 2])

    def faults():
        measured.publish(beyond)
        graph.spin(0.1)
        return [
            status
            for array in told.heard
            for status in array.status
            if status.name == 'omni_wrist_resolver: state' and status.level == ERROR
        ]

    graph.until(faults)
    assert values(faults()[-1])['state'] == 'FAULT'
    assert '~/enable' in faults()[-1].message


def test_a_publisher_of_the_wrong_type_is_a_warning_while_the_resolver_is_well(graph):
    with graph.stranger(Twist, 'cmd_vel'):
        graph.start(Resolver, 'three_gimbal')
        told = Told(graph)
        graph.until(lambda: told.heard and parts(told.heard[-1])['state'].level == WARN)
        state = parts(told.heard[-1])['state']
        assert state.message == 'Ready: no motion is commanded.'
        assert 'is not heard' in values(state)['old_teleop on /cmd_vel']


@pytest.mark.parametrize(
    ('parameters', 'sentence'),
    [
        ({'maneuver': 'joystick'}, 'Following the joystick.'),
        (
            {'maneuver': 'constant', 'constant_rates': [0.1, 0.2, 0.3]},
            'Publishing constant rates [0.1, 0.2, 0.3].',
        ),
        ({'maneuver': 'stick'}, 'Waiting for somebody to listen to cmd_vel.'),
        ({'maneuver': 'stick', 'listeners': 0}, 'Flying stick.'),
    ],
)
def test_an_operator_says_what_it_does(graph, parameters, sentence):
    graph.start(Operator, **parameters)
    state = Told(graph).next()['state']
    assert (state.name, state.level, state.message) == ('operator: state', OK, sentence)


def test_an_operator_says_when_its_maneuver_is_flown_and_asks_for_nothing_then(graph):
    graph.start(Operator, maneuver='pitch_then_roll', speed=50.0, listeners=0)
    commands = graph.listen(TwistStamped, 'cmd_vel')
    told = Told(graph)
    graph.until(lambda: told.next()['state'].message == 'Flown pitch_then_roll.')
    assert any(command.twist.angular.x for command in commands)
    assert commands[-1].twist == TwistStamped().twist


def test_a_joystick_with_too_few_buttons_is_refused_and_asks_for_nothing(graph):
    graph.start(Operator, maneuver='joystick')
    commands = graph.listen(TwistStamped, 'cmd_vel')
    told = Told(graph)
    publisher = graph.publisher(Joy, 'joy')

    def counted():
        publisher.publish(Joy(axes=[1.0, 1.0, 1.0, 1.0], buttons=[1]))
        graph.spin(0.1)
        return told.heard and values(parts(told.heard[-1])['input'])

    graph.until(counted)
    assert list(counted()) == ['refused joy: too few buttons']
    assert all(command.twist == TwistStamped().twist for command in commands)


def test_a_joint_simulator_says_whom_it_waits_for_and_where_its_joints_are(graph):
    graph.start(JointSimulator)
    told = Told(graph)
    state = told.next()['state']
    waits = 'Waiting for initial_joints or joint_command to learn the joints.'
    assert (state.name, state.level, state.message) == ('joint_simulator: state', OK, waits)
    graph.publisher(JointState, 'joint_command').publish(
        JointState(name=NAMES, position=[0.1, 0.2, 0.3])
    )
    graph.until(lambda: values(told.next()['state']))
    state = told.next()['state']
    assert (state.level, state.message) == (OK, 'Simulating 3 joints.')
    assert values(state) == {'psi': '0.100000', 'theta': '0.200000', 'phi': '0.300000'}


def test_forward_kinematics_with_a_fresh_pose_is_ok_and_says_how_fresh(graph):
    graph.start(StewartForwardKinematics)
    told = Told(graph)
    home = make_wrist('stewart').home
    reading = JointState(name=[f'leg_{leg}' for leg in range(1, 7)], position=list(home))
    publisher = graph.publisher(JointState, 'joint_states')

    def well():
        publisher.publish(reading)
        graph.spin(0.05)
        return told.heard and parts(told.heard[-1])['state'].level == OK

    graph.until(well)
    shown = values(parts(told.heard[-1])['state'])
    assert parts(told.heard[-1])['state'].message.startswith('The pose is proved')
    assert 0.0 <= float(shown['time without a good pose'].removesuffix(' s')) < 1.0
    assert 0.0 < float(shown['error bound']) < 1e-9
    assert float(shown['unique radius']) > 0.01
    assert int(shown['iterations']) >= 0
    assert (shown['status'], shown['last refused']) == ('0', 'nothing since the last good pose')
