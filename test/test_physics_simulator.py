"""The physics simulator on a graph: in place of the hardware, as the joint simulator is."""

import math
import subprocess
import sys

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from wrist_control import WristError, make_wrist
from wrist_control.nodes.physics_settings import SPECS, driven
from wrist_control.nodes.physics_simulator import PhysicsSimulator
from wrist_control.physics.models import MODELS

from .physics_flown import RATE, PhysicsFlown

NAMES = ['psi', 'theta', 'phi']
LIGHT = {'payload': 0.1, 'joint_friction': [0.01]}
CALM = {'gravity': [0.0, 0.0, 0.0]}


def reached(parameters):
    """Return where a mechanism of some parameters is, period by period, on its way."""
    defaults = {spec.name: spec.default for spec in SPECS}
    mechanism = driven(make_wrist('double_hooke'), {**defaults, **LIGHT, **parameters})
    return [mechanism.advance((0.1, 0.1, 0.1)).positions for _ in range(30)]


def state_of(message):
    """Return the status `state` of an array of /diagnostics."""
    return next(one for one in message.status if one.name.endswith(': state'))


class Told:
    """The physics under a simulated clock, told what to do from outside."""

    def __init__(self, graph, kind=JointState, topic='joint_command', **parameters):
        self.graph, self.kind = graph, kind
        self.flown = PhysicsFlown(graph, parameters.pop('wrist', 'three_gimbal'), **parameters)
        self.publisher = graph.publisher(kind, topic)
        self.diagnostics = graph.listen(DiagnosticArray, '/diagnostics')

    def tell(self, values, names=NAMES, stamp=None):
        if self.kind is JointState:
            message = JointState(name=names, position=values)
            message.header.stamp = stamp or Time()
        else:
            message = Float64MultiArray(data=values)
        self.publisher.publish(message)
        self.graph.spin(0.1)

    def states(self, seconds):
        ticks = round(seconds * RATE)
        self.flown.pass_time(seconds)
        return self.flown.heard['joint_states'][-ticks:]

    def refused(self):
        """Wait for /diagnostics that count a refused message; return the counts."""
        counts = {}

        def is_counted():
            for message in self.diagnostics:
                for status in message.status:
                    counts.update({one.key: one.value for one in status.values})
            return any(key.startswith('refused') for key in counts)

        self.graph.until(is_counted)
        return {key: count for key, count in counts.items() if key.startswith('refused')}


@pytest.mark.parametrize('wrist', MODELS)
def test_before_a_command_is_heard_the_servos_hold_the_wrist_at_home(graph, wrist):
    flown = PhysicsFlown(graph, wrist, **CALM)
    flown.pass_time(0.5)
    made = make_wrist(wrist)
    last, pose = flown.heard['joint_states'][-1], flown.heard['true_hand_pose'][-1]
    assert list(last.name) == [joint.name for joint in made.joints]
    np.testing.assert_allclose(last.position, tuple(made.home), atol=1e-6)
    assert len(last.effort) == len(last.velocity) == len(last.name)
    home, found = made.forward(made.home), pose.pose
    q = found.orientation
    np.testing.assert_allclose(abs(np.dot(home.xyzw, (q.x, q.y, q.z, q.w))), 1.0, atol=1e-9)
    position = (found.position.x, found.position.y, found.position.z)
    np.testing.assert_allclose(position, home.position, atol=1e-6)
    assert (pose.header.frame_id, pose.header.stamp) == ('forearm', last.header.stamp)


def test_it_goes_where_joint_command_says_and_stays_there(graph):
    told = Told(graph, **CALM)
    told.tell([0.3, 0.1, -0.2], names=['phi', 'psi', 'theta'])
    last = told.states(0.5)[-1]
    assert list(last.position) == pytest.approx([0.1, -0.2, 0.3], abs=1e-6)
    assert list(told.states(1.0)[-1].position) == pytest.approx([0.1, -0.2, 0.3], abs=1e-6)


