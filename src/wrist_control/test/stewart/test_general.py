"""Six legs at a time: how far one solve goes, and what its proof calls a distance."""

import math

import numpy as np
import pytest

from wrist_control.rotations import Pose, turned
from wrist_control.stewart import general, stages
from wrist_control.stewart.certificate import ROUNDING, kantorovich
from wrist_control.stewart.geometry import legs

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


def test_a_last_step_leaves_what_its_proof_says():
    """(S15), from so far off that its square shows beside rounding."""
    rng, used = np.random.default_rng(0), []
    for pose in random_poses(100, 0.1, 0.8):
        root = Pose(pose.quaternion, tuple(x / SIZE for x in pose.position))
        goal = general.squares_at(KNOWN, stages.unknowns(root, 1.0))
        reach = 10.0 ** rng.uniform(-5.0, -2.0)
        rates, shift = reach * rng.normal(size=(2, 3))
        origin = Pose(turned(root.quaternion, tuple(rates), 1.0), tuple(root.position + shift))
        vectors = legs(KNOWN.platform, KNOWN.base, origin)
        missing = np.subtract(goal, (np.array(vectors) ** 2).sum(axis=1))
        here = general.linearised(KNOWN, vectors)
        twist = (here.inverse @ missing).tolist()
        proof = kantorovich(here.beta, general.size_of(twist))
        floor = ROUNDING * (1.0 + max(goal))
        after = general.after_step(here, proof, general.size_of(twist), floor)
        if math.isfinite(after.error):
            end = stages.unknowns(general._moved(origin, twist), 1.0)
            used.append(general._distance(end, stages.unknowns(root, 1.0)) / after.error)
            moved = general._distance(end, stages.unknowns(origin, 1.0))
            assert proof.unique - after.unique > 0.0
            assert moved <= proof.unique - after.unique
    assert len(used) > 80
    assert 0.05 < max(used) <= 1.0
