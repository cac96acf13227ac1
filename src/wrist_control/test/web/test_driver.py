"""What the console asks of its wrists, given who holds the stick and for how long."""

import math

import pytest

pytest.importorskip('nicegui', reason='the console needs the extra `console`')

from wrist_control.operating.lease import LASTS, Renewal
from wrist_control.operating.maneuvers import BARKER_SPEED
from wrist_control.web.driver import Asked, Driver

PERIOD, FASTEST = 0.02, 2.0
NOW = 50.0
UP = Asked((0.0, 1.0, 0.0), 0.5)


def hold(driver, asked=UP, now=NOW, holder='page', grip=1):
    return driver.hold(Renewal(holder, grip, now, asked), now)


@pytest.fixture
def driver():
    return Driver(PERIOD, FASTEST)


def test_nothing_is_said_while_nobody_holds(driver):
    assert driver.rates(NOW, 0.0) is None


def test_the_deflection_times_the_speed_is_asked_for(driver):
    assert hold(driver, Asked((0.5, -1.0, 0.25), 0.8)) == ''
    assert driver.rates(NOW, 0.0) == pytest.approx((0.4, -0.8, 0.2))
    assert driver.holder(NOW) == 'page'


def test_after_the_stick_is_let_go_zeros_are_said_for_a_moment_and_then_nothing(driver):
    hold(driver)
    driver.rates(NOW, 0.0)
    driver.release('page')
    said = [driver.rates(NOW + PERIOD * tick, 0.0) for tick in range(40)]
    zeros = [one for one in said if one is not None]
    assert set(zeros) == {(0.0, 0.0, 0.0)}
    assert len(zeros) * PERIOD == pytest.approx(LASTS, abs=2.0 * PERIOD)
    assert said[len(zeros) :] == [None] * (40 - len(zeros))


def test_a_silent_page_has_let_go(driver):
    hold(driver)
    assert driver.rates(NOW + LASTS, 0.0) == (0.0, 0.5, 0.0)
    assert driver.rates(NOW + LASTS + 1e-6, 0.0) == (0.0, 0.0, 0.0)
    assert driver.holder(NOW + LASTS + 1e-6) == ''


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize('place', range(4))
def test_what_is_not_finite_is_refused_and_lets_go(driver, bad, place):
    hold(driver)
    numbers = [0.0, 1.0, 0.0, 0.5]
    numbers[place] = bad
    *deflection, speed = numbers
    assert 'not finite' in hold(driver, Asked(tuple(deflection), speed))
    assert driver.rates(NOW, 0.0) is None


def test_more_than_the_whole_stick_is_the_whole_stick_and_no_faster_than_the_fastest(driver):
    hold(driver, Asked((5.0, -7.0, 0.0), 1e9))
    assert driver.rates(NOW, 0.0) == (FASTEST, -FASTEST, 0.0)


def test_an_unknown_maneuver_is_refused(driver):
    assert "no maneuver 'somersault'" in hold(driver, Asked((0.0, 0.0, 0.0), 1.0, 'somersault'))
    assert driver.rates(NOW, 0.0) is None


def fly(driver, seconds, grip=1, lost=lambda time: 0.0):
    """Hold the button that flies for a while; return all that was asked for."""
    asked, said = Asked((0.0, 0.0, 0.0), BARKER_SPEED, 'basic_test'), []
    for tick in range(round(seconds / PERIOD)):
        now = NOW + PERIOD * tick
        hold(driver, asked, now, grip=grip)
        said.append(driver.rates(now, lost(now)))
    return said


def test_a_maneuver_turns_the_hand_by_what_it_is_made_of_and_lets_go_at_its_end(driver):
    said = fly(driver, 8.0)
    flown = [one for one in said if one is not None]
    assert sum(rates[1] for rates in flown) * PERIOD == pytest.approx(math.pi / 2)
    assert sum(rates[2] for rates in flown) * PERIOD == pytest.approx(math.pi / 2)
    assert said[-1] is None
    assert driver.holder(NOW + 8.0) == ''


def test_a_maneuver_that_is_let_go_begins_anew(driver):
    fly(driver, 4.0)
    driver.release('page')
    driver.rates(NOW + 4.0, 0.0)
    assert fly(driver, 1.0, grip=2)[-1] == (0.0, BARKER_SPEED, 0.0)


def test_a_maneuver_waits_for_the_hand(driver):
    """A hand that stands still keeps the maneuver where it is."""
    said = fly(driver, 8.0, lost=lambda now: now - NOW)
    assert said[-1][1] > 0.0


def test_a_stop_lets_go_whoever_holds_and_who_is_forgotten_begins_anew(driver):
    hold(driver)
    driver.release_all()
    assert driver.rates(NOW, 0.0) is None
    assert 'has ended' in hold(driver)
    driver.forget('page')
    assert hold(driver) == ''
