"""Where a wrist may start from, and what is said of a start that cannot be used."""

import math

import numpy as np
import pytest

from wrist_control import InvalidValueError, make_wrist
from wrist_control.resolving import State, start

WRIST = make_wrist('three_gimbal')
LOCKED = 0.5 * math.pi


def test_a_start_is_at_home_unless_told_otherwise():
    assert start(WRIST) == State((0.0, 0.0, 0.0), WRIST.forward((0.0, 0.0, 0.0)), (), 0.0)
    there = start(WRIST, np.array([0.1, 0.2, 0.3]))
    assert there.positions == (0.1, 0.2, 0.3)
    assert there.pose == WRIST.forward((0.1, 0.2, 0.3))


@pytest.mark.parametrize(
    ('positions', 'sentence'),
    [
        ((0.0, 0.0), r'has 2 values; give one for each of psi, theta, phi\.'),
        ((), r'has 0 values; give one for each of psi, theta, phi\.'),
        ((0.0, 0.0, 1.5), r'has 1\.5 for phi; valid is -1 to 1, and finite\.'),
        ((0.0, -1.1, 0.0), r'has -1\.1 for theta; valid is -1 to 1'),
        ((math.nan, 0.0, 0.0), r'has nan for psi; valid is'),
        ((0.0, math.inf, 0.0), r'has inf for theta; valid is'),
    ],
)
def test_a_start_that_cannot_be_used_is_refused_in_a_sentence(positions, sentence):
    with pytest.raises(InvalidValueError, match=f'initial_positions {sentence}'):
        start(WRIST.with_limits(lower=-1.0, upper=1.0), positions)


def test_a_start_must_be_finite_even_without_limits():
    for endless in (math.inf, -math.inf, math.nan):
        with pytest.raises(InvalidValueError, match='and finite'):
            start(WRIST, (endless, 0.0, 0.0))


@pytest.mark.parametrize('theta', [LOCKED, -LOCKED, LOCKED + 0.5e-3, 3.0 * LOCKED])
def test_a_start_at_lock_is_refused_with_the_margin_it_needs(theta):
    with pytest.raises(InvalidValueError, match=r'are at lock \(margin .*\); start .*0\.001'):
        start(WRIST, (0.0, theta, 0.0))
    start(WRIST, (0.0, theta + 2e-3, 0.0))


def test_a_start_outside_what_the_mechanism_can_do_is_refused(rail):
    class Bounded(rail):
        gap = (2.0, math.inf)
        fence = 0.5

    with pytest.raises(InvalidValueError, match=r'cannot be taken: There the rail cannot be ass'):
        start(Bounded(), (2.5,))
    with pytest.raises(InvalidValueError, match='lie outside: fence; start further inside'):
        start(Bounded(), (0.6,))
    assert start(Bounded(), (0.5,)).positions == (0.5,)
