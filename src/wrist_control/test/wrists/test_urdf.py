"""The wrist of a URDF against the wrists that it is the same as, and its four joints' freedom."""

import dataclasses
import math

import numpy as np
import pytest

from wrist_control import InvalidValueError, errors, fly, make_wrist
from wrist_control.operating.maneuvers import Maneuver, Segment
from wrist_control.resolving.limits import LimitKind
from wrist_control.resolving.report import sentence
from wrist_control.resolving.state import State
from wrist_control.resolving.step import start, step
from wrist_control.wrists import wrist_names

from .robots import FOLDER, SHIPPED, random_robot, robot, shipped, wrist_of

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
# Wrists of the registry, and the axes that make the same of a robot.
TWINS = {
    'three_gimbal': (Z, Y, X),
    'roll_pitch_roll': (X, Y, X),
    'four_gimbal': (Z, Y, X, Z),
    'pitch_yaw': (Y, X),
}


def twins(name):
    """Return a registered wrist, a robot's, and how the joints of the one stand in the other."""
    order = [1, 0] if name == 'pitch_yaw' else [0, 1, 2, 3][: len(TWINS[name])]
    return make_wrist(name), wrist_of(TWINS[name]), order


def places(name, count=100):
    random = np.random.default_rng(5)
    one, other, order = twins(name)
    for _ in range(count):
        positions = random.uniform(-3.0, 3.0, len(order))
        if one.margin(positions) > 0.05:
            yield one, other, order, positions, random


@pytest.mark.parametrize('name', TWINS)
def test_it_is_the_wrist_that_has_the_same_axes(name):
    for one, other, order, positions, random in places(name):
        theirs = positions[order]
        pose = one.forward(positions)
        np.testing.assert_allclose(other.forward(theirs).rotation, pose.rotation, atol=1e-14)
        assert other.margin(theirs) == pytest.approx(one.margin(positions), abs=1e-14)
        near = positions + random.uniform(-0.05, 0.05, len(positions))
        expected = np.array(one.inverse(pose, near))[order]
        np.testing.assert_allclose(other.inverse(pose, near[order]), expected, atol=1e-12)
        twist = random.uniform(-1.0, 1.0, 3)
        rates = np.array(one.rates(positions, twist))[order]
        np.testing.assert_allclose(other.rates(theirs, twist), rates, rtol=1e-9, atol=1e-9)
        jacobian = one.jacobian(positions)[:, order]
        np.testing.assert_allclose(other.jacobian(theirs), jacobian, atol=1e-14)
        assert other.followed_axes == one.followed_axes
        ours = one.target_pose(pose, twist, 0.02).rotation
        np.testing.assert_allclose(other.target_pose(pose, twist, 0.02).rotation, ours, atol=1e-9)


@pytest.mark.parametrize('maneuver', ['basic_test', 'extended_test'])
def test_four_joints_are_steered_as_barkers_fourth_gimbal_is(maneuver):
    """His law is what the general one is where all axes are square; its sides are the same."""
    barker = fly('four_gimbal', maneuver, joint_rate_limits=math.inf)
    ours = fly(wrist_of(TWINS['four_gimbal']), maneuver, joint_rate_limits=math.inf)
    np.testing.assert_allclose(ours.joint_positions, barker.joint_positions, atol=1e-6)


def test_next_to_a_limit_the_spare_joint_is_steered_as_barkers_is():
    one, other, _ = twins('four_gimbal')
    limits = {'lower': [-0.5, -1.0, -0.4, -0.2], 'upper': [0.5, 1.0, 0.4, 0.2]}
    one, other = one.with_limits(**limits), other.with_limits(**limits)
    random = np.random.default_rng(2)
    for _ in range(100):
        positions = random.uniform(limits['lower'], limits['upper'])
        expected = one.choose_branch_reference(positions, 1.0, 0.1, ())
        found = other.choose_branch_reference(positions, 1.0, 0.1, ())
        np.testing.assert_allclose(found[0], expected[0], atol=1e-12)


def test_the_inverse_is_exact_for_any_axes():
    random = np.random.default_rng(7)
    for count in (2, 3, 4) * 40:
        wrist = random_robot(random, count)
        positions = random.uniform(-9.0, 9.0, count)
        pose = wrist.forward(positions)
        found = wrist.inverse(pose, positions + random.uniform(-1e-3, 1e-3, count) * (count < 4))
        np.testing.assert_allclose(wrist.forward(found).rotation, pose.rotation, atol=1e-12)
        if wrist.margin(positions) > 0.1:
            np.testing.assert_allclose(found, positions, atol=1e-11)


def test_two_joints_refuse_an_orientation_that_they_cannot_hold():
    wrist = shipped('pan_tilt')
    pose = wrist.forward((0.3, 0.4))
    aside = wrist.target_pose(pose, (0.1, 0.2, 0.3), 1.0)
    assert wrist.inverse(aside, (0.3, 0.4))
    turned = make_wrist('three_gimbal').target_pose(pose, (0.0, 0.0, 0.1), 1.0)
    with pytest.raises(errors.UnreachableError, match='can only point') as refused:
        wrist.inverse(turned, (0.3, 0.4))
    assert refused.value.limit == 'turn that is not free'


