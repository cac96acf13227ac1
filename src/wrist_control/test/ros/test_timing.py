import pytest

from wrist_control.ros.timing import Timing

MS = 10**6


def made(stamps, period=0.01):
    timing = Timing(period)
    steps = []
    for stamp in stamps:
        if timing.is_due(stamp):
            timing.step(stamp)
            steps.append(stamp)
    return timing, steps


def test_steps_that_come_a_millisecond_apart_after_a_pause_are_not_made():
    late = [0, 10 * MS, 65 * MS, 66 * MS, 70 * MS, 75 * MS, 80 * MS]
    timing, steps = made(late)
    assert steps == [0, 10 * MS, 65 * MS, 75 * MS]
    assert timing.missed == 5


@pytest.mark.parametrize(('gap', 'due'), [(8.9, False), (9.0, True), (11.0, True)])
def test_a_tenth_of_a_period_is_let_pass(gap, due):
    timing, _ = made([0])
    assert timing.is_due(round(gap * MS)) is due


def test_a_clock_that_was_set_back_does_not_hold_up_the_steps():
    timing, _ = made([10**12])
    assert timing.is_due(5 * 10**11)
    timing.step(5 * 10**11)
    assert timing.missed == 0


@pytest.mark.parametrize(('gap', 'late'), [(10.9, False), (11.1, True)])
def test_a_step_is_late_by_more_than_a_tenth_of_a_period(gap, late):
    timing, _ = made([0])
    assert timing.is_late(round(gap * MS)) is late


def test_missed_steps_are_counted():
    timing, _ = made([0, 10 * MS, 40 * MS, 51 * MS])
    assert timing.missed == 2


def test_lateness_latency_and_ages_are_shown():
    timing = Timing(0.01)
    assert timing.values(0.0) == {'missed steps': '0', 'lateness of a step': 'none yet'}
    stamp = 0
    for step in range(101):
        stamp += 10 * MS + step * MS // 100
        timing.step(stamp)
    timing.hear('command', 3.0, 1e-9 * stamp + 0.002)
    timing.hear('joint states', 3.5)
    timing.step(stamp + 10 * MS)
    shown = timing.values(4.0)
    assert shown['lateness of a step'] == 'p50 0.50 ms, p99 0.99 ms, max 1.00 ms'
    assert shown['latency from stamp to step'] == 'p50 8.00 ms, p99 8.00 ms, max 8.00 ms'
    assert shown['age of the newest command'] == '1.000 s'
    assert shown['age of the newest joint states'] == '0.500 s'
