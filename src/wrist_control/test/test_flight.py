"""Flights: the same resolver step, as fast as it goes, as arrays over time."""

import dataclasses
import math

import numpy as np
import pytest

from wrist_control import WRISTS, InvalidValueError, fly, make_maneuver, make_wrist
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, Segment, stick, turn
from wrist_control.resolving import start, step
from wrist_control.wrists.body import ALONG_X

H = 1.0 / 32.0
SHORT = Maneuver('short', (turn(1, 0.3, BARKER_SPEED), turn(2, 0.2, BARKER_SPEED)))


def arrays(flight):
    return {
        own.name: getattr(flight, own.name)
        for own in dataclasses.fields(flight)
        if isinstance(getattr(flight, own.name), np.ndarray)
    }


@pytest.mark.parametrize('name', WRISTS)
def test_every_array_has_one_row_for_each_time(name):
    flight = fly(name, SHORT)
    n, joints = len(flight.time), len(flight.wrist.joints)
    assert {key: array.shape for key, array in arrays(flight).items()} == {
        'time': (n,),
        'command': (n, 3),
        'achieved': (n, 6),
        'joint_positions': (n, joints),
        'joint_rates': (n, joints),
        'hand_rotation': (n, 3, 3),
        'hand_position': (n, 3),
        'tip': (n, 3),
        'scale_factor': (n,),
        'time_lost': (n,),
        'margin': (n,),
    }
    assert len(flight.limited) == n
    assert flight.completed
    assert all(np.isfinite(array).all() for array in arrays(flight).values())


@pytest.mark.parametrize('name', ['three_gimbal', 'four_gimbal', 'carpal'])
def test_the_same_flight_again_is_the_same_to_the_last_bit(name):
    limits = 0.4
    first, second = fly(name, SHORT, joint_rate_limits=limits), fly(name, SHORT, 32.0, limits)
    for key, array in arrays(first).items():
        assert np.array_equal(array, arrays(second)[key]), key
    assert first.limited == second.limited


def test_a_flight_is_the_resolver_step_repeated():
    flight = fly('three_gimbal', SHORT, joint_rate_limits=0.4)
    state = start(flight.wrist)
    for row, command in enumerate(flight.command):
        assert tuple(flight.joint_positions[row]) == state.positions
        assert flight.time_lost[row] == state.time_lost
        np.testing.assert_array_equal(flight.hand_rotation[row], state.pose.rotation)
        made = step(flight.wrist, state, tuple(command), H)
        assert flight.scale_factor[row] == made.scale_factor
        assert flight.margin[row] == made.margin
        assert tuple(flight.achieved[row]) == made.achieved
        assert flight.limited[row] == tuple(limit.joint for limit in made.limits)
        state = made.state


@pytest.mark.parametrize('limit', [None, 0.4])
def test_joint_rates_are_the_real_increments(limit):
    flight = fly('three_gimbal', SHORT, joint_rate_limits=limit)
    increments = np.diff(flight.joint_positions, axis=0) / H
    np.testing.assert_allclose(flight.joint_rates[:-1], increments, atol=1e-12)
    assert not flight.joint_rates[-1].any()
    np.testing.assert_allclose(np.diff(flight.time), H)


def test_time_lost_is_the_integral_of_one_minus_f_up_to_each_row():
    flight = fly('three_gimbal', SHORT, joint_rate_limits=0.4)
    lost = H * np.cumsum(1.0 - flight.scale_factor)
    assert flight.time_lost[0] == 0.0
    np.testing.assert_allclose(flight.time_lost[1:], lost[:-1], atol=1e-12)
    assert flight.time_lost[-1] > 0.1


def test_the_tip_is_the_end_of_the_probe_in_forearm_axes():
    probe = (0.1, -0.2, 0.3)
    flight = fly('carpal', SHORT, probe=probe)
    turned = np.einsum('nji,j->ni', flight.hand_rotation, probe)  # Cᵀ takes it to the forearm
    np.testing.assert_allclose(flight.tip, flight.hand_position + turned, atol=1e-14)
    assert np.abs(flight.hand_position).max() > 0.01
    assert pytest.approx((0.1524, 0.0, 0.0)) == ALONG_X


def test_the_operator_waits_for_a_hand_that_is_slow():
    flight = fly('three_gimbal', SHORT, joint_rate_limits=0.5 * BARKER_SPEED)
    free = fly('three_gimbal', SHORT)
    np.testing.assert_allclose(flight.hand_rotation[-1], free.hand_rotation[-1], atol=1e-8)
    assert flight.time[-1] == pytest.approx(SHORT.duration + flight.time_lost[-1], abs=2 * H)


