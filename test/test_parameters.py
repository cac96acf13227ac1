"""Every parameter is described, ranged and checked; a bad value gets one sentence."""

import math
import re

import pytest
import rclpy
from rcl_interfaces.srv import SetParametersAtomically

from wrist_control import WRISTS, WristError
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.keyboard import Keyboard
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_interfaces.msg import WristStatus

OWN = {'use_sim_time', 'start_type_description_service'}  # rclpy's


def described(node):
    names = node.get_parameters_by_prefix('')
    return {name: node.describe_parameter(name) for name in names if name not in OWN}


@pytest.mark.parametrize('wrist', WRISTS)
def test_every_resolver_parameter_says_what_it_is_and_what_is_valid(graph, wrist):
    for name, descriptor in described(graph.start(Resolver, wrist)).items():
        assert descriptor.description, name
        assert descriptor.additional_constraints.startswith('valid: '), name


@pytest.mark.parametrize('kind', [Operator, JointSimulator, Keyboard])
def test_every_other_parameter_says_what_it_is_and_what_is_valid(graph, kind):
    for name, descriptor in described(graph.start(kind)).items():
        assert descriptor.description, name
        assert descriptor.additional_constraints.startswith('valid: '), name


@pytest.mark.parametrize(
    ('parameters', 'sentence'),
    [
        ({'rate': 0.0}, r'rate is 0.0; valid is 1 to 2000 Hz'),
        ({'rate': []}, r'rate is \[\]; valid is 1 to 2000 Hz'),
        ({'joint_rate_limits': '[]'}, r'joint_rate_limits is \[\]; valid is a list'),
        ({'joint_rate_limits': '[1.0, x]'}, r"joint_rate_limits is 'x'; valid is a list"),
        ({'rate': 'fast'}, r"rate is 'fast'; valid is 1 to 2000 Hz"),
        ({'command_timeout': math.nan}, r'command_timeout is nan; valid is 0.01 to 10 s'),
        ({'joint_rate_limits': [1.0, 2.0]}, r'joint_rate_limits has 2 values; give 1 for all'),
        ({'joint_rate_limits': [0.0]}, r'must be above 0'),
        ({'joint_deceleration_limits': [1e-300]}, r'1e-300 for psi, .* stops it within 10 s'),
        ({'joint_lower_limits': [1.0], 'joint_upper_limits': [-1.0]}, r'limits of psi cross'),
        ({'initial_positions': [0.0, 0.0]}, r'initial_positions has 2 values; give one for each'),
        ({'initial_positions': [0.0, math.pi / 2, 0.0]}, r'are at lock'),
        (
            {'initial_positions': [2.0, 0.0, 0.0], 'joint_upper_limits': [1.0]},
            r'initial_positions has 2 for psi; valid is',
        ),
    ],
)
def test_a_resolver_refuses_to_start_with_a_bad_value(graph, parameters, sentence):
    with pytest.raises(WristError, match=sentence):
        graph.start(Resolver, 'three_gimbal', **parameters)


@pytest.mark.parametrize(
    ('wrist', 'parameters', 'sentence'),
    [
        ('four_gimbal', {'gain': 0.0}, r'gain is 0.0; valid is 0.001 to 10 rad/s'),
        ('single_hooke', {'cone_half_angle': math.pi / 2}, r'cone_half_angle is 1.57'),
        ('double_hooke', {'shaft_length': -0.1}, r'shaft_length is -0.1; valid is'),
        ('omni_wrist', {'initial_positions': [0.0, 1.2, 0.0]}, r'lie outside: '),
        ('roll_pitch_roll', {'initial_positions': [0.0, 0.0, 0.0]}, r'are at lock'),
        ('carpal', {'plunge': 0.0}, r'plunge is 0.0; valid is'),
        ('carpal', {'plunge': 1.0}, r'plunge'),
        ('stewart', {'platform_radius': -1.0}, r'platform_radius is -1.0; valid is'),
    ],
)
def test_every_wrist_refuses_a_bad_dimension_or_start(graph, wrist, parameters, sentence):
    with pytest.raises(WristError, match=sentence):
        graph.start(Resolver, wrist, **parameters)


@pytest.mark.parametrize(
    ('parameters', 'sentence'),
    [
        ({'maneuver': 'loop'}, r"maneuver is 'loop'; valid is one of basic_test"),
        ({'speed': -1.0}, r'speed is -1.0; valid is'),
        ({'constant_rates': [1.0]}, r'constant_rates has 1 values; give three'),
    ],
)
def test_an_operator_refuses_to_start_with_a_bad_value(graph, parameters, sentence):
    with pytest.raises(WristError, match=sentence):
        graph.start(Operator, **parameters)


