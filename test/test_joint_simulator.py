"""The joint simulator on a graph: at real rates, within limits, each position at its own stamp."""

import math

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import JointState

from wrist_control import WristError
from wrist_control.nodes.joint_simulator import JointSimulator

RATE = 50.0
NAMES = ['psi', 'theta']


class Simulated:
    """A joint simulator under a simulated clock, and what it says at each tick."""

    def __init__(self, graph, **parameters):
        self.graph = graph
        self.clock = graph.lockstep(1.0 / RATE)
        graph.start(JointSimulator, use_sim_time=True, rate=RATE, **parameters)
        self.clock.listen({'joint_states': JointState})
        self.publisher = graph.publisher(JointState, 'joint_command')

    def tell(self, positions, names=NAMES, stamp=None):
        message = JointState(name=names, position=positions)
        message.header.stamp = stamp or Time()
        self.publisher.publish(message)
        self.graph.spin(0.1)

    def states(self, ticks):
        for _ in range(ticks):
            self.clock.tick()
        return self.clock.heard['joint_states'][-ticks:]


def test_each_joint_goes_to_its_target_at_its_own_rate_and_stops_there(graph):
    simulated = Simulated(
        graph, joints=NAMES, initial_positions=[0.1, 0.2], joint_rate_limits=[1.0, 2.0]
    )
    simulated.clock.begin()
    simulated.tell([0.2, 0.0])
    states = simulated.states(8)
    count = np.arange(1, 9)[:, None]
    expected = np.clip([0.1, 0.2] + count / RATE * [1.0, -2.0], [0.1, 0.0], [0.2, 0.2])
    np.testing.assert_allclose([state.position for state in states], expected, atol=1e-12)
    rates = np.diff(np.vstack([[0.1, 0.2], expected]), axis=0) * RATE
    np.testing.assert_allclose([state.velocity for state in states], rates, atol=1e-9)
    assert all(list(state.name) == NAMES for state in states)


def test_one_limit_for_all_holds_every_joint(graph):
    simulated = Simulated(
        graph,
        joints=NAMES,
        joint_rate_limits=[math.inf],
        joint_lower_limits=[-0.5],
        joint_upper_limits=[0.25],
    )
    simulated.clock.begin()
    simulated.tell([1.0, -1.0])
    assert list(simulated.states(2)[-1].position) == [0.25, -0.5]


def test_unless_told_otherwise_a_joint_turns_64_degrees_in_a_second(graph):
    simulated = Simulated(graph, joints=NAMES)
    simulated.clock.begin()
    simulated.tell([9.0, -9.0])
    state = simulated.states(1)[-1]
    assert list(state.velocity) == pytest.approx([math.radians(64.0), -math.radians(64.0)])


def test_a_command_counts_from_the_first_tick_after_its_stamp(graph):
    simulated = Simulated(graph, joints=NAMES, joint_rate_limits=[math.inf])
    simulated.clock.begin()
    now = simulated.states(1)[-1].header.stamp
    later = now.sec * 10**9 + now.nanosec + round(1e9 / RATE)
    simulated.tell([0.3, 0.3], stamp=Time(sec=later // 10**9, nanosec=later % 10**9))
    assert [state.position[0] for state in simulated.states(2)] == [0.0, 0.3]


def test_joints_may_come_in_another_order_and_among_others(graph):
    simulated = Simulated(graph, joints=NAMES, joint_rate_limits=[math.inf])
    simulated.clock.begin()
    simulated.tell([0.3, 7.0, 0.1], names=['theta', 'elbow', 'psi'])
    assert list(simulated.states(1)[-1].position) == [0.1, 0.3]


def test_without_names_it_learns_them_and_begins_where_it_is_first_told(graph):
    graph.start(JointSimulator)
    states = graph.listen(JointState, 'joint_states')
    publisher = graph.publisher(JointState, 'joint_command')
    graph.spin(0.2)
    assert not states
    publisher.publish(JointState(name=NAMES, position=[0.1, 0.2]))
    graph.until(lambda: len(states) > 2)
    assert list(states[0].name) == NAMES
    assert all(list(state.position) == [0.1, 0.2] for state in states)
    assert all(list(state.velocity) == [0.0, 0.0] for state in states)


def test_without_names_it_begins_at_the_initial_positions_where_there_are_some(graph):
    graph.start(JointSimulator, initial_positions=[0.5], joint_rate_limits=[1e-6])
    states = graph.listen(JointState, 'joint_states')
    graph.publisher(JointState, 'joint_command').publish(
        JointState(name=NAMES, position=[0.1, 0.2])
    )
    graph.until(lambda: states)
    assert list(states[0].position) == pytest.approx([0.5, 0.5], abs=1e-3)


@pytest.mark.parametrize(
    ('parameters', 'message'),
    [
        ({'joint_upper_limits': [0.15]}, JointState(name=NAMES, position=[0.1, 0.2])),
        ({'joint_rate_limits': [1.0, 1.0, 1.0]}, JointState(name=NAMES, position=[0.1, 0.2])),
    ],
)
def test_a_first_command_that_does_not_fit_the_limits_is_refused(graph, parameters, message):
    graph.start(JointSimulator, **parameters)
    states = graph.listen(JointState, 'joint_states')
    heard = graph.listen(DiagnosticArray, '/diagnostics')
    publisher = graph.publisher(JointState, 'joint_command')
    key = 'refused joint_command: unusable'

    def refused():
        publisher.publish(message)
        graph.spin(0.05)
        return key in [v.key for array in heard for s in array.status for v in s.values]

    graph.until(refused)
    assert not states


def test_a_first_command_of_no_joints_is_refused(graph):
    graph.start(JointSimulator)
    states = graph.listen(JointState, 'joint_states')
    publisher = graph.publisher(JointState, 'joint_command')
    for _ in range(3):
        publisher.publish(JointState())
        graph.spin(0.05)
    assert not states


@pytest.mark.parametrize(
    'parameters',
    [
        {'initial_positions': [0.0, 0.3], 'joint_upper_limits': [0.2]},
        {'initial_positions': [0.0, -0.3], 'joint_lower_limits': [-0.2]},
        {'joint_rate_limits': [1.0, 0.0]},
    ],
)
def test_a_start_outside_the_limits_or_without_a_rate_is_refused(graph, parameters):
    start = parameters.get('initial_positions', [0.0, 0.0])[1]
    with pytest.raises(WristError, match=f'theta cannot start at {start:g} with limits'):
        graph.start(JointSimulator, joints=NAMES, **parameters)


def test_a_start_at_a_limit_is_a_good_start(graph):
    limits = {'joint_lower_limits': [-0.2], 'joint_upper_limits': [0.3]}
    graph.start(JointSimulator, joints=NAMES, initial_positions=[-0.2, 0.3], **limits)
    states = graph.listen(JointState, 'joint_states')
    graph.until(lambda: states)
    assert list(states[0].position) == [-0.2, 0.3]
