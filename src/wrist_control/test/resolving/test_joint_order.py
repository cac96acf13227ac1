"""Named values in joint order: one rule for commands, readings and rates."""

import math

import pytest

from wrist_control.errors import RefusedError
from wrist_control.resolving.joint_order import finite_in_joint_order, in_joint_order

JOINTS = ['psi', 'theta', 'phi']


def test_values_are_put_in_order_among_other_joints():
    names = ['elbow', 'phi', 'psi', 'elbow', 'theta']
    assert in_joint_order(JOINTS, names, [9.0, 3.0, 1.0, 9.0, 2.0]) == (1.0, 2.0, 3.0)


def test_values_need_not_be_finite():
    assert in_joint_order(['psi'], ['psi'], [math.inf]) == (math.inf,)


@pytest.mark.parametrize(
    ('names', 'values', 'reason', 'sentence'),
    [
        (JOINTS, (1.0, 1.0), 'wrong length', '3 joint names and 2 values; send one value for ea'),
        (
            JOINTS[:2],
            (1.0, 1.0),
            'wrong joint names',
            'phi is named 0 times; name each of psi, theta',
        ),
        ((), (), 'wrong joint names', 'psi is named 0 times'),
        ((*JOINTS, 'psi'), (1.0,) * 4, 'wrong joint names', 'psi is named 2 times'),
    ],
)
def test_missing_and_repeated_joints_are_refused(names, values, reason, sentence):
    with pytest.raises(RefusedError, match=sentence) as refused:
        in_joint_order(JOINTS, names, values)
    assert refused.value.reason == reason


@pytest.mark.parametrize(('names', 'values'), [(1001, 1001), (1001, 0), (0, 1001)])
def test_more_than_a_thousand_joints_are_not_looked_at(names, values):
    with pytest.raises(RefusedError, match='at most 1000') as refused:
        in_joint_order(['a'], ['a'] * names, [0.0] * values)
    assert refused.value.reason == 'too many joints'


def test_a_thousand_are():
    names = [f'joint_{number}' for number in range(1000)]
    assert in_joint_order(['joint_999'], names, range(1000)) == (999.0,)


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_what_a_joint_is_told_must_be_finite(value):
    with pytest.raises(RefusedError, match='not finite') as refused:
        finite_in_joint_order(['psi'], ['theta', 'psi'], [0.0, value])
    assert refused.value.reason == 'not finite'
    assert finite_in_joint_order(['psi'], ['theta', 'psi'], [value, 0.5]) == (0.5,)


def test_nothing_is_told_to_no_joint():
    with pytest.raises(RefusedError, match='not finite'):
        finite_in_joint_order([], [], [])
