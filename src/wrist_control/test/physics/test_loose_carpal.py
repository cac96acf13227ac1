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

WRIST = make_wrist('carpal')
# At the place itself no loop can be closed: where the plate is, is not determined. So near, rad.
NEAR = 0.01
AZIMUTHS = np.radians((0.0, 120.0, -120.0))


def tilted(tilt):
    """Return the joints with the hand tilted towards leg 1 by an angle, the plunge held."""
    positions = WRIST.home
    for angle in np.linspace(0.0, tilt, 30):
        x, z = math.sin(0.5 * angle), math.cos(0.5 * angle)
        reach = 2.0 * WRIST.plunge * z
        pose = Pose((z, 0.0, x, 0.0), (reach * x, 0.0, reach * z))
        positions = WRIST.inverse(pose, positions)
    return positions


def held(positions):
    """Return a12 a23 a31 + a21 a32 a13."""
    outward = np.array([(math.cos(a), math.sin(a), 0.0) for a in AZIMUTHS])
    s, c = np.sin(positions)[:, None], np.cos(positions)[:, None]
    up = np.array((0.0, 0.0, 1.0))
    nodes = (WRIST.base_radius + WRIST.leg_length * c) * outward + WRIST.leg_length * s * up
    moves = c * up - s * outward
    a = [[(nodes[i] - nodes[j]) @ moves[i] for j in range(3)] for i in range(3)]
    return a[0][1] * a[1][2] * a[2][0] + a[1][0] * a[2][1] * a[0][2]


def lock():
    """Return the tilt towards leg 1 at which the balls let the plate go, by bisection, rad."""
    low, high = math.radians(60.0), math.radians(100.0)
    for _ in range(40):
        middle = 0.5 * (low + high)
        low, high = (
            (middle, high) if held(tilted(middle)) * held(WRIST.home) > 0 else (low, middle)
        )
    return low


def test_the_plate_is_loose_where_no_distance_between_the_nodes_changes():
    tilt = lock()
    assert math.degrees(tilt) == pytest.approx(86.0, abs=0.1)
    mechanism = build(WRIST)
    mechanism.start_at(tilted(tilt - NEAR))
    assert 0.0 < mechanism.firmness < 0.02
    for aside in (-0.1, 0.1):
        mechanism.start_at(tilted(tilt + aside))
        assert mechanism.firmness > 0.05


def test_our_margin_does_not_see_it():
    positions = tilted(lock())
    assert min(limit.remaining for limit in WRIST.clearances(positions)) > 0.2


@pytest.mark.parametrize('degrees', [-60.0, -30.0, 0.0, 30.0, 60.0, 80.0, 92.0, 100.0])
def test_on_both_sides_of_it_the_plate_can_mirror_the_base(degrees):
    positions = tilted(math.radians(degrees))
    mechanism = build(WRIST)
    mechanism.start_at(positions)
    assert mechanism.hand_pose.position == pytest.approx(
        WRIST.forward(positions).position, abs=1e-9
    )
    assert mechanism.settle()
    assert mechanism.hand_pose.position == pytest.approx(
        WRIST.forward(positions).position, abs=1e-9
    )


def test_near_it_a_push_turns_the_hand_away_from_the_mirror():
    gave_way = []
    for tilt in (math.radians(60.0), lock() - NEAR):
        mechanism = build(WRIST)
        mechanism.start_at(tilted(tilt))
        mechanism.push((0.0, 0.0, 0.0), (0.01, 0.01, 0.01))
        assert mechanism.settle()
        mirrored = WRIST.forward(mechanism.positions.tolist())
        gave_way.append(np.max(np.abs(mechanism.hand_pose.rotation - mirrored.rotation)))
    assert gave_way[1] > 100.0 * gave_way[0]
