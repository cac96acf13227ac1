"""Starts, turns, stops and pauses of a supervised hand: no rate ever changes too quickly."""

from itertools import pairwise

import numpy as np
import pytest

from wrist_control import make_wrist
from wrist_control.resolving.period import Mode
from wrist_control.testing.eased import longest_change

WRIST = make_wrist('three_gimbal').with_limits(
    rates=0.5, lower=-2.0, upper=2.0, accelerations=2.0, decelerations=5.0
)
ROLL = (0.0, 0.0, 0.0, 0.4, 0.0, 0.0)
BACK = (0.0, 0.0, 0.0, -0.4, 0.1, 0.0)


@pytest.fixture
def sluggish(clocked):
    return clocked(WRIST)


def rates(results):
    return [result.step.joint_rates for result in results]


def assert_gentle(results, before=()):
    for old, new in zip([before, *rates(results)], rates(results), strict=False):
        assert longest_change(WRIST.joints, old, new) <= 0.01 * (1.0 + 1e-6)


def disable(sluggish):
    sluggish.enable(False)


def fail(sluggish):
    sluggish.supervisor.stop('It is broken.', Mode.FAULT)


def fall_silent(sluggish):
    pass


def release(sluggish):
    """Release a dead-man's switch, for good."""
    tick = sluggish.supervisor.tick
    sluggish.supervisor.tick = lambda **now: tick(**now, withheld='Released.')


def reset(sluggish):
    sluggish.supervisor.reset()


@pytest.mark.parametrize('end', [disable, fail, fall_silent, reset])
@pytest.mark.parametrize('stop_time', [0.001, 0.1, 0.4])
def test_a_start_a_turn_and_every_end_of_it_are_gentle(clocked, end, stop_time):
    sluggish = clocked(WRIST, stop_time=stop_time)
    results = sluggish.ticks(0.5, ROLL) + sluggish.ticks(0.3, BACK)
    end(sluggish)
    results += sluggish.ticks(2.0)
    assert_gentle(results)
    moving = [result for result in results if any(result.step.joint_rates)]
    last = results.index(moving[-1])
    assert results[last + 1].moving_allowed  # a zero was sent
    assert not any(results[last + 1].step.joint_rates)


def test_a_stop_ends_only_at_rest_and_then_nothing_is_sent(sluggish):
    sluggish.supervisor.settings = sluggish.supervisor.settings._replace(stop_time=0.001)
    sluggish.ticks(0.5, ROLL)
    sluggish.enable(False)
    results = sluggish.ticks(0.3)
    down = [result.step.joint_rates[2] for result in results if result.moving_allowed]
    np.testing.assert_allclose(down, [0.35, 0.3, 0.25, 0.2, 0.15, 0.1, 0.05, 0.0], atol=1e-8)
    assert not results[-1].moving_allowed


def test_a_hand_that_comes_to_rest_is_not_yet_ready(sluggish):
    sluggish.ticks(0.5, ROLL)
    result = sluggish.follow((0.0,) * 6)
    assert (result.wrist_state.name, result.message) == (
        'TRACKING',
        'Coming to rest: no motion is commanded.',
    )
    assert sluggish.ticks(0.2, (0.0,) * 6)[-1].wrist_state.name == 'IDLE'


def test_after_a_fault_at_once_the_hand_starts_from_rest(sluggish):
    sluggish.ticks(0.5, ROLL)
    sluggish.supervisor.give_up('The step could not be computed.')
    sluggish.enable(True)
    assert_gentle(sluggish.ticks(0.3, ROLL))


def tick_after(sluggish, pause):
    sluggish.count += round(pause / sluggish.dt) - 1
    sluggish.count += 1
    sluggish.command(ROLL)
    return sluggish.supervisor.tick(
        stamp_time=sluggish.now, receipt_time=sluggish.now, pause=pause
    )


def test_after_a_pause_the_hand_starts_from_how_fast_it_was_over_all_of_it(sluggish):
    """Joints that were told nothing for a second stand still: their last rate is long gone."""
    sluggish.ticks(0.5, ROLL)
    result = tick_after(sluggish, 1.0)
    assert result.step.joint_rates[2] == pytest.approx(0.4 * 0.01 / 1.0 + 2.0 * 0.01)
    assert_gentle(sluggish.ticks(0.3, ROLL), result.step.joint_rates)


def test_a_step_that_is_only_late_changes_nothing(sluggish):
    sluggish.ticks(0.5, ROLL)
    assert tick_after(sluggish, 0.05).step.joint_rates[2] == pytest.approx(0.4)


def test_a_stop_is_not_sped_up_again_after_a_pause(sluggish):
    sluggish.ticks(0.5, ROLL)
    sluggish.enable(False)
    sluggish.ticks(0.02)
    results = [tick_after(sluggish, 0.5), *sluggish.ticks(0.1)]
    assert max(abs(rate) for one in rates(results) for rate in one) <= 0.4 * 0.01 / 0.5
    assert results[-1].wrist_state.name == 'DISABLED'


@pytest.mark.parametrize('stop_time', [0.1, 0.5])
@pytest.mark.parametrize('end', [disable, fail, fall_silent, release])
@pytest.mark.parametrize('begun', [0.05, 0.1, 0.3])
def test_a_stop_never_speeds_the_hand_up(clocked, begun, end, stop_time):
    """Stopped while it still gathers speed, or is held back by a rate limit."""
    sluggish = clocked(WRIST, stop_time=stop_time)
    sluggish.ticks(begun, [2.0 * x for x in ROLL])
    results = sluggish.ticks(0.26) if end is fall_silent else []
    end(sluggish)
    results = results[-1:] + sluggish.ticks(1.0)
    speeds = [abs(one[2]) for one in rates(results)]
    assert speeds[0] > 0.0
    assert all(later <= sooner + 1e-12 for sooner, later in pairwise(speeds))
    assert speeds[-1] == 0.0


@pytest.mark.parametrize('begun', [0.05, 0.1, 0.3])
def test_a_stop_on_the_way_home_never_speeds_the_hand_up(clocked, begun):
    sluggish = clocked(WRIST, stop_time=0.5, initial=(1.0, 0.0, 0.0))
    sluggish.supervisor.settings = sluggish.supervisor.settings._replace(
        initial_positions=(0.0, 0.0, 0.0)
    )
    sluggish.supervisor.reset()
    sluggish.ticks(begun)
    sluggish.enable(False)
    speeds = [abs(one[0]) for one in rates(sluggish.ticks(1.0))]
    assert speeds[0] > 0.0
    assert all(later <= sooner + 1e-12 for sooner, later in pairwise(speeds))
    assert speeds[-1] == 0.0