def least_margin(wrist, twist, seconds=20.0):
    """Return the least margin on the way along a twist from home, with joints that are fast."""
    flight = fly(wrist, Maneuver('held', (Segment(twist, seconds),)), joint_rate_limits=math.inf)
    return flight.margin.min()


@pytest.mark.parametrize(
    ('axes', 'least'),
    [((Z, Y, X, Z), 0.7), ((Z, Y, X, (0.5, 0.5, 0.7)), 0.4), (((1.0, 0.0, 1.0), Z, Y, X), 0.25)],
)
def test_the_freedom_of_four_joints_keeps_them_away_from_lock(axes, least):
    """Along the ways on which three come near to lock, whichever of the four is spare."""
    free, still = wrist_of(axes), dataclasses.replace(wrist_of(axes), gain=0.001)
    random = np.random.default_rng(4)
    twists = random.normal(size=(40, 3))
    twists *= 0.3 / np.linalg.norm(twists, axis=1)[:, None]
    near = [twist for twist in twists if least_margin(still, tuple(twist)) < 0.2]
    assert len(near) >= 5
    assert min(least_margin(free, tuple(twist)) for twist in near) > least


def until_it_stops(wrist, twist, seconds=60.0):
    """Hold a twist from home; return the last step, and every sentence on the way."""
    wrist = wrist.with_limits(rates=1.0)
    state, told = start(wrist), []
    for _ in range(round(100 * seconds)):
        taken = step(wrist, state, twist, 0.01)
        told.append(sentence(wrist, taken, twist))
        state = taken.state
        if not any(taken.joint_rates):
            break
    return taken, told


def test_the_region_that_the_curved_wrist_cannot_reach_is_named():
    """Its axes are 60° apart: nothing reaches more than 120° from the first."""
    wrist = shipped('jaco')
    taken, told = until_it_stops(wrist, (0.3, 0.0, 0.0))
    (limit,) = {one.joint for one in taken.limits if one.kind == LimitKind.WORKSPACE}
    assert limit == 'unreachable region against the first axis'
    assert told[-1] == f'The wrist is at its limit: {limit}; move the other way.'


def test_its_lock_on_the_other_side_is_passed_and_named():
    wrist = shipped('jaco').with_limits(rates=1.0)
    lock = wrist.home[1] + 0.5 * math.pi
    positions = (0.0, lock - 0.05, 0.0)
    toward = wrist.jacobian(positions)[:, 1]
    twist = tuple((0.2 * toward).tolist())
    state, told = State(positions, wrist.forward(positions)), set()
    for _ in range(60):
        taken = step(wrist, state, twist, 0.01)
        told.add(sentence(wrist, taken, twist).partition(':')[0])
        state = taken.state
    assert 'In lock' in told
    assert state.positions[1] == pytest.approx(lock + 0.07, abs=1e-6)


@pytest.mark.parametrize('name', SHIPPED)
def test_joints_and_limits_are_those_of_the_file(name):
    wrist = shipped(name)
    text = (FOLDER / f'{name}.urdf').read_text()
    for joint in wrist.joints:
        assert f'<joint name="{joint.name}"' in text
        assert f'velocity="{joint.rate_limit:g}' in text or f'"{joint.rate_limit}"' in text


def test_it_lives_on_when_its_file_is_gone(tmp_path):
    file = tmp_path / 'robot.urdf'
    file.write_text(robot((Z, Y, X)))
    wrist = make_wrist('urdf', description=str(file), tip='tip')
    file.unlink()
    narrow = wrist.with_limits(rates=0.5)
    assert narrow.joints[0].rate_limit == 0.5
    assert narrow.forward((0.1, 0.2, 0.3)) == wrist.forward((0.1, 0.2, 0.3))


def test_a_path_names_a_file_and_a_printed_wrist_is_short():
    wrist = make_wrist('urdf', description=FOLDER / 'panda.urdf', tip='panda_link8')
    assert wrist == shipped('panda')
    assert 'panda_joint7' in repr(wrist)
    assert '<robot' not in repr(wrist)


def test_it_is_among_the_wrists_and_flies_by_its_name():
    assert 'urdf' in wrist_names()
    description = (FOLDER / 'panda.urdf').read_text()
    flight = fly('urdf', 'basic_test', description=description, tip='panda_link8')
    assert flight.joint_positions.shape[1] == 3


@pytest.mark.parametrize(
    ('given', 'sentence'),
    [
        ({}, 'There is no robot description; give the XML of a URDF, or the name of a file'),
        ({'description': robot((Z, Y, X))}, "There is no link '' for the tip; valid is one of"),
        ({'description': robot((Z, Y, X)), 'tip': 'tip', 'joints': 'j0'}, "joints is 'j0'; valid"),
        ({'description': robot((Z, Y, X)), 'tip': 'tip', 'joints': [0, 1]}, r'joints is \[0, 1\]'),
        ({'description': robot((Z, Y, X)), 'tip': 'tip', 'gain': 0.0}, 'gain is 0.0; valid is'),
        ({'file': 'x'}, 'urdf has no parameter file; it has .*description, tip, gain'),
    ],
)
def test_what_makes_no_wrist_is_one_sentence(given, sentence):
    with pytest.raises(InvalidValueError, match=sentence):
        make_wrist('urdf', **given)
