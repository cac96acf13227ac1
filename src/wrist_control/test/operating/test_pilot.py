"""The pilot, who flies a maneuver tick by tick and only hears how much time is being lost."""

import math

import numpy as np
import pytest

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


def test_a_clock_that_nothing_was_asked_of_is_at_the_start():
    clock = ManeuverClock(TWO, 0.1)
    assert clock.time == 0.0
    assert not clock.done


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
