"""How far the hand is off the commanded path, against rotations that are worked out otherwise."""

import math

import numpy as np
import pytest

pytest.importorskip('nicegui', reason='the console needs the extra `console`')

from wrist_control import make_wrist
from wrist_control.web.samples import OffPath, Sample
from wrist_control.web.strips import row, strips

DT = 0.01


def off_path(steps, wrist='three_gimbal'):
    path = OffPath(make_wrist(wrist))
    for commanded, achieved, factor in steps:
        path.follow(commanded, achieved, factor, DT)
    return path.angle


def test_a_hand_that_is_late_but_not_astray_is_on_the_path():
    commanded = (0.3, -0.8, 0.5)
    steps = [
        (commanded, tuple(factor * rate for rate in commanded), factor)
        for factor in np.linspace(0.0, 1.0, 50).tolist()
    ]
    assert off_path(steps) < 1e-7


def test_a_hand_that_goes_astray_is_off_by_the_angle():
    steps = [((0.0, 1.0, 0.0), (0.0, 1.0, 0.2), 1.0)] * 50
    scipy = pytest.importorskip('scipy.spatial.transform').Rotation
    meant, made = (scipy.from_rotvec([0.0, 0.5, z]) for z in (0.0, 0.1))
    assert off_path(steps) == pytest.approx((meant.inv() * made).magnitude(), rel=1e-9)


def test_the_roll_that_a_pointer_is_forced_to_is_not_off_the_path():
    steps = [((0.0, 1.0, 0.7), (0.0, 1.0, 0.2), 1.0)] * 50
    assert off_path(steps, 'five_bar') < 1e-7
    assert off_path(steps) > 0.1


def test_a_hand_that_comes_to_rest_is_on_the_path():
    assert off_path([((0.0, 0.0, 0.0), (0.0, rate, 0.0), 1.0) for rate in (0.3, 0.2, 0.1)]) == 0.0


def test_it_begins_anew():
    path = OffPath(make_wrist('three_gimbal'))
    path.follow((0.0, 1e-9, 0.0), (1.0, 0.0, 0.0), 1.0, DT)
    assert path.angle == pytest.approx(DT)
    path.clear()
    assert path.angle == 0.0


@pytest.mark.parametrize('name', ['three_gimbal', 'stewart', 'five_bar'])
def test_a_row_has_a_value_for_every_line_of_every_strip_in_their_units(name):
    wrist = make_wrist(name).with_limits(rates=0.25)
    n = len(wrist.joints)
    sample = Sample(7.0, (0.1, 0.2, 0.3), (0.4, 0.5, 0.6), 0.7, 0.8, (0.25,) * n)
    shown = strips(wrist)
    time, *values = row(wrist, sample)
    assert time == 7.0
    lines = [line for strip in shown for line in strip['lines']]
    assert len(values) == len(lines)
    assert values[:6] == pytest.approx(
        np.degrees([0.1, 0.4, 0.2, 0.5, 0.3, 0.6]).tolist(), abs=1e-4
    )
    assert values[6:8] == [0.7, 0.8]
    for value, line, strip in zip(values[8:], lines[8:], shown[5:], strict=True):
        assert line['limits'] == pytest.approx([-value, value], abs=1e-4)
        assert strip['high'] > value
        assert strip['title'].endswith('mm/s' if name == 'stewart' else 'deg/s')
        assert value == pytest.approx(250.0 if name == 'stewart' else math.degrees(0.25), abs=1e-4)


def test_a_joint_without_a_limit_has_a_strip_without_one():
    shown = strips(make_wrist('three_gimbal'))
    assert shown[-1]['lines'][0]['limits'] is None
    assert math.isfinite(shown[-1]['high'])
