"""The Carpal wrist flown to the edge of its workspace, and what is said of it there."""

import math

import numpy as np
import pytest

from wrist_control import UnreachableError, fly
from wrist_control.operating.maneuvers import Maneuver, Segment
from wrist_control.resolving import LimitKind, start, step
from wrist_control.wrists.carpal import Carpal

# The hand stops this far before its edge: `soft_edge`.
STOP = 0.02


def test_small_plunges_never_lose_closure():
    assert Carpal(0.075, 0.1, 0.06).reach(1.0) == math.pi
    assert Carpal(0.075, 0.1, 0.07).reach(1.0) < math.radians(100.0)


def there_and_back(heading):
    p, q = math.cos(heading), math.sin(heading)
    return Maneuver(
        'there and back',
        (Segment((p, q, 0.0), 4.0), Segment((-p, -q, 0.0), 0.5)),
        waits=False,
    )


@pytest.mark.parametrize('limit', [None, 1.0])
@pytest.mark.parametrize('rate', [32.0, 100.0])
@pytest.mark.parametrize('heading', np.linspace(0.1, 6.2, 8))
def test_edge_is_neared_without_overshoot_and_left_freely(heading, rate, limit):
    wrist = Carpal()
    flight = fly(wrist, there_and_back(heading), rate=rate, joint_rate_limits=limit)
    tilt = np.arccos(np.clip(flight.hand_rotation[:, 2, 2], -1.0, 1.0))
    edge = wrist.reach(heading - 0.5 * math.pi)
    assert flight.margin.min() >= STOP - 1e-9
    assert edge - math.radians(1.0) < tilt.max() < edge
    assert tilt[-1] < tilt.max() - math.radians(5.0)
    if limit is not None:
        assert np.abs(flight.joint_rates).max() <= limit * (1.0 + 1e-6)
    else:
        back = flight.scale_factor[flight.time > 4.05][:-1]
        assert np.all(back == 1.0)


def test_edge_says_which_leg_is_closing():
    wrist = Carpal()
    state = start(wrist)
    for _ in range(200):
        made = step(wrist, state, (1.0, 0.0, 0.0), 0.02)
        state = made.state
    assert {(x.joint, x.kind) for x in made.limits} == {('closure of leg 2', LimitKind.WORKSPACE)}
    assert made.achieved[3] < 1e-3 < 1.0


def test_resolver_reports_the_roll_that_is_forced_and_not_the_one_commanded():
    wrist = Carpal()
    made = step(wrist, start(wrist, (0.5, 0.9, 0.8)), (0.3, -0.2, 0.7), 0.01)
    a1, _, a3, a4 = made.state.pose.quaternion
    p, q, r = made.achieved[3:]
    assert (p, q) == pytest.approx((0.3, -0.2), abs=1e-9)
    assert r == pytest.approx((a3 * p - a4 * q) / a1, abs=1e-9)


def test_a_long_step_cannot_jump_over_the_half_turn():
    wrist = Carpal(plunge=0.05)
    pose = wrist.target_pose(wrist.forward(wrist.home), (0.0, math.radians(175.0), 0.0), 1.0)
    with pytest.raises(UnreachableError, match='half turn'):
        wrist.target_pose(pose, (0.0, math.radians(10.0), 0.0), 1.0)
