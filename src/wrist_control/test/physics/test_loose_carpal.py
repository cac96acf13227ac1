"""Where the balls of the Carpal wrist hold its distal plate, and where they let it go.

With still drives the mid-nodes stand. The distal plate and its links are then the base and its
links once more, on the same nodes: loose where the legs can turn so that the distances between
the nodes stay, which is where a12 a23 a31 + a21 a32 a13 = 0, a_ij what leg i changes of the
distance to node j. Our margin does not see it: it is what is left of the drives' own power.
"""

import math

import numpy as np
import pytest

pytest.importorskip('mujoco', reason='the extra physics is not installed')

from wrist_control import make_wrist
from wrist_control.physics.models import build
from wrist_control.rotations import Pose
from wrist_control.wrists.carpal import LOOSE

WRIST = make_wrist('carpal')
# At the place itself no loop can be closed: where the plate is, is not determined. So near, rad.
NEAR = 0.01
AZIMUTHS = np.radians((0.0, 120.0, -120.0))


def tilted(wrist, tilt, azimuth=0.0):
    """Return the joints with the hand tilted by an angle in a direction, the plunge held."""
    positions = wrist.home
    for angle in np.linspace(0.0, 0.5 * tilt, 40):
        out, z = math.sin(angle), math.cos(angle)
        x, y = out * math.cos(azimuth), out * math.sin(azimuth)
        reach = 2.0 * wrist.plunge * z
        positions = wrist.inverse(
            Pose((z, 0.0, x, -y), (reach * x, reach * y, reach * z)), positions
        )
    return positions


def held(wrist, positions):
    """Return a12 a23 a31 + a21 a32 a13."""
    outward = np.array([(math.cos(a), math.sin(a), 0.0) for a in AZIMUTHS])
    s, c = np.sin(positions)[:, None], np.cos(positions)[:, None]
    up = np.array((0.0, 0.0, 1.0))
    nodes = (wrist.base_radius + wrist.leg_length * c) * outward + wrist.leg_length * s * up
    moves = c * up - s * outward
    a = [[(nodes[i] - nodes[j]) @ moves[i] for j in range(3)] for i in range(3)]
    return a[0][1] * a[1][2] * a[2][0] + a[1][0] * a[2][1] * a[0][2]


def lock(wrist, azimuth=0.0):
    """Return the least tilt in a direction at which the balls let the plate go, rad."""

    def is_held(tilt):
        return held(wrist, tilted(wrist, tilt, azimuth)) * held(wrist, wrist.home) > 0.0

    step = 0.004
    low = next(k * step for k in range(1000) if not is_held((k + 1) * step))
    high = low + step
    for _ in range(20):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_held(middle) else (low, middle)
    return low


@pytest.mark.parametrize(
    ('base_radius', 'plunge', 'azimuth', 'tilt'),
    [
        (0.075, 0.07, 0.0, 86.0),
        (0.075, 0.07, 20.0, 82.0),
        (0.075, 0.06, 0.0, 77.0),
        (0.075, 0.06, 60.0, 69.0),
        (0.05, 0.05, 0.0, 90.0),
        (0.05, 0.05, 60.0, 67.0),
        (0.038, 0.086, 0.0, 132.0),
        (0.038, 0.086, 60.0, 103.0),
    ],
)
def test_the_plate_is_loose_where_no_distance_between_the_nodes_changes(
    base_radius, plunge, azimuth, tilt
):
    """docs/results/physics.md has these numbers."""
    wrist = make_wrist('carpal', base_radius=base_radius, plunge=plunge)
    azimuth = math.radians(azimuth)
    found = lock(wrist, azimuth)
    assert math.degrees(found) == pytest.approx(tilt, abs=0.55)
    mechanism = build(wrist)
    mechanism.start_at(tilted(wrist, found - NEAR, azimuth))
    assert 0.0 < mechanism.firmness < 0.03
    mechanism.start_at(tilted(wrist, found - 0.2, azimuth))
    assert mechanism.firmness > 0.1


def test_our_margin_does_not_see_it_and_our_clearance_does():
    positions = tilted(WRIST, lock(WRIST))
    assert WRIST.margin(positions) > 0.2
    (used_up,) = (limit.name for limit in WRIST.clearances(positions) if limit.remaining <= 0.0)
    assert used_up == LOOSE


@pytest.mark.parametrize('degrees', [-60.0, -30.0, 0.0, 30.0, 60.0, 80.0, 92.0, 100.0])
def test_on_both_sides_of_it_the_plate_can_mirror_the_base(degrees):
    positions = tilted(WRIST, math.radians(degrees))
    mechanism = build(WRIST)
    mechanism.start_at(positions)
    mirrored = WRIST.forward(positions).position
    assert mechanism.hand_pose.position == pytest.approx(mirrored, abs=1e-9)
    assert mechanism.settle()
    assert mechanism.hand_pose.position == pytest.approx(mirrored, abs=1e-9)


def test_near_it_a_push_turns_the_hand_away_from_the_mirror():
    gave_way = []
    for tilt in (math.radians(60.0), lock(WRIST) - NEAR):
        mechanism = build(WRIST)
        mechanism.start_at(tilted(WRIST, tilt))
        mechanism.push((0.0, 0.0, 0.0), (0.01, 0.01, 0.01))
        assert mechanism.settle()
        mirrored = WRIST.forward(mechanism.positions.tolist())
        gave_way.append(np.max(np.abs(mechanism.hand_pose.rotation - mirrored.rotation)))
    assert gave_way[1] > 100.0 * gave_way[0]
