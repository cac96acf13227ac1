"""Close to lock, and between two branches: the joints are those of the pose all the same."""

import math

import numpy as np
import pytest

from wrist_control import make_wrist

RIGHT = 0.5 * math.pi


@pytest.mark.parametrize('near_lock', [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize('side', [-1.0, 1.0])
@pytest.mark.parametrize(
    ('name', 'locked'),
    [
        ('three_gimbal', (0.3, RIGHT, 0.2)),
        ('single_hooke', (0.3, RIGHT, 0.2)),
        ('double_hooke', (0.3, RIGHT, 0.2)),
        ('double_hooke', (0.3, 0.2, RIGHT)),
        ('omni_wrist', (0.3, RIGHT, 0.2)),
        ('omni_wrist', (0.3, 0.2, RIGHT)),
        ('roll_pitch_roll', (0.3, 0.0, 0.2)),
        ('four_gimbal', (0.3, RIGHT, 0.2, 0.1)),
    ],
)
def test_a_joint_that_was_elsewhere_is_found_although_lock_is_near(name, locked, near_lock, side):
    wrist = make_wrist(name)
    place = max(range(len(locked)), key=lambda joint: locked[joint]) if name[0] != 'r' else 1
    positions = tuple(x - side * near_lock * (j == place) for j, x in enumerate(locked))
    elsewhere = tuple(x + 0.05 * (joint < 3) for joint, x in enumerate(positions))
    found = wrist.inverse(wrist.forward(positions), elsewhere)
    np.testing.assert_allclose(found, positions, atol=1e-14 / near_lock**2 + 1e-12)


@pytest.mark.parametrize('side', [-1.0, 1.0])
@pytest.mark.parametrize(
    ('name', 'locked', 'spun'),
    [
        ('three_gimbal', (0.3, RIGHT, 0.2), 2),
        ('double_hooke', (0.3, RIGHT, 0.2), 0),
        ('omni_wrist', (0.3, RIGHT, 0.2), 0),
    ],
)
def test_the_joint_that_spins_at_lock_is_found_to_some_thousand_millionths_and_kept_from_there(
    name, locked, spun, side
):
    """Nearer, its quotient is round-off, which must not turn a joint."""
    wrist = make_wrist(name)
    for near_lock, found_there in ((3e-9, True), (3e-10, False)):
        positions = tuple(x - side * near_lock * (x == RIGHT) for x in locked)
        elsewhere = tuple(x + 0.05 * (joint == spun) for joint, x in enumerate(positions))
        angle = wrist.inverse(wrist.forward(positions), elsewhere)[spun]
        expected = positions if found_there else elsewhere
        assert angle == pytest.approx(expected[spun], abs=1e-5)


@pytest.mark.parametrize('side', [-1.0, 1.0])
@pytest.mark.parametrize(('beyond', 'other'), [(-0.01, False), (5e-7, False), (5e-6, True)])
def test_of_two_branches_the_nearer_in_phi_is_taken_and_of_a_tie_the_one_ahead(
    side, beyond, other
):
    wrist, positions = make_wrist('three_gimbal'), (0.2, 0.3, 0.4)
    near = (0.2, 0.3, 0.4 + side * (RIGHT + beyond))
    found = wrist.inverse(wrist.forward(positions), near)
    assert found[2] == pytest.approx(0.4 + side * math.pi * other)
    assert (math.cos(found[1]) < 0.0) is other
    np.testing.assert_allclose(
        wrist.forward(found).rotation, wrist.forward(positions).rotation, atol=1e-12
    )