@pytest.mark.parametrize('limit', [0.1, 0.3, 0.45, 0.55])
@pytest.mark.parametrize('rate', [7.0, 32.0, 100.0])
def test_a_slow_hand_turns_exactly_as_far_as_it_was_asked_to(limit, rate):
    pitch = Maneuver('pitch', (turn(1, 0.3, BARKER_SPEED),))
    flight = fly('three_gimbal', pitch, rate, limit)
    np.testing.assert_allclose(flight.joint_positions[-1], (0.0, 0.3, 0.0), atol=1e-8)


def test_an_operator_who_does_not_wait_ends_in_time_however_slow_the_hand():
    maneuver = stick(1.0, duration=3.0)
    flight = fly('three_gimbal', maneuver, joint_rate_limits=0.1)
    assert flight.time[-1] == pytest.approx(3.0)
    assert flight.completed


def test_any_number_of_steps_per_second_ends_where_the_maneuver_ends():
    ends = [fly('three_gimbal', 'basic_test', rate).tip[-1] for rate in (7.0, 32.0, 100.0)]
    np.testing.assert_allclose(ends, [(0.0, ALONG_X[0], 0.0)] * 3, atol=1e-12)


def test_a_flight_that_loses_too_much_time_is_given_up_and_says_so():
    wrist = make_wrist('three_gimbal').with_limits(lower=-0.1, upper=0.1)
    flight = fly(wrist, SHORT, patience=1.0)
    assert not flight.completed
    assert 1.0 <= flight.time_lost[-1] <= 1.0 + H  # the last row is where it ended
    assert not flight.command[-1].any()
    assert not flight.joint_rates[-1].any()
    assert flight.limited[-2] == ('theta',)


def test_a_flight_starts_where_it_is_told():
    flight = fly('three_gimbal', SHORT, initial_positions=(0.1, 0.2, 0.3))
    assert tuple(flight.joint_positions[0]) == (0.1, 0.2, 0.3)


def test_progress_is_told_after_each_step_and_never_falls():
    shares = []
    flight = fly('three_gimbal', SHORT, progress=shares.append)
    assert len(shares) == len(flight.time) - 1
    assert shares == sorted(shares)
    assert 0.9 < shares[-1] <= 1.0


def test_names_and_objects_fly_alike():
    by_name = fly('carpal', 'hold', joint_rate_limits=1.0)
    by_object = fly(make_wrist('carpal').with_limits(rates=1.0), make_maneuver('hold'))
    assert by_name.wrist == by_object.wrist
    assert by_name.maneuver == by_object.maneuver


def test_dimensions_reach_the_wrist():
    flight = fly('four_gimbal', SHORT, gain=1.5)
    assert flight.wrist.gain == 1.5


def test_a_wrist_that_translates_is_asked_for_rates_only():
    flight = fly('stewart', SHORT)
    assert flight.command.shape == (len(flight.time), 3)
    np.testing.assert_allclose(flight.achieved[:, :3], 0.0, atol=1e-9)


@pytest.mark.parametrize(
    ('wrong', 'sentence'),
    [
        ({'wrist': 'elbow'}, r"no wrist 'elbow'; the wrists are three_gimbal, "),
        ({'maneuver': 'loop'}, r"no maneuver 'loop'"),
        ({'rate': 0.0}, r'rate is 0\.0; it must be finite and above 0 steps/s'),
        ({'rate': math.nan}, r'rate is nan'),
        ({'rate': math.inf}, r'rate is inf'),
        ({'joint_rate_limits': (1.0, 2.0)}, r'joint_rate_limits has 2 values; give 1 for all'),
        ({'joint_rate_limits': -1.0}, r'joint_rate_limits has -1 for psi; it must be above 0'),
        ({'joint_rate_limits': math.nan}, r'joint_rate_limits is \[nan'),
        ({'initial_positions': (0.0,)}, r'initial_positions has 1 values'),
        ({'initial_positions': (0.0, 0.5 * math.pi, 0.0)}, r'are at lock'),
        ({'gain': 1.0}, r'three_gimbal has no parameter gain; it has '),
        ({'wrist': make_wrist('four_gimbal'), 'gain': 1.0}, r'gain can only be given with the na'),
    ],
)
def test_values_that_cannot_be_used_are_refused_in_a_sentence(wrong, sentence):
    with pytest.raises(InvalidValueError, match=sentence):
        fly(
            **{
                'wrist': 'three_gimbal',
                'maneuver': Maneuver('no', (Segment((0, 0, 0), 0),)),
                **wrong,
            }
        )
