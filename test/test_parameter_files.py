"""What the `ros2 param` tools write and load, every node takes; and it keeps its types."""

import math
from pathlib import Path

import pytest
import yaml
from rcl_interfaces.msg import Parameter, ParameterType
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters
from rclpy.parameter import get_parameter_value, parameter_value_to_python

from wrist_control import WRISTS
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.keyboard import Keyboard
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.physics_simulator import PhysicsSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.rotary_stewart_forward_kinematics import (
    RotaryStewartForwardKinematics,
)
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_control.ros.command_line import silent_files

CONFIG = Path(__file__).resolve().parents[1] / 'config'
NODES = [(Resolver, wrist) for wrist in WRISTS]
NODES += [(JointSimulator,), (PhysicsSimulator,), (Operator,), (StewartForwardKinematics,)]
NODES += [(Keyboard,)]
NODES += [(RotaryStewartForwardKinematics,)]
IDS = [node[-1] if node[1:] else node[0].__name__ for node in NODES]
FILES = sorted(CONFIG.glob('*.yaml'))
every_node = pytest.mark.parametrize('node', NODES, ids=IDS)


def started(graph, node, file=None, namespace=''):
    kind, *arguments = node
    return graph.add(
        kind(
            *arguments,
            namespace=namespace,
            context=graph.context,
            cli_args=['--ros-args', '--params-file', str(file)] if file else [],
            use_global_arguments=False,
        )
    )


def asked(graph, node, kind, service, **request):
    service = f'{node.get_fully_qualified_name()}/{service}'
    return graph.call(kind, service, kind.Request(**request))


def dumped(graph, node):
    """Return what `ros2 param dump` prints: every parameter, read through the services."""
    names = asked(graph, node, ListParameters, 'list_parameters').result.names
    answers = asked(graph, node, GetParameters, 'get_parameters', names=names).values
    values = {}
    for name, value in zip(names, map(parameter_value_to_python, answers), strict=True):
        listed = hasattr(value, '__len__') and not isinstance(value, str)
        values[name] = list(value) if listed else value
    return {node.get_fully_qualified_name(): {'ros__parameters': values}}


def loaded(graph, node, parameters):
    """Do what `ros2 param load` does: every value as text, one by one; return the refusals."""
    messages = [
        Parameter(name=name, value=get_parameter_value(str(value)))
        for name, value in parameters.items()
    ]
    answer = asked(graph, node, SetParameters, 'set_parameters', parameters=messages)
    return [
        f'{one.name}: {result.reason}'
        for one, result in zip(messages, answer.results, strict=True)
        if not result.successful
    ]


def for_node(file, node):
    """Return the parameters of a file that ROS gives to a node."""
    found = {}
    for key, content in yaml.safe_load(file.read_text()).items():
        if key.rpartition('/')[2] in ('**', node.get_name()):
            found.update(content['ros__parameters'])
    return found


@every_node
def test_a_dump_of_a_node_starts_that_node_again(graph, node, tmp_path):
    first = started(graph, node)
    before = dumped(graph, first)
    file = tmp_path / 'dump.yaml'
    file.write_text(yaml.dump(before, default_flow_style=False))
    graph.end(first)
    again = started(graph, node, file)
    assert dumped(graph, again) == before
    assert loaded(graph, again, before[again.get_fully_qualified_name()]['ros__parameters']) == []
    assert dumped(graph, again) == before


@pytest.mark.parametrize('file', FILES, ids=[file.name for file in FILES])
def test_a_shipped_file_loads_into_the_nodes_that_run_with_it(graph, file):
    known = {kind.__name__: (kind,) for kind in (JointSimulator, Operator)}
    names = {'joint_simulator': known['JointSimulator'], 'operator': known['Operator']}
    names['stewart_forward_kinematics'] = (StewartForwardKinematics,)
    names['rotary_stewart_forward_kinematics'] = (RotaryStewartForwardKinematics,)
    names['physics_simulator'] = (PhysicsSimulator,)
    names |= {f'{wrist}_resolver': (Resolver, wrist) for wrist in WRISTS}
    keys = {key.rpartition('/')[2] for key in yaml.safe_load(file.read_text())} - {'**'}
    assert keys <= set(names)
    for key in keys:
        running = started(graph, names[key], file)
        parameters = for_node(file, running)
        before = dumped(graph, running)
        assert parameters
        assert loaded(graph, running, parameters) == []
        assert dumped(graph, running) == before
        graph.end(running)


