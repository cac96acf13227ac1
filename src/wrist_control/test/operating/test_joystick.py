"""The joystick: a dead-man button, a dead zone, and silence that counts as released."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control.errors import RefusedError
from wrist_control.operating.joystick import Joystick, JoystickWithTimeout

JOYSTICK = Joystick((0, 1, 3), (-1.0, 0.5, 2.0), 0.1, 2)
PRESSED = (0, 0, 1)


def test_full_deflection_gives_the_scales():
    assert JOYSTICK.rates([1.0, 1.0, 0.0, 1.0], PRESSED) == (-1.0, 0.5, 2.0)
    assert JOYSTICK.rates([-1.0, -1.0, 0.0, -1.0], PRESSED) == (1.0, -0.5, -2.0)


@given(st.floats(1.0, 1e300))
def test_more_than_full_deflection_is_full_deflection(value):
    assert JOYSTICK.rates([value, -value, 0.0, value], PRESSED) == (-1.0, -0.5, 2.0)


def test_nothing_moves_while_the_enable_button_is_not_held():
    assert JOYSTICK.rates([1.0, 1.0, 1.0, 1.0], (1, 1, 0)) == (0.0, 0.0, 0.0)


def test_without_an_enable_button_the_stick_alone_counts():
    assert JOYSTICK._replace(enable_button=-1).rates([0.0, 1.0, 0.0, 0.0], ())[1] == 0.5


@given(st.floats(-1.0, 1.0))
def test_the_dead_zone_is_quiet_and_the_rest_rises_without_a_jump(value):
    q = JOYSTICK.rates([0.0, value, 0.0, 0.0], PRESSED)[1]
    if abs(value) <= 0.1:
        assert q == 0.0
    else:
        assert q == pytest.approx(math.copysign(0.5 * (abs(value) - 0.1) / 0.9, value))


@pytest.mark.parametrize(('axes', 'buttons'), [([0.0] * 3, PRESSED), ([0.0] * 4, (1, 1))])
def test_a_joystick_that_lacks_an_axis_or_button_is_refused_by_name(axes, buttons):
    with pytest.raises(RefusedError, match=r'axes and .* buttons'):
        JOYSTICK.rates(axes, buttons)


def test_a_silent_joystick_counts_as_released():
    held = JoystickWithTimeout(JOYSTICK, 0.5)
    assert held.rates(0.0) == (0.0, 0.0, 0.0)
    held.take([0.0, 1.0, 0.0, 0.0], PRESSED, 10.0)
    assert held.rates(10.4)[1] == 0.5
    assert held.rates(10.6) == (0.0, 0.0, 0.0)


def test_what_is_no_number_counts_as_released():
    held = JoystickWithTimeout(JOYSTICK, 0.5)
    held.take([0.0, 1.0, 0.0, 0.0], PRESSED, 10.0)
    with pytest.raises(RefusedError, match='nan'):
        held.take([0.0, math.nan, 0.0, 0.0], PRESSED, 10.1)
    assert held.rates(10.1) == (0.0, 0.0, 0.0)