def test_a_command_counts_from_the_first_tick_after_its_stamp(graph):
    told = Told(graph, **CALM)
    now = told.states(1.0 / RATE)[-1].header.stamp
    later = now.sec * 10**9 + now.nanosec + round(1e9 / RATE)
    told.tell([0.3] * 3, stamp=Time(sec=later // 10**9, nanosec=later % 10**9))
    first, second = (state.position[0] for state in told.states(2.0 / RATE))
    assert first == pytest.approx(0.0, abs=1e-9)
    assert second > 0.1


def test_it_moves_as_joint_velocity_command_says_and_stops_when_that_falls_silent(graph):
    topic = 'joint_velocity_command'
    told = Told(graph, Float64MultiArray, topic, command=topic, velocity_timeout=0.5, **CALM)
    told.tell([0.5, 0.0, -0.5])
    assert list(told.states(0.45)[-1].velocity) == pytest.approx([0.5, 0.0, -0.5], abs=0.01)
    last = told.states(0.55)[-1]
    assert list(last.velocity) == pytest.approx([0.0] * 3, abs=1e-3)
    assert list(last.position) == pytest.approx([0.25, 0.0, -0.25], abs=0.5 / RATE + 1e-3)


@pytest.mark.parametrize(
    ('values', 'names', 'reason'),
    [
        ([0.1, math.nan, 0.1], NAMES, 'not finite'),
        ([0.1, 0.1], NAMES, 'wrong length'),
        ([0.1, 0.1, 0.1], ['a', 'b', 'c'], 'wrong joint names'),
    ],
)
def test_positions_that_cannot_be_meant_are_refused(graph, values, names, reason):
    told = Told(graph, **CALM)
    told.tell(values, names)
    assert told.refused() == {f'refused joint_command: {reason}': '1'}
    assert list(told.states(0.2)[-1].position) == [0.0] * 3


@pytest.mark.parametrize(
    ('values', 'reason'), [([math.inf, 0.0, 0.0], 'not finite'), ([0.1], 'wrong length')]
)
def test_rates_that_cannot_be_meant_are_refused(graph, values, reason):
    topic = 'joint_velocity_command'
    told = Told(graph, Float64MultiArray, topic, command=topic, **CALM)
    told.tell(values)
    assert told.refused() == {f'refused {topic}: {reason}': '1'}
    assert list(told.states(0.2)[-1].position) == [0.0] * 3


def test_a_joint_sticks_while_stuck_joint_says_so_and_diagnostics_say_it_too(graph):
    told = Told(graph, **CALM)
    node = told.flown.physics
    assert node.set_parameters([Parameter('stuck_joint', value='theta')])[0].successful
    told.tell([0.2, 0.2, 0.2])
    assert list(told.states(0.5)[-1].position) == pytest.approx([0.2, 0.0, 0.2], abs=1e-3)
    said = 'theta sticks, as it was told to.'
    graph.until(lambda: said in [state_of(one).message for one in told.diagnostics])
    assert node.set_parameters([Parameter('stuck_joint', value='')])[0].successful
    assert list(told.states(0.5)[-1].position) == pytest.approx([0.2] * 3, abs=1e-3)
    refused = node.set_parameters([Parameter('stuck_joint', value='elbow')])[0]
    assert refused.reason == (
        "stuck_joint is 'elbow'; valid is one of psi, theta, phi, or empty for none."
    )


@pytest.mark.parametrize(
    ('parameter', 'value'),
    [
        ('servo_bandwidth', 20.0),
        ('servo_damping', 0.3),
        ('effort_limits', [0.05, 5.0, 5.0]),
        ('joint_friction', [0.5, 0.0, 0.0]),
        ('payload', 1.0),
        ('gravity', [0.0, 9.8, 0.0]),
        ('loop_delay', 0.1),
        ('physics_step', 0.002),
        ('stuck_joint', 'psi'),
        ('balanced', True),
        ('initial_positions', [0.05]),
    ],
)
def test_every_parameter_of_the_mechanism_changes_what_happens(parameter, value):
    assert np.abs(np.subtract(reached({}), reached({parameter: value}))).max() > 1e-5


def test_a_prefix_and_a_namespace_come_before_names(graph):
    graph.start(PhysicsSimulator, namespace='/left', joint_prefix='l_', **CALM)
    states = graph.listen(JointState, '/left/joint_states')
    poses = graph.listen(PoseStamped, '/left/true_hand_pose')
    graph.until(lambda: states and poses)
    assert list(states[0].name) == ['l_psi', 'l_theta', 'l_phi']
    assert poses[0].header.frame_id == 'left/forearm'


def test_in_real_time_it_speaks_at_its_rate(graph):
    graph.start(PhysicsSimulator, rate=50.0)
    states = graph.listen(JointState, 'joint_states')
    graph.until(lambda: states)
    before = len(states)
    graph.spin(1.0)
    assert 25 <= len(states) - before <= 55


def test_physics_that_is_slower_than_real_time_is_a_warning(graph):
    graph.start(PhysicsSimulator, wrist='stewart', physics_step=1e-5)
    heard = graph.listen(DiagnosticArray, '/diagnostics')
    said = ' times real time; lower the rate, or lengthen physics_step.'
    graph.until(lambda: heard and said in state_of(heard[-1]).message)
    assert state_of(heard[-1]).level == DiagnosticStatus.WARN


def test_physics_that_diverges_is_an_error_and_no_joint_state(graph):
    graph.start(PhysicsSimulator, physics_step=0.005, servo_bandwidth=1000.0)
    states = graph.listen(JointState, 'joint_states')
    poses = graph.listen(PoseStamped, 'true_hand_pose')
    heard = graph.listen(DiagnosticArray, '/diagnostics')
    publisher = graph.publisher(JointState, 'joint_command')

    def is_said():
        publisher.publish(JointState(name=NAMES, position=[0.5, 0.5, 0.5]))
        graph.spin(0.02)
        return heard and state_of(heard[-1]).level == DiagnosticStatus.ERROR

    graph.until(is_said)
    assert state_of(heard[-1]).message.startswith('The mechanism was torn apart')
    numbers = [[*one.position, *one.velocity, *one.effort] for one in states]
    numbers += [[one.pose.position.x, one.pose.orientation.w] for one in poses]
    assert all(np.isfinite(row).all() for row in numbers)
    count = len(states)
    graph.spin(0.3)
    assert len(states) == count


@pytest.mark.parametrize(
    ('parameters', 'sentence'),
    [
        ({'wrist': 'elbow'}, "wrist is 'elbow'; valid is one of three_gimbal, four_gimbal"),
        ({'payload': -1.0}, 'payload is -1.0; valid is 0 to 1000 kg'),
        ({'payload': math.nan}, 'payload is nan; valid is 0 to 1000 kg'),
        ({'gravity': [1.0, 2.0]}, 'gravity has 2 values; give three: for x, y and z'),
        ({'loop_delay': 1.5}, 'loop_delay is 1.5; valid is 0 to 1 s'),
        ({'effort_limits': [1.0, 2.0]}, 'effort_limits has 2 values; give 1 for all joints or'),
        ({'effort_limits': [-1.0]}, 'effort_limits is -1.0; valid is a list of numbers, each 0'),
        ({'joint_friction': [math.inf]}, 'joint_friction is inf; valid is a list of numbers'),
        ({'stuck_joint': 'elbow'}, "stuck_joint is 'elbow'; valid is one of psi, theta, phi"),
        ({'initial_positions': [0.0, 1.0]}, 'initial_positions has 2 values'),
        ({'initial_positions': [math.nan]}, 'initial_positions is nan; valid is'),
        (
            {'wrist': 'stewart', 'initial_positions': [0.01]},
            'The mechanism cannot be assembled at ',
        ),
        ({'command': 'joint_effort'}, "command is 'joint_effort'; valid is one of joint_command"),
        ({'physics_step': 0.0}, 'physics_step is 0.0; valid is 1e-05 to 0.005 s'),
    ],
)
def test_bad_parameters_are_a_sentence(graph, parameters, sentence):
    with pytest.raises(WristError) as refused:
        graph.start(PhysicsSimulator, **parameters)
    assert str(refused.value).startswith(sentence)
    assert str(refused.value).endswith('.')


WITHOUT_MUJOCO = """
import sys
sys.modules['mujoco'] = None
sys.argv[0] = 'physics_simulator'
from wrist_control.nodes.physics_settings import SPECS, driven
from wrist_control.nodes.physics_simulator import main
main()
"""


@pytest.mark.parametrize('arguments', [(), ('--help',)])
def test_without_mujoco_it_says_how_to_get_it_and_ends_with_2(process_environment, arguments):
    done = subprocess.run(
        [sys.executable, '-c', WITHOUT_MUJOCO, *arguments],
        env=process_environment,
        capture_output=True,
        text=True,
        timeout=60.0,
        check=False,
    )
    sentence = 'mujoco, which the physics needs, is not installed; `make setup-physics` gets it.'
    assert done.returncode == 2
    assert f'Cannot start: {sentence}' in done.stderr
    assert 'Traceback' not in done.stderr
