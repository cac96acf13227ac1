"""Joint limits: one value for all joints or one for each, and what is refused."""

import math

import pytest

from wrist_control import InvalidValueError
from wrist_control.wrists.joint import Joint, broadcast_to_joints, with_limits

JOINTS = (Joint('psi'), Joint('leg', 'prismatic', 0.2, 0.4, 0.1))


def test_a_joint_is_free_unless_it_is_told_otherwise():
    assert Joint('psi') == ('psi', 'revolute', -math.inf, *[math.inf] * 4)


def test_one_value_is_for_all_joints_and_more_are_one_for_each():
    assert broadcast_to_joints('gains', [2.0], ['a', 'b']) == [2.0, 2.0]
    assert broadcast_to_joints('gains', [2.0, 3.0], ['a', 'b']) == [2.0, 3.0]
    for wrong in ([], [1.0, 2.0, 3.0]):
        with pytest.raises(InvalidValueError, match=rf'gains has {len(wrong)} values; .* a, b\.'):
            broadcast_to_joints('gains', wrong, ['a', 'b'])


def test_limits_that_are_not_given_stay_and_nothing_else_changes():
    assert with_limits(JOINTS) == JOINTS
    psi, leg = with_limits(JOINTS, 0.5, None, (1.0, 0.3), 2.0, (3.0, 4.0))
    assert psi == ('psi', 'revolute', -math.inf, 1.0, 0.5, 2.0, 3.0)
    assert leg == ('leg', 'prismatic', 0.2, 0.3, 0.5, 2.0, 4.0)
    assert with_limits((psi, leg)) == (psi, leg)


@pytest.mark.parametrize(
    ('rates', 'lower', 'upper', 'sentence'),
    [
        (0.0, None, None, r'joint_rate_limits has 0 for psi; it must be above 0'),
        ((1.0, -1.0), None, None, r'joint_rate_limits has -1 for leg'),
        (math.nan, None, None, r'joint_rate_limits is \[nan, nan\]; every value must be a number'),
        (None, (0.0, math.nan), None, r'joint_lower_limits is \[0.0, nan\]'),
        (None, None, (1.0, 0.2), r'limits of leg cross: lower 0\.2, upper 0\.2; lower must be be'),
        (None, None, (1.0,) * 3, r'joint_upper_limits has 3 values; give 1 for all joints or one'),
    ],
)
def test_limits_that_cannot_be_kept_are_refused_in_a_sentence(rates, lower, upper, sentence):
    with pytest.raises(InvalidValueError, match=sentence):
        with_limits(JOINTS, rates, lower, upper)


@pytest.mark.parametrize('what', ['acceleration', 'deceleration'])
@pytest.mark.parametrize('value', [0.0, -1.0, math.nan, (1.0,) * 3])
def test_rates_that_could_never_change_are_refused_in_a_sentence(what, value):
    with pytest.raises(InvalidValueError, match=f'joint_{what}_limits (has|is)'):
        with_limits(JOINTS, **{f'{what}s': value})
