"""The launch file starts what there is: read with stand-ins, as the wheels have no `launch`.

The stand-ins only remember what they were made of, and say what it amounts to. They are the one
place where something pretends to be ROS in a test; where `launch` itself is, it is asked as well.
"""

import runpy
import signal
import subprocess
import sys
from contextlib import ExitStack
from importlib import metadata
from pathlib import Path
from types import ModuleType

import pytest
import yaml

from wrist_control import WRISTS, make_wrist
from wrist_control.nodes import operator
from wrist_control.nodes.resolver_settings import specs
from wrist_control.operating.maneuvers import MANEUVERS
from wrist_control.ros.parameters import checked
from wrist_interfaces.msg import WristStatus

ROOT = Path(__file__).resolve().parents[1]
CONTROL = ROOT / 'src' / 'wrist_control'
FILE = CONTROL / 'launch' / 'wrist.launch.py'
INTERFACES = (ROOT / 'docs' / 'interfaces.md').read_text()
OTHERS = {'joy': ['joy_node'], 'rviz2': ['rviz2']}


class Made:
    """What was given to one of the classes of `launch`."""

    def __init__(self, *given, **named):
        self.given, self.named = given, named


class LaunchConfiguration(Made):
    def perform(self, values):
        return values[self.given[0]]


class FindPackageShare(Made):
    def perform(self, values):
        assert self.given == ('wrist_control',)
        return str(CONTROL)


class EqualsSubstitution(Made):
    def perform(self, values):
        left, right = (text(one, values) for one in self.given)
        return str(left == right).lower()


class PythonExpression(Made):
    def perform(self, values):
        return str(eval(text(self.given[0], values)))


STAND_INS = {
    'launch': {'LaunchDescription': Made},
    'launch.actions': {'DeclareLaunchArgument': Made},
    'launch.conditions': {'IfCondition': Made},
    'launch.substitutions': {
        one.__name__: one for one in (EqualsSubstitution, LaunchConfiguration, PythonExpression)
    },
    'launch_ros': {},
    'launch_ros.actions': {'Node': Made},
    'launch_ros.substitutions': {'FindPackageShare': FindPackageShare},
}


def text(given, values):
    """Return what `launch` would make of a text, a substitution, or a list of them."""
    if isinstance(given, str):
        return given
    if isinstance(given, list):
        return ''.join(text(one, values) for one in given)
    return given.perform(values)


@pytest.fixture
def described(monkeypatch):
    """What the launch file describes: its arguments by name, and its nodes."""
    for name, content in STAND_INS.items():
        module = ModuleType(name)
        vars(module).update(content)
        monkeypatch.setitem(sys.modules, name, module)
    (entities,) = runpy.run_path(str(FILE))['generate_launch_description']().given
    arguments = {one.given[0]: one.named for one in entities if one.given}
    return arguments, [one.named for one in entities if not one.given]


def started(described, **given):
    """Return (package, executable, namespace, parameters, arguments) of all that is started."""
    arguments, nodes = described
    values = {}
    for name, facts in arguments.items():
        values[name] = given.pop(name, None) or text(facts['default_value'], values)
        assert values[name] in facts.get('choices', [values[name]])
    assert given == {}
    found = []
    for node in nodes:
        condition = node.get('condition')
        if condition and text(condition.given[0], values) == 'false':
            continue
        parameters = [
            {key: text(value, values) for key, value in one.items()}
            if isinstance(one, dict)
            else text(one, values)
            for one in node['parameters']
        ]
        words = [text(word, values) for word in node.get('arguments', [])]
        names = (text(node[key], values) for key in ('package', 'executable', 'namespace'))
        found.append((*names, parameters, words))
    return found


def executables():
    """Return the names of the executables that setup.py has made."""
    made = metadata.distribution('wrist_control').entry_points
    return {one.name for one in made if one.group == 'console_scripts'}


def names(nodes):
    return [executable for _, executable, *_ in nodes]


def test_without_arguments_it_is_one_wrist_with_simulated_joints(described):
    assert names(started(described)) == ['three_gimbal_resolver', 'joint_simulator']


@pytest.mark.parametrize('wrist', WRISTS)
def test_every_wrist_has_an_executable_and_a_file_of_parameters(described, wrist):
    there = {'wrist_control': executables(), **OTHERS}
    for operated in ('joystick', 'maneuver'):
        nodes = started(described, wrist=wrist, operator=operated, rviz='true')
        assert f'{wrist}_resolver' in names(nodes)
        for package, executable, _, parameters, _ in nodes:
            assert executable in there[package]
            if package == 'wrist_control':
                assert parameters[0] == f'{CONTROL}/config/{wrist}.yaml'
                assert Path(parameters[0]).is_file()


def test_every_wrist_and_every_maneuver_is_a_choice_and_nothing_else(described):
    arguments, _ = described
    assert arguments['wrist']['choices'] == list(WRISTS)
    assert arguments['maneuver']['choices'] == list(MANEUVERS)
    with pytest.raises(AssertionError):
        started(described, wrist='elbow')


