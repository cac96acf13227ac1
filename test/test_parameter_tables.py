"""The tables of docs/interfaces.md, row by row, against the nodes' own parameters."""

import math
import re
from pathlib import Path

import pytest

from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.keyboard import Keyboard
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.physics_simulator import PhysicsSimulator
from wrist_control.nodes.recorder import Recorder
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.rotary_stewart_forward_kinematics import (
    RotaryStewartForwardKinematics,
)
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_control.web.console import Console

TEXT = (Path(__file__).resolve().parents[1] / 'docs' / 'interfaces.md').read_text()
SECTIONS = {
    'Parameters of every resolver': (Resolver, 'three_gimbal'),
    'Parameters of stewart_forward_kinematics': (StewartForwardKinematics,),
    'Parameters of rotary_stewart_forward_kinematics': (RotaryStewartForwardKinematics,),
    'Parameters of the operator': (Operator,),
    'Parameters of the keyboard': (Keyboard,),
    'Parameters of the joint simulator': (JointSimulator,),
    'Parameters of the console': (Console,),
    'Parameters of the recorder': (Recorder,),
    'Parameters of the physics simulator': (PhysicsSimulator,),
}
# Defaults that the tables say in words, or in units that people think in.
IN_WORDS = {
    'zeros': (0.0, 0.0, 0.0),
    'empty': (),
    '∓32 deg/s': tuple(math.radians(x) for x in (-32.0, 32.0, 32.0)),
    '32 deg/s; 50 mm/s': (math.radians(32.0),) * 3,
}


def rows(section):
    """Return name, default, valid and live of the parameters of one table."""
    table = TEXT.split(f'## {section}\n')[1].split('\n## ')[0].split('\n### ')[0]
    lines = [
        [cell.strip() for cell in line.strip('|').split('|')]
        for line in table.splitlines()
        if line.startswith('|')
    ]
    head, _, *body = lines
    for row in body:
        facts = dict(zip(head, row, strict=True))
        names = re.findall(r'`(\w+)`', facts['parameter'])
        defaults = facts['default'].replace('`', '').split(', ')
        if len(defaults) != len(names):
            defaults = [', '.join(defaults)] * len(names)
        for name, default in zip(names, defaults, strict=True):
            yield name, default, facts['valid'].replace('−', '-'), facts.get('live', '') == 'yes'


def numbers_of(default):
    """Return the numbers that a table says, None where it is the mechanism's own."""
    if default in IN_WORDS:
        return IN_WORDS[default]
    if match := re.fullmatch(r'([\d.]+) deg/s', default):
        return (math.radians(float(match[1])),)
    if re.fullmatch(r'[\d., ]+', default):
        return tuple(float(part) for part in default.split(','))
    return None


@pytest.mark.parametrize('section', SECTIONS)
def test_every_row_of_a_table_is_true(graph, section):
    node = graph.start(*SECTIONS[section])
    for name, default, valid, live in rows(section):
        value, descriptor = node.get_parameter(name).value, node.describe_parameter(name)
        assert descriptor.read_only != live, name
        found = value if hasattr(value, '__len__') else [value]
        if isinstance(value, str):
            assert value == ('' if default == 'empty' else default), name
        elif default == 'none':
            assert all(math.isinf(x) for x in found), name
        elif (expected := numbers_of(default)) is not None:
            assert tuple(found) == pytest.approx(expected), name
        if match := re.match(r'(-?[\de.-]+) to ([\d.]+|inf)( \S+)?', valid):
            assert descriptor.additional_constraints.endswith(f' {match[0]}'), name
        if valid.startswith(('above 0', 'what stops')):
            assert ' 0 to inf ' in descriptor.additional_constraints, name


@pytest.mark.parametrize(('wrist', 'unit'), [('three_gimbal', 'rad'), ('stewart', 'm')])
def test_limits_are_told_in_the_units_of_the_joints(graph, wrist, unit):
    node = graph.start(Resolver, wrist)
    for name, expected in (
        ('joint_rate_limits', f'{unit}/s'),
        ('joint_lower_limits', unit),
        ('joint_upper_limits', unit),
        ('initial_positions', unit),
    ):
        assert node.describe_parameter(name).description.endswith(f' [{expected}]'), name
