"""Six legs at a time: how far one solve goes, and what its proof calls a distance."""

import math

import numpy as np
import pytest

from wrist_control.rotations import Pose, turned
from wrist_control.stewart import general, stages

from .platforms import CROOKED, HOME, SIZE, WRIST, lengths_of, random_poses

KNOWN = general.scaled(WRIST.platform, WRIST.base, SIZE)
AXES = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]


def solved_home(axis, turn):
    """Return what leads home from where the platform is turned about an axis by so much, rad."""
    start = Pose(turned(HOME.quaternion, axis, turn), HOME.position)
    return general.solve_general(
        KNOWN, general.squares(KNOWN, lengths_of(HOME)), stages.unknowns(start, SIZE)
    )


@pytest.mark.parametrize('axis', AXES)
@pytest.mark.parametrize('side', [-1.0, 1.0])
def test_a_step_of_more_than_the_size_or_a_radian_is_left_to_stages(axis, side):
    """Each is one turn alone: the five other parts of the step are small."""
    assert solved_home(axis, 0.5 * side).at == pytest.approx(stages.unknowns(HOME, SIZE), abs=1e-9)
    assert solved_home(axis, 0.8 * side) is None


@pytest.mark.parametrize('wrist', [WRIST, CROOKED], ids=['planar', 'crooked'])
def test_a_distance_is_that_of_the_place_and_of_all_three_axes(wrist):
    size = wrist.size
    for one, other in zip(random_poses(5, 0.1, 1.0), random_poses(5, 0.1, 1.0, 1), strict=True):
        place = math.dist(one.position, other.position) / size
        axes = float(np.linalg.norm(one.rotation - other.rotation))
        found = general._distance(stages.unknowns(one, size), stages.unknowns(other, size))
        assert found == pytest.approx(math.hypot(place, axes), rel=1e-12)
