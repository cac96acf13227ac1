"""The pilot's clock: it stands still while the hand loses time, and segments end exactly."""

import math

import numpy as np
import pytest

from wrist_control.operating.maneuvers import (
    MANEUVERS,
    Maneuver,
    Segment,
    make_maneuver,
    stick,
)
from wrist_control.operating.pilot import Pilot

DT = 0.1
FIRST, SECOND = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)
TWO = Maneuver('two', (Segment(FIRST, 0.25), Segment(SECOND, 0.25)))


def turned(pilot, factors):
    """Return what the hand has turned about each axis, following a share of each command."""
    total, lost = np.zeros(3), 0.0
    for tick, factor in enumerate(factors):
        rates = np.array(pilot.rates(5.0 + tick * DT, 3.0 + lost))
        total += factor * DT * rates
        lost += (1.0 - factor) * DT
    return total


def test_a_hand_that_follows_in_full_turns_by_each_segment_exactly():
    pilot = Pilot(TWO, DT)
    np.testing.assert_allclose(turned(pilot, [1.0] * 8), (0.25, 0.25, 0.0), atol=1e-12)
    assert pilot.done


@pytest.mark.parametrize('fastest', [0.3, 0.5, 0.8, 0.95])
def test_a_hand_that_is_held_to_a_speed_turns_by_the_segment_exactly(fastest):
    """However its speed fits the periods: the end is asked for at what the hand can do."""
    pilot, total, lost = Pilot(Maneuver('one', (Segment(FIRST, 1.0),)), DT), 0.0, 0.0
    for tick in range(60):
        asked = pilot.rates(5.0 + tick * DT, lost)[0]
        made = min(asked, fastest)
        total += made * DT
        lost += (1.0 - made / asked) * DT if asked else 0.0
    assert total == pytest.approx(1.0, abs=1e-9)
    assert pilot.done


def test_a_hand_that_stands_still_holds_the_maneuver_where_it_is():
    pilot = Pilot(TWO, DT)
    assert turned(pilot, [0.0] * 30)[0] == 0.0
    assert not pilot.done
    assert pilot.rates(5.0 + 30 * DT, 3.0 + 30 * DT) == FIRST


def test_time_lost_that_starts_again_from_zero_does_not_turn_the_maneuver_back():
    """A reset of the resolver clears it."""
    pilot = Pilot(TWO, DT)
    pilot.rates(5.0, 3.0)
    assert pilot.rates(5.3, 0.0) == SECOND
    assert not pilot.done
    pilot.rates(5.6, 0.0)
    assert pilot.done


def test_more_time_lost_than_has_passed_means_that_nothing_was_followed():
    """Two statuses that come at once: the clock must not run on by less than nothing."""

    def finished(lost):
        pilot = Pilot(TWO, DT)
        pilot.rates(0.0, 0.0)
        pilot.rates(0.2 + lost, lost)  # the last half period of the first segment
        return pilot.rates(0.35 + lost, lost)

    assert finished(DT) == finished(5.0 * DT)


def test_one_second_of_zeros_and_a_whole_turn_are_what_the_maneuvers_say():
    """In degrees: what each maneuver turns the hand by, and for how long it asks for nothing."""
    degrees = {
        name: [
            tuple(round(math.degrees(rate) * segment.duration, 6) for rate in segment.rates)
            for segment in make_maneuver(name, 0.5).segments
        ]
        for name in MANEUVERS
        if name != 'stick'
    }
    assert degrees == {
        'basic_test': [(0.0, 90.0, 0.0), (0.0, 0.0, 90.0)],
        'extended_test': [(0.0, 90.0, 0.0), (0.0, 0.0, 360.0)],
        'pitch_then_roll': [(0.0, 40.0, 0.0), (360.0, 0.0, 0.0)],
        'roll_at_full_bend': [(0.0, 90.0, 0.0), (360.0, 0.0, 0.0)],
        'hold': [(0.0, 0.0, 0.0)],
    }
    assert make_maneuver('hold').duration == 2.0
    assert {name: make_maneuver(name).name for name in MANEUVERS} == {n: n for n in MANEUVERS}


def test_a_stick_is_as_fast_as_it_may_in_every_direction_and_another_with_another_seed():
    one, other = stick(0.5), stick(0.5, seed=2)
    rates = np.array([segment.rates for segment in one.segments])
    speeds = np.linalg.norm(rates, axis=1)
    assert one == make_maneuver('stick', 0.5)
    assert one != other
    assert (one.duration, len(one.segments), one.waits) == (60.0, 120, False)
    assert {segment.duration for segment in one.segments} == {0.5}
    assert 0.45 < speeds.max() <= 0.5
    assert 0.15 < speeds.mean() < 0.35  # evenly between none and all
    directions = rates / speeds[:, None]
    np.testing.assert_allclose(directions.mean(axis=0), 0.0, atol=0.2)
    np.testing.assert_allclose((directions**2).mean(axis=0), 1.0 / 3.0, atol=0.1)
