"""The gate for commands: which count, in whose axes, and for how long."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import WristError
from wrist_control.errors import RefusedError
from wrist_control.resolving.commands import (
    Command,
    CommandPolicy,
    ReceivedTwist,
    freshness,
    hand_twist,
)
from wrist_control.rotations import about_z, direction_cosines, unit

TWIST = (1.0, 2.0, 3.0, 0.1, 0.2, 0.3)
linear, angular = st.floats(-10.0, 10.0), st.floats(-100.0, 100.0)
twists = st.tuples(*(linear,) * 3, *(angular,) * 3)


def offered(
    twist=TWIST, frame='', stamp=10.0, now=10.0, receipt=50.0, hand='hand', forearm='forearm'
):
    policy = CommandPolicy(0.25, hand, forearm)
    received = ReceivedTwist(twist, frame, stamp)
    return policy.accept(received, stamp_time=now, receipt_time=receipt)


@given(twists, st.sampled_from(['', 'hand', 'forearm']), st.floats(0.0, 0.25))
def test_a_fresh_finite_command_in_a_known_frame_counts_as_it_came(twist, frame, age):
    command = offered(twist, frame, stamp=1.0, now=1.0 + age * (1.0 - 1e-9))
    assert command == Command(twist, frame == 'forearm', 1.0, 50.0)


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize('index', range(6))
def test_a_command_with_one_value_that_is_not_finite_is_refused(bad, index):
    twist = [*TWIST[:index], bad, *TWIST[index + 1 :]]
    with pytest.raises(RefusedError, match=r'not finite: .*; send numbers\.') as refused:
        offered(twist)
    assert refused.value.reason == 'not finite'
    assert isinstance(refused.value, WristError)


@pytest.mark.parametrize('sign', [1.0, -1.0])
@pytest.mark.parametrize('index', range(6))
def test_what_nobody_asks_for_in_earnest_is_refused(index, sign):
    most = sign * (10.0 if index < 3 else 100.0)
    assert offered([*TWIST[:index], most, *TWIST[index + 1 :]]).twist[index] == most
    with pytest.raises(RefusedError, match='send at most 10 m/s and 100 rad/s') as refused:
        offered([*TWIST[:index], 1.001 * most, *TWIST[index + 1 :]])
    assert refused.value.reason == 'beyond belief'


def test_a_command_in_an_unknown_frame_is_refused_and_told_which_are_known():
    with pytest.raises(
        RefusedError, match=r"'base'; use 'hand', 'forearm' or an empty"
    ) as refused:
        offered(frame='base')
    assert refused.value.reason == 'unknown frame'


def test_a_command_from_the_future_is_refused_beyond_what_clocks_may_differ():
    assert offered(stamp=10.049).stamp == 10.049
    with pytest.raises(RefusedError, match=r'stamped 0\.051 s in the future'):
        offered(stamp=10.051)
    with pytest.raises(RefusedError, match=r'stamped 0\.200 s in the future; synch') as refused:
        offered(stamp=10.2)
    assert refused.value.reason == 'stamp in the future'


def test_a_command_older_than_the_timeout_is_refused():
    assert offered(stamp=9.75).stamp == 9.75
    with pytest.raises(RefusedError, match=r'0\.300 s old; at most 0\.25 s \(comm') as refused:
        offered(stamp=9.7)
    assert refused.value.reason == 'too old'


def test_a_command_without_a_stamp_counts_at_any_time():
    assert offered(stamp=None, now=1e9).stamp is None


def test_where_hand_and_forearm_share_a_name_it_means_the_hand():
    assert not offered(frame='wrist', hand='wrist', forearm='wrist').in_forearm
    assert not offered(frame='', hand='hand', forearm='').in_forearm


@given(twists, st.tuples(*(st.floats(-1.0, 1.0),) * 4).filter(lambda a: math.hypot(*a) > 0.1))
def test_a_command_in_forearm_axes_is_turned_into_hand_axes(twist, a):
    a = unit(a)
    C = np.array(direction_cosines(a))
    found = hand_twist(Command(twist, True, None, 0.0), a)
    np.testing.assert_allclose(found, [*(C @ twist[:3]), *(C @ twist[3:])], atol=1e-9)
    assert hand_twist(Command(twist, False, None, 0.0), a) == twist


def test_the_forearms_x_is_minus_y_of_a_hand_that_has_yawed_left():
    command = Command((0.0, 0.0, 0.0, 1.0, 0.0, 0.0), True, None, 0.0)
    found = hand_twist(command, about_z(0.5 * math.pi))
    assert found == pytest.approx((0.0, 0.0, 0.0, 0.0, -1.0, 0.0), abs=1e-15)


@given(st.floats(0.0, 5.0), st.floats(0.0, 5.0))
def test_freshness_only_falls_and_stays_between_one_and_zero(age, more):
    young, old = freshness(age, 0.25, 0.1), freshness(age + more, 0.25, 0.1)
    assert 0.0 <= old <= young <= 1.0


def test_a_held_command_is_followed_in_full_then_ramped_to_a_stop():
    ages = (0.0, 0.25, 0.275, 0.3, 0.35, 0.351, 1e9)
    found = [freshness(age, 0.25, 0.1) for age in ages]
    assert found == pytest.approx([1.0, 1.0, 0.75, 0.5, 0.0, 0.0, 0.0], abs=1e-12)
