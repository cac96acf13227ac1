"""Commands given again: each at its time, none for longer than it was held."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import InvalidValueError
from wrist_control.operating.recorded import ZERO, Given, RecordedCommands

HELD = 0.25


def turning(rate):
    return (0.0, 0.0, 0.0, rate, 0.0, 0.0)


def three():
    """Two that follow each other, and one after a silence."""
    times = (100.0, 100.1, 101.0)
    return RecordedCommands([Given(t, turning(n + 1.0)) for n, t in enumerate(times)], HELD)


@pytest.mark.parametrize(
    ('elapsed', 'rate'),
    [
        (0.0, 1.0),
        (0.099, 1.0),
        (0.1, 2.0),
        (0.34, 2.0),
        (0.36, 0.0),
        (0.99, 0.0),
        (1.01, 3.0),
        (1.24, 3.0),
        (1.26, 0.0),
        (99.0, 0.0),
    ],
)
def test_each_is_asked_for_from_its_time_on_until_the_next_or_until_silence(elapsed, rate):
    commands = three()
    assert commands.twist(7.0) == turning(1.0)
    assert commands.twist(7.0 + elapsed) == pytest.approx(turning(rate))


def test_it_begins_when_it_is_first_asked_and_ends_when_the_last_was_held():
    commands = three()
    assert (commands.began, commands.done) == (None, False)
    assert commands.duration == pytest.approx(1.25)
    commands.twist(7.0)
    assert (commands.began, commands.done) == (7.0, False)
    commands.twist(8.2)
    assert not commands.done
    assert commands.twist(8.3) == ZERO
    assert commands.done


@given(st.lists(st.floats(0.0, 100.0), min_size=1), st.floats(0.0, 120.0))
def test_it_is_the_last_of_those_before(times, elapsed):
    times = sorted(times)
    commands = RecordedCommands([Given(t, turning(float(n))) for n, t in enumerate(times)], HELD)
    commands.twist(0.0)
    before = [n for n, t in enumerate(times) if t - times[0] <= elapsed]
    fresh = elapsed - (times[before[-1]] - times[0]) < HELD
    assert commands.twist(elapsed) == (turning(float(before[-1])) if fresh else ZERO)


def test_no_command_at_all_is_refused():
    with pytest.raises(InvalidValueError, match='There is no command'):
        RecordedCommands([], HELD)
