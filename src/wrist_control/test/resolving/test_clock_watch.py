import pytest

from wrist_control.resolving.clock_watch import ClockWatch

SECOND = 10**9
START = 100 * SECOND


class Watched:
    """A clock that is looked at every 10 ms."""

    def __init__(self, timeout=0.25):
        self.watch = ClockWatch(timeout)
        self.reading, self.steady = START, 5.0

    def looks(self, seconds, speed=1.0, every=1):
        """Return what each look says while the clock runs at a speed, in ticks of some looks."""
        said = []
        for look in range(round(100 * seconds)):
            self.steady += 0.01
            if speed and look % every == 0:
                self.reading += round(0.01 * SECOND * speed * every)
            said.append(self.watch.look(self.reading, self.steady))
        return said


def test_a_clock_that_runs_is_trusted():
    clock = Watched()
    assert not any(clock.looks(1.0))
    assert not any(clock.looks(1.0, speed=10.0))
    assert (clock.watch.troubles, clock.watch.last) == (0, '')


def test_a_clock_that_stands_still_stops_the_hand_after_the_timeout_until_it_goes_on():
    clock = Watched()
    clock.looks(0.5)
    said = clock.looks(0.5, speed=0.0)
    assert said.index(True) == pytest.approx(25, abs=1)
    assert all(said[said.index(True) :])
    assert clock.watch.stands
    assert clock.watch.troubles == 1
    assert clock.watch.last.startswith('The clock has stood still for 0.2')
    assert not any(clock.looks(0.5))
    assert not clock.watch.stands


def test_a_slow_clock_is_not_one_that_stands_still():
    clock = Watched()
    clock.looks(0.8, speed=0.1, every=40)
    assert not any(clock.looks(4.0, speed=0.1, every=40))
    said = clock.looks(2.0, speed=0.0)
    assert said.index(True) == pytest.approx(120 - 40, abs=3)


def test_the_slowest_clock_has_a_few_seconds():
    clock = Watched()
    clock.looks(20.0, speed=0.1, every=1000)
    said = clock.looks(20.0, speed=0.0)
    assert any(said)


def test_while_the_node_itself_was_held_up_nothing_is_known_of_the_clock():
    clock = Watched()
    clock.looks(0.5)
    clock.steady += 3.0
    assert not any(clock.looks(0.15, speed=0.0))
    assert not any(clock.looks(0.5))


def test_before_there_is_time_nothing_stands_and_its_beginning_is_no_jump():
    watch = ClockWatch(0.25)
    assert not any(watch.look(0, 0.01 * look) for look in range(100))
    assert not watch.look(START, 1.0)
    assert watch.troubles == 0


def test_a_jump_back_stops_the_hand_once_and_ages_go_on():
    clock = Watched()
    clock.looks(0.5)
    before = clock.watch.age_time(clock.reading)
    clock.reading -= 500 * SECOND // 10
    assert clock.watch.age_time(clock.reading) == before
    clock.reading += SECOND // 100
    assert clock.watch.age_time(clock.reading) == before + SECOND // 100
    assert clock.looks(0.05) == [True, False, False, False, False]
    assert clock.watch.last.startswith('The clock jumped back by 50.000 s: ')


@pytest.mark.parametrize(('leap', 'stops'), [(0.24, False), (0.26, True)])
def test_a_leap_by_more_than_the_timeout_stops_the_hand_too(leap, stops):
    clock = Watched()
    clock.looks(0.5)
    clock.reading += round((leap - 0.01) * SECOND)
    assert any(clock.looks(0.05)) is stops
    assert ('jumped ahead by' in clock.watch.last) is stops