@pytest.mark.parametrize(
    ('given', 'more'),
    [
        ({}, ['joint_simulator']),
        ({'joints': 'real'}, []),
        ({'joints': 'physics'}, ['physics_simulator']),
        ({'joints': 'real', 'operator': 'maneuver'}, ['operator']),
        ({'joints': 'real', 'operator': 'joystick'}, ['operator', 'joy_node']),
        ({'operator': 'none', 'rviz': 'true'}, ['joint_simulator', 'rviz2']),
    ],
)
def test_what_is_asked_for_is_started(described, given, more):
    assert names(started(described, **given)) == ['three_gimbal_resolver', *more]


@pytest.mark.parametrize('wrist', WRISTS)
def test_the_physics_is_that_of_the_wrist(described, wrist):
    nodes = started(described, wrist=wrist, joints='physics')
    (parameters,) = (one[3] for one in nodes if one[1] == 'physics_simulator')
    assert parameters[1:] == [{'wrist': wrist}]


@pytest.mark.parametrize(
    ('given', 'maneuver'),
    [
        ({'operator': 'maneuver'}, 'basic_test'),
        ({'operator': 'maneuver', 'maneuver': 'stick'}, 'stick'),
        ({'operator': 'joystick', 'maneuver': 'stick'}, 'joystick'),
    ],
)
def test_the_operator_does_what_is_asked(described, given, maneuver):
    (parameters,) = (one[3] for one in started(described, **given) if one[1] == 'operator')
    assert parameters[1:] == [{'maneuver': maneuver}]
    (spec,) = (one for one in operator.SPECS if one.name == 'maneuver')
    assert checked(spec, maneuver) == maneuver


def test_a_file_of_the_users_own_is_given_to_all(described):
    nodes = started(described, params_file='/my.yaml', operator='maneuver')
    assert [one[3][0] for one in nodes] == ['/my.yaml'] * 3


@pytest.mark.parametrize(
    ('namespace', 'frame'),
    [
        ('', 'forearm'),
        ('left', 'left/forearm'),
        ('/left', 'left/forearm'),
        ('/a/b', 'a/b/forearm'),
    ],
)
def test_all_are_in_the_namespace_and_rviz_looks_at_its_frame(described, namespace, frame):
    nodes = started(described, namespace=namespace, rviz='true', operator='joystick')
    assert {one[2] for one in nodes} == {namespace}
    (drawn,) = (one[4] for one in nodes if one[0] == 'rviz2')
    assert drawn == ['-d', f'{CONTROL}/rviz/wrist.rviz', '-f', frame]
    assert Path(drawn[1]).is_file()
    assert 'forearm' in {
        one.default for one in specs(make_wrist('carpal')) if one.name == 'forearm_frame'
    }


def test_every_argument_says_what_it_is_and_is_in_the_documents(described):
    arguments, _ = described
    assert all(facts['description'] for facts in arguments.values())
    assert [name for name in arguments if f'| `{name}` |' not in INTERFACES] == []


def commands(described, folder, **given):
    """Return the commands that launch_ros makes: a file for parameters that are in none."""
    for _, executable, namespace, parameters, _ in started(described, **given):
        files = [one for one in parameters if isinstance(one, str)]
        for one in (one for one in parameters if isinstance(one, dict)):
            files.append(str(folder / 'parameters.yaml'))
            Path(files[-1]).write_text(yaml.dump({'/**': {'ros__parameters': one}}))
        options = [word for file in files for word in ('--params-file', file)]
        yield [executable, '--ros-args', '-r', f'__ns:=/{namespace}', *options]


def test_what_it_starts_flies_and_heeds_all_parameters(
    described, graph, process_environment, tmp_path
):
    environment = {**process_environment, 'ROS_DOMAIN_ID': str(graph.domain)}
    statuses = graph.listen(WristStatus, '/left/wrist_status')
    # Long enough for whoever begins to listen some seconds late.
    given = {'wrist': 'four_gimbal', 'operator': 'maneuver', 'maneuver': 'extended_test'}
    made = commands(described, tmp_path, namespace='left', **given)
    with ExitStack() as stack:
        processes = []
        for command in made:
            process = subprocess.Popen(command, env=environment, stderr=subprocess.PIPE, text=True)
            stack.callback(process.kill)
            processes.append(process)
        moving = (WristStatus.TRACKING, WristStatus.SCALED)
        graph.until(lambda: statuses and statuses[-1].state in moving)
        assert statuses[-1].header.frame_id == 'left/hand'
        for process in processes:
            process.send_signal(signal.SIGINT)
            said = process.communicate(timeout=10.0)[1]
            assert process.returncode == 0
            assert 'changes nothing' not in said


def test_launch_itself_takes_it_where_it_is():
    pytest.importorskip('launch_ros')
    description = runpy.run_path(str(FILE))['generate_launch_description']()
    assert len(description.entities) == 13
