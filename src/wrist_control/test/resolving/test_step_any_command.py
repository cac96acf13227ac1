"""Any finite command to any wrist: nothing is raised, nothing is not finite, F is the largest."""

import math

import numpy as np
import pytest

from wrist_control import WRISTS, make_wrist
from wrist_control.resolving import start, step


def commands(wrist, count, seed=0):
    rng = np.random.default_rng(seed)
    for number in range(count):
        size = 10.0 ** (rng.uniform(-300.0, 300.0) if number % 3 == 0 else rng.uniform(-6.0, 4.0))
        twist = rng.normal(size=wrist.twist_size) * size
        if number % 2:
            twist[rng.integers(wrist.twist_size)] = 0.0
        yield twist.tolist(), float(10.0 ** rng.uniform(-4.0, 1.0))


@pytest.mark.parametrize('limited', [True, False])
@pytest.mark.parametrize('name', WRISTS)
def test_no_finite_command_raises_and_nothing_infinite_comes_of_it(name, limited):
    wrist = make_wrist(name)
    if limited:
        wrist = wrist.with_limits(rates=0.5)
    state = start(wrist)
    for twist, dt in commands(wrist, 300):
        made = step(wrist, state, twist, dt)
        assert math.isfinite(sum(made.joint_rates) + sum(made.achieved) + made.scale_factor)
        if not any(made.joint_rates) and max(map(abs, twist)) * dt > 1e-9:
            assert made.limits
        if made.scale_factor == 1.0 and math.hypot(*twist) * dt < 0.1:
            state = made.state


def test_the_edge_that_the_carpal_wrist_cannot_even_look_beyond_is_a_limit():
    wrist = make_wrist('carpal')
    made = step(wrist, start(wrist), (0.151, 3.124, 0.0), 1.0)
    assert 0.1 < made.scale_factor < 1.0
    assert [limit.joint for limit in made.limits] == ['mid-nodes in one line']


def test_what_falls_off_only_at_the_end_does_not_stop_the_platform():
    """What is left near lock is not monotone along this command: guesses of 0.98 led nowhere."""
    wrist = make_wrist('stewart')
    made = step(wrist, start(wrist), (0.718, 0.325, 0.078, -0.102, -0.64, 0.638), 1.0)
    assert 0.8 < made.scale_factor < 1.0


@pytest.mark.parametrize(('name', 'size'), [('stewart', 1.0), ('carpal', 3.0)])
def test_no_command_of_a_second_is_stopped_that_could_go_a_part_of_the_way(name, size):
    wrist = make_wrist(name)
    rng = np.random.default_rng(1)
    for _ in range(150):
        twist = rng.normal(size=wrist.twist_size)
        twist *= size / np.linalg.norm(twist)
        made = step(wrist, start(wrist), twist.tolist(), 1.0)
        assert made.scale_factor > 0.01


def test_the_carpal_wrist_goes_as_far_as_it_can_in_one_step():
    wrist = make_wrist('carpal')
    rng = np.random.default_rng(1)
    for _ in range(150):
        twist = rng.normal(size=3)
        twist *= 3.0 / np.linalg.norm(twist)
        made = step(wrist, start(wrist), twist.tolist(), 1.0)
        if made.scale_factor < 1.0:
            more = step(wrist, start(wrist), (1.02 * made.scale_factor * twist).tolist(), 1.0)
            assert more.scale_factor < 1.0
