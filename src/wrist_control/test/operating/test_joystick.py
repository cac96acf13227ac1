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


@pytest.mark.parametrize(
    ('axes', 'buttons', 'sentence'),
    [
        ([0.0] * 3, PRESSED, r'has 3 axes; joy_axes asks for \[0, 1, 3\], from 0'),
        ([0.0] * 4, (1, 1), 'has 2 buttons; enable_button asks for 2 and turbo_button for -1'),
    ],
)
def test_a_joystick_that_lacks_an_axis_or_button_is_refused_by_name(axes, buttons, sentence):
    with pytest.raises(RefusedError, match=sentence):
        JOYSTICK.rates(axes, buttons)


def test_a_silent_joystick_counts_as_released():
    held = JoystickWithTimeout(JOYSTICK, 0.5)
    assert held.rates(0.0) == (0.0, 0.0, 0.0)
    held.take([0.0] * 4, PRESSED, 9.9)
    held.take([0.0, 1.0, 0.0, 0.0], PRESSED, 10.0)
    assert held.rates(10.4)[1] == 0.5
    assert held.rates(10.6) == (0.0, 0.0, 0.0)


def test_what_is_no_number_counts_as_released():
    held = JoystickWithTimeout(JOYSTICK, 0.5)
    held.take([0.0] * 4, PRESSED, 9.9)
    held.take([0.0, 1.0, 0.0, 0.0], PRESSED, 10.0)
    assert any(held.rates(10.0))
    with pytest.raises(RefusedError, match='nan'):
        held.take([0.0, math.nan, 0.0, 0.0], PRESSED, 10.1)
    assert held.rates(10.1) == (0.0, 0.0, 0.0)


def test_the_turbo_button_changes_the_speed_while_it_is_held():
    turbo = JOYSTICK._replace(turbo_button=0, turbo_factor=3.0)
    axes = [1.0, -1.0, 0.0, 0.5]
    p, q, r = turbo.rates(axes, PRESSED)
    assert turbo.rates(axes, (1, 0, 1)) == pytest.approx((3.0 * p, 3.0 * q, 3.0 * r))
    assert turbo.rates(axes, (1, 0, 0)) == (0.0, 0.0, 0.0)
    with pytest.raises(RefusedError, match='turbo_button for 7'):
        turbo._replace(turbo_button=7).rates(axes, PRESSED)


@given(st.floats(0.0, 1.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_the_curve_is_odd_never_falls_and_ends_where_a_straight_line_does(expo, one, other):
    curved = JOYSTICK._replace(expo=expo)

    def q(value):
        return curved.rates([0.0, value, 0.0, 0.0], PRESSED)[1]

    assert q(1.0) == pytest.approx(0.5)
    assert q(-one) == -q(one)
    assert abs(q(one)) <= abs(JOYSTICK.rates([0.0, one, 0.0, 0.0], PRESSED)[1])
    assert (q(one) - q(other)) * (one - other) >= -1e-12


def test_the_curve_is_finer_in_the_middle():
    half = JOYSTICK._replace(deadzone=0.0, expo=1.0).rates([0.0, 0.5, 0.0, 0.0], PRESSED)[1]
    assert half == pytest.approx(0.5 * 0.5**3)


def held(*messages):
    """Return whether the hand moves after each message of (q, pressed, time)."""
    joystick = JoystickWithTimeout(JOYSTICK, 0.5)
    moves = []
    for q, pressed, time in messages:
        joystick.take([0.0, q, 0.0, 0.0], (0, 0, pressed), time)
        moves.append(any(joystick.rates(time)))
        assert joystick.must_let_go == (q != 0.0 and bool(pressed) and not moves[-1])
    return moves


def test_a_stick_that_was_never_seen_at_rest_moves_nothing():
    assert held((1.0, 1, 0.0), (1.0, 1, 0.1), (0.0, 1, 0.2), (1.0, 1, 0.3)) == [
        False,
        False,
        False,
        True,
    ]


def test_a_stick_and_its_button_may_come_at_once():
    assert held((0.0, 0, 0.0), (1.0, 1, 0.1)) == [False, True]


def test_who_lets_go_of_the_button_lets_go_of_the_stick_before_it_counts_again():
    moves = held((0.0, 1, 0.0), (1.0, 1, 0.1), (1.0, 0, 0.2), (1.0, 1, 0.3), (0.0, 1, 0.4))
    assert moves == [False, True, False, False, False]


def test_after_silence_a_stick_must_be_let_go_before_it_counts_again():
    assert held((0.0, 1, 0.0), (1.0, 1, 0.1), (1.0, 1, 0.7)) == [False, True, False]


def test_a_trigger_that_rests_at_its_end_moves_nothing_at_the_next_press():
    """It reads 0 before it is first touched, and 1 when it is let go again."""
    moves = held((0.0, 0, 0.0), (1.0, 0, 0.1), (1.0, 1, 0.2), (1.0, 1, 0.3))
    assert moves == [False, False, False, False]
