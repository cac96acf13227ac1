"""What the operator is told: every state, and its sentence."""

import pytest

from wrist_control import make_wrist
from wrist_control.resolving import LimitAtWork, LimitKind, start, step
from wrist_control.resolving.report import WristState, sentence, state_of
from wrist_control.resolving.state import resting

WRIST = make_wrist('three_gimbal')
ZERO_TWIST = (0.0, 0.0, 0.0)
YAW = (0.0, 0.0, 1.0)


def made(wrist=WRIST, **changes):
    """Return a step that followed all of a yaw command, with changes."""
    whole = resting(wrist, start(wrist))._replace(achieved=(0.0, 0.0, 0.0, *YAW))
    return whole._replace(**changes)


def limit(kind, joint='psi', asked=2.0, allowed=0.5, share=0.25):
    return LimitAtWork(joint, kind, asked, allowed, share)


def told(one, commanded=YAW, wrist=WRIST):
    return state_of(one, commanded), sentence(wrist, one, commanded)


def test_idle_when_nothing_is_commanded():
    assert told(made(), ZERO_TWIST) == (WristState.IDLE, 'Ready: no motion is commanded.')


def test_tracking_when_all_of_the_command_is_followed():
    assert told(made()) == (WristState.TRACKING, 'Following the command.')


def test_tracking_says_when_the_mechanism_leaves_a_part_out():
    state, message = told(made(), (0.3, 0.0, 1.0))
    assert state == WristState.TRACKING
    assert message.startswith('Following the part of the command that this mechanism can do')


def test_tracking_looks_at_the_part_of_the_twist_that_was_commanded():
    wrist = make_wrist('stewart')
    one = made(wrist, achieved=(0.1, 0.0, 0.0, 0.0, 0.0, 0.2))
    assert sentence(wrist, one, (0.1, 0.0, 0.0, 0.0, 0.0, 0.2)) == 'Following the command.'
    assert 'missing' in sentence(wrist, one, (0.2, 0.0, 0.0, 0.0, 0.0, 0.2))


def test_scaled_names_the_joint_that_holds_back_most_and_in_its_unit():
    limits = (
        limit(LimitKind.RATE, 'phi', 0.8, 0.5, 0.6),
        limit(LimitKind.RATE, 'psi', -2.0, -0.5),
    )
    assert told(made(scale_factor=0.25, limits=limits)) == (
        WristState.SCALED,
        'Slowed to about 25%: psi would need 2 rad/s and may do 0.5; ask for less, or turn '
        'another way.',
    )


def test_scaled_legs_are_told_in_metres():
    wrist = make_wrist('stewart')
    slowed = made(
        wrist, scale_factor=0.5, limits=(limit(LimitKind.RATE, 'leg_3', 0.1, 0.05, 0.5),)
    )
    assert 'leg_3 would need 0.1 m/s and may do 0.05' in sentence(
        wrist, slowed, (0.0,) * 5 + (1.0,)
    )


def test_singular_names_the_lost_axis_and_the_way_out():
    locked = made(singular=True, scale_factor=0.0111, limits=(limit(LimitKind.RATE),))
    locked = locked._replace(state=locked.state._replace(positions=(0.0, 1.5707963267948966, 0.0)))
    state, message = told(locked)
    assert state == WristState.SINGULAR
    assert 'axis (0.0, 0.0, 1.0);' in message
    assert 'at less than 5% of the command: keep on, or reverse to back out.' in message


def in_pointer_lock(**changes):
    pointer = make_wrist('pitch_yaw')
    lock = limit(LimitKind.SINGULARITY, 'lock', 0.0, 1e-3, 0.0)
    one = made(pointer, singular=True, limits=(lock,))._replace(**changes)
    return one._replace(state=one.state._replace(positions=(1.5707963267948966, 0.0))), pointer


@pytest.mark.parametrize(
    ('factor', 'command', 'rest'),
    [
        (0.0, (0.0, 1.0, 0.0), ', and no motion of the joints helps; turn it about another axis.'),
        (
            0.5,
            (1.0, 1.0, 0.0),
            ' and leaves that part of the command out; the rest is followed at about 50%.',
        ),
    ],
)
def test_a_pointer_in_lock_says_which_axis_is_lost_and_what_is_left(factor, command, rest):
    one, pointer = in_pointer_lock(scale_factor=factor)
    state, message = told(one, command, pointer)
    assert state == WristState.SINGULAR
    assert message == f'In lock: the hand cannot turn about its axis (0.0, 1.0, 0.0){rest}'


def test_a_pointer_in_lock_and_at_a_limit_names_the_limit():
    one, pointer = in_pointer_lock(scale_factor=0.0)
    end = limit(LimitKind.POSITION, 'theta_1', 2.0, 1.6)
    one = one._replace(limits=(end, *one.limits))
    assert told(one, (1.0, 1.0, 0.0), pointer) == (
        WristState.LIMITED,
        'theta_1 is at its limit of 1.600 rad; move the other way.',
    )