@every_node
def test_the_type_that_is_described_is_the_type_of_the_value(graph, node):
    running = started(graph, node)
    names = [name for name in running.get_parameters_by_prefix('') if name != 'use_sim_time']
    described = asked(graph, running, DescribeParameters, 'describe_parameters', names=names)
    values = asked(graph, running, GetParameters, 'get_parameters', names=names).values
    for descriptor, value in zip(described.descriptors, values, strict=True):
        assert descriptor.type == value.type != ParameterType.PARAMETER_NOT_SET, descriptor.name
        assert not descriptor.dynamic_typing, descriptor.name


@pytest.mark.parametrize('text', ['.inf', 'inf', '[inf]', '[0.4, .inf, inf]', '[0.4, 0.4, 0.4]'])
def test_no_limit_can_be_said_in_every_way_that_tools_have(graph, text):
    running = graph.start(Resolver, 'three_gimbal', joint_rate_limits=[math.inf])
    assert loaded(graph, running, {'joint_rate_limits': text}) == []
    rates = running.get_parameter('joint_rate_limits').value
    assert rates[-1] == (0.4 if text.endswith('0.4]') else math.inf)


def test_whole_numbers_are_whole(graph):
    running = graph.start(Operator, maneuver='joystick', joy_axes=[2.0, 1.0, 0.0])
    assert list(running.get_parameter('joy_axes').value) == [2, 1, 0]
    assert running.describe_parameter('joy_axes').type == ParameterType.PARAMETER_INTEGER_ARRAY
    assert running.describe_parameter('listeners').integer_range[0].to_value == 100
    (refused,) = loaded(graph, running, {'joy_axes': '[0.5, 1, 2]'})
    assert (
        "joy_axes is '0.5'; valid is a list of numbers, each a whole number, 0 to 100" in refused
    )


@every_node
def test_another_value_of_what_may_not_change_is_refused(graph, node):
    running = started(graph, node)
    name = 'rate' if running.has_parameter('rate') else 'gap_limit'
    (refused,) = loaded(graph, running, {name: 42.0})
    assert 'read-only' in refused
    assert loaded(graph, running, {name: running.get_parameter(name).value}) == []


def silent(tmp_path, *texts, node='/left/operator'):
    arguments = ['/bin/operator', '--ros-args']
    for name, text in zip(('some.yaml', 'other.yaml'), texts, strict=False):
        (tmp_path / name).write_text(text)
        arguments += ['--params-file', str(tmp_path / name)]
    return [*silent_files(arguments, node)]


RATE = '{ros__parameters: {rate: 5.0}}'


@pytest.mark.parametrize(
    'key', ['/**', '/**/operator', '/left/operator', '/left/*', '/*/operator', 'left/operator']
)
def test_a_file_for_this_node_is_not_named(tmp_path, key):
    assert silent(tmp_path, f'{key}: {RATE}\nother: {RATE}') == []
    assert silent(tmp_path, f'left: {{operator: {RATE}}}') == []


@pytest.mark.parametrize('key', ['operator', '/**/resolver', '/left', '/left/operators', '/*'])
def test_a_file_for_other_nodes_alone_is_named(tmp_path, key):
    (sentence,) = silent(tmp_path, f'{key}: {RATE}')
    assert 'and none of /left/operator: it changes nothing here' in sentence
    assert 'some.yaml' in sentence


def test_of_several_files_those_for_other_nodes_are_not_named(tmp_path):
    mine, others = f'/**: {RATE}', f'/**/resolver: {RATE}'
    assert silent(tmp_path, mine, others) == []
    assert len(silent(tmp_path, others, others)) == 2
    assert silent(tmp_path, '', '# nothing\n') == []
    assert len(silent(tmp_path, f'5: {RATE}')) == 1
    (sentence,) = silent(tmp_path, mine, f'/**/operator: {RATE}', node='/left/pilot')
    assert sentence.startswith(f'{tmp_path}/other.yaml has parameters of /**/operator')