@pytest.mark.parametrize('kind', [JointSimulator, StewartForwardKinematics])
def test_a_list_may_be_empty_only_where_that_is_the_default(graph, kind):
    node = graph.start(kind)
    lists = {
        name: parameter.value
        for name, parameter in node.get_parameters_by_prefix('').items()
        if hasattr(parameter.value, '__len__') and not isinstance(parameter.value, str)
    }
    graph.end(node)
    assert {bool(len(value)) for value in lists.values()} == {True, False}
    for name, value in lists.items():
        if len(value):
            with pytest.raises(WristError, match=rf'{name} is \[\]; valid is a list'):
                graph.start(kind, **{name: []})
        else:
            graph.end(graph.start(kind, **{name: []}))


def test_whole_numbers_and_single_values_are_as_good_as_decimals_and_lists(graph):
    node = graph.start(Resolver, 'three_gimbal', rate=50, joint_rate_limits=2)
    assert node.get_parameter('rate').value == 50


def changed(graph, **parameters):
    request = SetParametersAtomically.Request(
        parameters=[rclpy.Parameter(n, value=v).to_parameter_msg() for n, v in parameters.items()]
    )
    service = 'three_gimbal_resolver/set_parameters_atomically'
    return graph.call(SetParametersAtomically, service, request).result


def test_a_limit_can_change_while_the_node_runs_and_a_bad_one_changes_nothing(graph):
    node = graph.start(Resolver, 'three_gimbal')
    assert changed(graph, joint_rate_limits=[0.2]).successful
    refused = changed(graph, joint_rate_limits=[0.3, -1.0, 0.3])
    assert not refused.successful
    assert 'joint_rate_limits is -1.0; valid is' in refused.reason
    assert list(node.get_parameter('joint_rate_limits').value) == [0.2]
    crossed = changed(graph, joint_upper_limits=[-math.inf])
    assert not crossed.successful
    assert 'cross' in crossed.reason


@pytest.mark.parametrize(
    ('name', 'narrower', 'wider', 'valid'),
    [
        ('joint_rate_limits', [0.2], [0.6, 0.5, 0.5], '0.6 for psi; .* valid is at most 0.5'),
        ('joint_lower_limits', [-0.5], [-0.9, -1.1, -0.9], '-1.1 for theta; .* at least -1,'),
        ('joint_upper_limits', [0.5], [math.inf], 'inf for psi; .* valid is at most 1,'),
    ],
)
def test_what_it_was_started_with_is_the_ceiling_of_a_live_limit(
    graph, name, narrower, wider, valid
):
    started = {
        'joint_rate_limits': [0.5],
        'joint_lower_limits': [-1.0],
        'joint_upper_limits': [1.0],
    }
    node = graph.start(Resolver, 'three_gimbal', **started)
    for _ in range(2):
        assert changed(graph, **{name: narrower}).successful
        refused = changed(graph, **{name: wider})
        assert not refused.successful
        assert re.search(f'{name} is {valid}', refused.reason)
        assert refused.reason.endswith('start it again with another limit.')
        assert list(node.get_parameter(name).value) == narrower
        assert changed(graph, **{name: started[name]}).successful


def test_what_must_not_change_while_the_node_runs_does_not(graph):
    graph.start(Resolver, 'three_gimbal')
    assert not changed(graph, rate=50.0).successful


def test_a_changed_limit_is_at_work_in_the_next_steps(graph):
    graph.start(Resolver, 'three_gimbal')
    statuses = graph.listen(WristStatus, 'wrist_status')
    graph.start(Operator, maneuver='constant', constant_rates=[0.3, 0.0, 0.0])
    graph.until(lambda: statuses and statuses[-1].state == WristStatus.TRACKING)
    assert changed(graph, joint_rate_limits=[0.1]).successful
    graph.until(lambda: statuses[-1].achieved.angular.x == pytest.approx(0.1))
    assert statuses[-1].state == WristStatus.SCALED
    assert statuses[-1].scale_factor == pytest.approx(1.0 / 3.0)
    limit = statuses[-1].limits[0]
    assert (limit.joint, limit.kind) == ('phi', limit.RATE)
    assert limit.asked == pytest.approx(0.3)
    assert limit.allowed == pytest.approx(0.1)
