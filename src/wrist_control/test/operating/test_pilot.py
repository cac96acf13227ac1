<<<<<<< HEAD
"""The pilot, who flies a maneuver tick by tick and only hears how much time is being lost."""
=======
"""The pilot's clock: it stands still while the hand loses time, and segments end exactly."""
>>>>>>> wt-mutants

import math

import numpy as np
import pytest

<<<<<<< HEAD
from wrist_control import fly
from wrist_control.operating.maneuvers import BARKER_SPEED, Maneuver, Segment, turn
from wrist_control.operating.pilot import ManeuverClock, Pilot

H = 1.0 / 32.0
TWO = Maneuver('two', (Segment((1.0, 0.0, 0.0), 0.35), Segment((0.0, 2.0, 0.0), 0.25)))
PITCH = Maneuver('pitch', (turn(1, 0.3, BARKER_SPEED),))


def piloted(maneuver, limit, delay=0, rate=32.0, began=0.0, lost_before=0.0):
    """Return what a pilot asks of a hand that is no faster than a limit, and how far it turns.

    Args:
        maneuver: What to fly.
        limit: The fastest that the hand turns, rad/s.
        delay: Ticks after which the pilot hears of the time that was lost.
        rate: Ticks per second.
        began: The time at the first tick, s.
        lost_before: The time lost before that, s.
    """
    pilot, dt, angle = Pilot(maneuver, 1.0 / rate), 1.0 / rate, 0.0
    asked, lost = [], [lost_before] * (delay + 1)
    while not (pilot.done and not any(asked[-2 - delay :])):
        speed = math.hypot(*pilot.rates(began + len(asked) * dt, lost[-1 - delay]))
        asked.append(speed)
        made = min(speed, limit)
        angle += made * dt
        lost.append(lost[-1] + (dt * (1.0 - made / speed) if speed else 0.0))
        assert len(asked) < 2000, 'the maneuver never ends'
    return asked, angle


@pytest.mark.parametrize('rate', [7.0, 32.0, 100.0])
def test_a_pilot_asks_a_hand_that_follows_for_what_a_flight_asks(rate):
    asked, angle = piloted(PITCH, 2.0, rate=rate, began=5.0, lost_before=3.0)
    assert angle == pytest.approx(0.3, abs=1e-8)
    flight = fly('three_gimbal', PITCH, rate)
    shorter = min(len(asked), len(flight.time))
    np.testing.assert_allclose(asked[:shorter], flight.command[:shorter, 1], atol=1e-6)
    assert not any(asked[shorter:])


@pytest.mark.parametrize('delay', [0, 1, 2])
@pytest.mark.parametrize('factor', [0.05, 0.1, 0.2, 0.24, 0.26, 0.3, 0.5, 0.8])
def test_a_pilot_waits_for_a_slow_hand_to_within_the_steps_it_hears_late(factor, delay):
    _, angle = piloted(PITCH, factor * BARKER_SPEED, delay)
    assert angle == pytest.approx(0.3, abs=(delay + 1) * BARKER_SPEED * H)


def test_a_pilot_who_does_not_wait_ends_in_time():
    hasty = Maneuver('hasty', PITCH.segments, waits=False)
    asked, _ = piloted(hasty, 0.01)
    assert len(asked) * H == pytest.approx(hasty.duration, abs=3 * H)


def test_a_reset_of_time_lost_does_not_set_a_pilot_back():
    pilot = Pilot(TWO, 0.1)
    assert pilot.rates(0.0, 5.0) == (1.0, 0.0, 0.0)
    assert pilot.rates(0.4, 0.0) == (0.0, 2.0, 0.0)
    assert not pilot.done
    pilot.rates(0.6, 0.0)
    assert pilot.done


def test_a_clock_stands_still_while_time_is_lost_and_runs_slower_on_a_slow_order():
    clock = ManeuverClock(TWO, 0.1)
    assert clock.order(0.2, 0.0).rates == (1.0, 0.0, 0.0)
    assert clock.order(0.3, 0.1).share == 1.0
    assert clock.time == pytest.approx(0.2)
    last = clock.order(0.4, 0.1)
    assert last.share == pytest.approx(0.5)
    clock.follow(last, 0.1)
    clock.order(0.5, 0.1)
    assert clock.time == pytest.approx(0.35)
    assert not clock.done
    clock.order(0.75, 0.1)
    assert clock.done
=======
from wrist_control.operating.maneuvers import (
    MANEUVERS,
    Maneuver,
    Pilot,
    Segment,
    make_maneuver,
    stick,
)

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
>>>>>>> wt-mutants