@pytest.mark.parametrize(
    ('name', 'axes'),
    [('pitch_yaw', 'x and y'), ('carpal', 'x and y'), ('three_gimbal', 'x, y and z')],
)
def test_what_no_joint_can_make_is_no_motion_and_no_time_lost(name, axes):
    wrist = make_wrist(name)
    command = (0.1, 0.2, 0.3, 0.0, 0.0, 0.0 if name == 'three_gimbal' else 1.0)
    one = step(wrist, start(wrist), command, 0.01)
    assert one.state == start(wrist)
    assert (one.scale_factor, any(one.joint_rates), any(one.achieved)) == (0.0, False, False)
    state, message = told(one, command, wrist)
    assert state == WristState.LIMITED
    assert message.startswith('Nothing of this command can be done')
    assert f'its own {axes} axes, and no more' in message


def test_a_part_that_no_joint_can_make_is_missing():
    assert 'missing' in sentence(WRIST, made(), (0.2, 0.0, 0.0, *YAW))
    assert sentence(WRIST, made(), (0.0, 0.0, 0.0, *YAW)) == 'Following the command.'


def test_limited_names_the_joint_and_where_it_stands():
    one = made(scale_factor=0.0, limits=(limit(LimitKind.POSITION, 'theta', 1.2, 1.0),))
    assert told(one) == (
        WristState.LIMITED,
        'theta is at its limit of 1.000 rad; move the other way.',
    )


def test_limited_legs_are_told_in_metres():
    wrist = make_wrist('stewart')
    one = made(wrist, limits=(limit(LimitKind.POSITION, 'leg_1', 0.6, 0.5),))
    assert sentence(wrist, one, YAW) == 'leg_1 is at its limit of 0.500 m; move the other way.'


def test_limited_by_the_whole_wrist_says_by_what():
    one = made(scale_factor=0.0, limits=(limit(LimitKind.WORKSPACE, 'the rail ends'),))
    assert told(one) == (
        WristState.LIMITED,
        'The wrist is at its limit: the rail ends; move the other way.',
    )


def test_a_place_to_stop_matters_more_than_a_speed():
    limits = (limit(LimitKind.RATE), limit(LimitKind.POSITION, 'phi', 3.0, 2.0))
    state, message = told(made(scale_factor=0.0, limits=limits))
    assert state == WristState.LIMITED
    assert message.startswith('phi is at its limit of 2.000 rad')


def test_a_place_to_stop_matters_more_than_lock():
    """In lock the joints turn into place, and keeping on would not help one at its limit."""
    one = made(singular=True, limits=(limit(LimitKind.RATE), limit(LimitKind.POSITION)))
    assert told(one)[0] == WristState.LIMITED
    assert told(one)[1].startswith('psi is at its limit')


def test_idle_matters_more_than_lock():
    assert state_of(made(singular=True), ZERO_TWIST) == WristState.IDLE


def test_a_joint_held_at_its_end_while_it_would_be_too_fast_as_well_is_told_to_turn_back():
    wrist = WRIST.with_limits(rates=0.2, upper=(0.3, 1.5, 3.0))
    state = start(wrist)
    for _ in range(200):
        last = step(wrist, state, YAW, 0.02)
        state = last.state
    assert told(last, wrist=wrist) == (
        WristState.LIMITED,
        'psi is at its limit of 0.300 rad; move the other way.',
    )


@pytest.mark.parametrize('name', ['three_gimbal', 'stewart'])
def test_every_message_is_one_sentence(name):
    wrist = make_wrist(name)
    joint = wrist.joints[0].name
    steps = [
        made(wrist),
        made(wrist, singular=True),
        *(made(wrist, scale_factor=0.5, limits=(limit(kind, joint),)) for kind in LimitKind),
    ]
    for one in steps:
        for commanded in (ZERO_TWIST, (*(0.0,) * (wrist.twist_size - 3), *YAW)):
            message = sentence(wrist, one, commanded)
            assert message.endswith('.')
            assert message[0].isupper() or message.startswith(joint)


def test_numbers_are_so_coarse_that_a_sentence_stays():
    limits = (limit(LimitKind.RATE, 'psi', 234.0, 0.5585),)
    said = {told(made(scale_factor=f, limits=limits))[1] for f in (0.23, 0.24, 0.25, 0.27)}
    assert said == {
        'Slowed to about 25%: psi would need 200 rad/s and may do 0.56; ask for less, or turn '
        'another way.'
    }
    assert 'Slowed to less than 5%: ' in told(made(scale_factor=0.049, limits=limits))[1]
    assert 'Slowed to about 5%: ' in told(made(scale_factor=0.05, limits=limits))[1]


@pytest.mark.parametrize('axis', [(-0.0, 0.04, -1.0), (0.0, -0.04, 1.0)])
def test_the_lost_axis_is_told_with_one_of_its_signs_and_without_minus_nothing(monkeypatch, axis):
    monkeypatch.setattr(type(WRIST), 'lost_axis', lambda self, positions: axis)
    message = told(made(singular=True, scale_factor=0.5, limits=(limit(LimitKind.RATE),)))[1]
    assert 'axis (0.0, 0.0, 1.0)' in message
