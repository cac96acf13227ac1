"""The mechanisms: one for each wrist, from its dimensions, and without its kinematics."""

import ast
import math
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip('mujoco', reason='the extra physics is not installed')

from wrist_control import WRISTS, InvalidValueError, make_wrist, physics
from wrist_control.physics.mechanism import Settings
from wrist_control.physics.models import MODELS, build
from wrist_control.rotations import Pose
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Wrist

# What knows how a wrist moves; the home of the platform knows it too.
KINEMATICS = (
    'forward',
    'inverse',
    'jacobian',
    'bodies',
    'rates',
    'margin',
    'home',
    'assembly_at',
    'resolve_assembly',
    'forward_kinematics',
    'kinematics_at',
    'home_pose',
    'held',
    'solve',
    'tips',
)
SOURCES = [
    path
    for path in sorted(Path(physics.__file__).parent.glob('*.py'))
    if path.stem != 'driven'  # it is given a mechanism, and never sees a wrist
]


class Unknown(Wrist):
    """A wrist that nobody has made a mechanism of."""

    default_joints = (Joint('a'),)
    forward = inverse = jacobian = rates = margin = lambda self, *_: Pose((1.0, 0.0, 0.0, 0.0))


def test_every_wrist_has_a_mechanism():
    assert set(MODELS) <= set(WRISTS)
    assert len(MODELS) >= 10


def test_a_wrist_without_one_is_told_which_have():
    with pytest.raises(InvalidValueError, match=r'no mechanism for Unknown; .* three_gimbal, '):
        build(Unknown())


@pytest.mark.parametrize('source', SOURCES, ids=lambda source: source.stem)
def test_no_source_asks_a_wrist_for_its_kinematics(source):
    asked = {
        node.attr
        for node in ast.walk(ast.parse(source.read_text(encoding='utf-8')))
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Load)
    }
    assert asked.isdisjoint(KINEMATICS)


@pytest.mark.parametrize('name', MODELS)
def test_a_mechanism_is_built_and_moves_without_the_kinematics(name, monkeypatch):
    wrist = make_wrist(name)

    def refuse(*_):
        raise AssertionError('a mechanism knows no kinematics')

    for answer in KINEMATICS:
        if hasattr(type(wrist), answer):
            monkeypatch.setattr(type(wrist), answer, refuse)
    mechanism = build(wrist)
    mechanism.command(mechanism.positions + 0.01)
    assert mechanism.settle()


@pytest.mark.parametrize('name', MODELS)
def test_servos_are_called_and_ordered_like_the_joints(name):
    wrist = make_wrist(name)
    mechanism = build(wrist)
    names = [joint.name for joint in wrist.joints]
    assert list(mechanism.joints) == names
    assert sorted(mechanism.model.actuator(i).name for i in range(mechanism.model.nu)) == sorted(
        names
    )
    mechanism.start_at(wrist.home)
    for index in range(len(names)):
        target = mechanism.target
        target[index] += 0.01
        mechanism.command(target)
        assert mechanism.settle()
        assert mechanism.positions == pytest.approx(target, abs=1e-9)


@pytest.mark.parametrize('name', ['double_hooke', 'carpal', 'stewart', 'rotary_stewart'])
def test_a_mechanism_is_as_large_as_its_wrist(name):
    wrist = make_wrist(name)
    twice = make_wrist(
        name,
        **{
            key: 2.0 * getattr(wrist, key)
            for key, own in wrist.dimensions().items()
            if own.unit == 'm'
        },
    )
    hands = [build(one).hand_pose.position for one in (wrist, twice)]
    assert hands[1] == pytest.approx(2.0 * np.array(hands[0]), abs=1e-12)
    assert math.hypot(*hands[0]) > 0.05


def test_the_platform_is_built_on_the_anchors_that_are_given():
    plain = make_wrist('stewart')
    shifted = np.add(plain.base, (0.01, 0.0, 0.0))
    wrist = make_wrist('stewart', base_anchors=shifted.ravel().tolist())
    mechanism, other = build(wrist), build(plain)
    heads = np.add(plain.platform, (0.0, 0.0, plain.home_height))
    lengths = np.linalg.norm(heads - shifted, axis=1)
    assert mechanism.positions == pytest.approx(lengths, abs=1e-12)
    assert np.max(np.abs(mechanism.positions - other.positions)) > 1e-3


def test_counterweights_carry_the_links_and_not_the_payload():
    wrist = make_wrist('stewart')
    held = {}
    for balanced in (False, True):
        settings = Settings(gravity=(0.0, 0.0, -9.81), payload=0.5, balanced=balanced)
        mechanism = build(wrist, settings)
        mechanism.start_at(wrist.home)
        assert mechanism.settle()
        rise = np.subtract(wrist.platform, wrist.base)[:, 2] + wrist.home_height
        held[balanced] = float(mechanism.efforts @ (rise / mechanism.positions))
    assert held[True] == pytest.approx(0.5 * 9.81, rel=1e-3)
    assert held[False] > 1.3 * held[True]
