"""The Carpal wrist flown to the edge of its workspace, and what is said of it there."""

import math

import numpy as np
import pytest

from wrist_control import UnreachableError, fly
from wrist_control.operating.maneuvers import Maneuver, Segment
from wrist_control.resolving import LimitKind, start, step
from wrist_control.rotations import Pose, turned
from wrist_control.studies.canfield_closure import fold
from wrist_control.wrists.carpal import AZIMUTHS, Carpal

# The hand stops this far before its edge: `soft_edge`.
STOP = 0.02


def test_small_plunges_never_lose_closure():
    assert fold(Carpal(0.075, 0.1, 0.06), 1.0) == math.pi
    assert fold(Carpal(0.075, 0.1, 0.07), 1.0) < math.radians(100.0)


def there_and_back(heading):
    p, q = math.cos(heading), math.sin(heading)
    return Maneuver(
        'there and back',
        (Segment((p, q, 0.0), 4.0), Segment((-p, -q, 0.0), 0.5)),
        waits=False,
    )


def held_by(wrist, positions):
    """Return the least singular value of what holds the hand while no drive moves.

    Where the mid-nodes are, from the hand: it can move in six ways, and its three links turn.
    """
    pose = wrist.forward(positions)

    def nodes(x):
        turned_by = turned(pose.quaternion, tuple(x[3:6]), 1.0)
        held = Pose(turned_by, tuple(np.add(pose.position, x[:3])))
        return np.ravel(
            [
                held.point(
                    (
                        cos * (wrist.base_radius + wrist.leg_length * math.cos(theta)),
                        sin * (wrist.base_radius + wrist.leg_length * math.cos(theta)),
                        -wrist.leg_length * math.sin(theta),
                    )
                )
                for (cos, sin), theta in zip(AZIMUTHS, np.add(positions, x[6:]), strict=True)
            ]
        )

    h = 1e-6
    columns = [(nodes(h * e) - nodes(-h * e)) / (2.0 * h) for e in np.eye(9)]
    true = np.ravel(wrist._midplane(positions).nodes)
    np.testing.assert_allclose(nodes(np.zeros(9)), true, atol=1e-12)
    return float(np.linalg.svd(np.array(columns))[1][-1])


def tilted(wrist, heading, tilt, near):
    """Return the joints of the hand tilted about an axis at a heading in the plates."""
    x, y, z = (
        math.sin(0.5 * tilt) * math.sin(heading),
        -math.sin(0.5 * tilt) * math.cos(heading),
        math.cos(0.5 * tilt),
    )
    reach = 2.0 * wrist.plunge * z
    return wrist.inverse(Pose((z, 0.0, x, -y), (reach * x, reach * y, reach * z)), near)


def loose(wrist, heading):
    """Return the first tilt at which the hand is loose, rad, as `held_by` says; inf for none."""
    near, before = wrist.home, math.inf
    for tilt in np.radians(np.arange(0.0, 100.0, 0.05)):
        try:
            near = tilted(wrist, heading, tilt, near)
        except UnreachableError:
            return math.inf
        if wrist.firmness(near) < 0.02:
            found = held_by(wrist, near)
            if found > before:
                return tilt
            before = found
    return math.inf


@pytest.mark.parametrize('dimensions', [(0.075, 0.1, 0.07), (0.075, 0.1, 0.06), (0.05, 0.1, 0.05)])
@pytest.mark.parametrize('heading', [0.5 * math.pi, 0.4 * math.pi, 0.3])
def test_the_hand_is_loose_where_its_firmness_is_nothing(dimensions, heading):
    """Against the whole mechanism: nine equations of where the mid-nodes are."""
    wrist = Carpal(*dimensions)
    tilt = loose(wrist, heading)
    if math.isfinite(tilt):
        near = wrist.home
        for step_of_tilt in np.linspace(0.0, tilt, 50):
            near = tilted(wrist, heading, step_of_tilt, near)
        assert wrist.firmness(near) < 2e-3 < 0.1 < wrist.firmness(wrist.home)
        assert held_by(wrist, near) < 0.01 * held_by(wrist, wrist.home)
    else:
        assert dimensions[2] == 0.07  # there a leg folds before


@pytest.mark.parametrize('limit', [None, 1.0])
@pytest.mark.parametrize('rate', [32.0, 100.0])
@pytest.mark.parametrize('heading', np.linspace(0.1, 6.2, 8))
def test_edge_is_neared_without_overshoot_and_left_freely(heading, rate, limit):
    wrist = Carpal()
    flight = fly(wrist, there_and_back(heading), rate=rate, joint_rate_limits=limit)
    tilt = np.arccos(np.clip(flight.hand_rotation[:, 2, 2], -1.0, 1.0))
    fold_edge, loose_edge = fold(wrist, heading - 0.5 * math.pi), loose(wrist, heading)
    assert flight.margin.min() >= STOP - 1e-9
    assert min(fold_edge - math.radians(1.0), loose_edge - math.radians(2.5)) < tilt.max()
    assert tilt.max() < min(fold_edge, loose_edge)
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
