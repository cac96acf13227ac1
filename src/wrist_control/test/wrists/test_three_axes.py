"""Three turns about any axes, against SciPy's rotations and against looking everywhere."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from wrist_control import errors
from wrist_control.rotations import Pose, about, from_xyzw, product
from wrist_control.wrists.three_axes import (
    AGAINST,
    ALONG,
    SEAM,
    ThreeAxes,
    angle_between,
    turn_about,
)

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def unit(vector):
    x, y, z = np.array(vector) / np.linalg.norm(vector)
    return (float(x), float(y), float(z))


def bent(alpha, beta, twist=0.0):
    """Return three axes that are α and β apart."""
    third = Rotation.from_rotvec([0.0, beta, 0.0]).apply(Z)
    first = Rotation.from_euler('zy', [twist, alpha]).apply(Z)
    return ThreeAxes(unit(first), Z, unit(third))


def turned(axes, turns):
    """Return the rotation that three turns make, by SciPy."""
    rows = (axes.first, axes.second, axes.third)
    every = [Rotation.from_rotvec(turn * np.array(a)) for a, turn in zip(rows, turns, strict=True)]
    return from_xyzw(tuple((every[0] * every[1] * every[2]).as_quat().tolist()))


def apart(one, other):
    """Return how far two quaternions' rotations are from each other, entry by entry."""
    return float(np.abs(Pose(one).rotation - Pose(other).rotation).max())


def cases(count=400):
    random = np.random.default_rng(3)
    while count:
        axes = ThreeAxes(*(unit(v) for v in random.normal(size=(3, 3))))
        if axes.amplitude > 0.1:
            count -= 1
            yield axes, random.uniform(-7.0, 7.0, 3), random


def test_the_turns_of_a_rotation_make_it_again_to_the_last_digits():
    for axes, turns, random in cases():
        rotation = turned(axes, turns)
        found = axes.turns(rotation, random.uniform(-7.0, 7.0, 3))
        assert apart(turned(axes, found), rotation) < 1e-13


def test_the_branch_and_the_whole_turns_are_those_of_near():
    for axes, turns, random in cases():
        if abs(math.sin(turns[1] - axes.lock)) > 0.05:
            near = turns + random.uniform(-1e-3, 1e-3, 3)
            found = axes.turns(turned(axes, turns), near)
            np.testing.assert_allclose(found, turns, atol=1e-12)


def test_of_both_branches_the_nearer_is_taken():
    for axes, turns, random in cases():
        rotation = turned(axes, turns)
        found = axes.turns(rotation, turns)
        other = 2.0 * axes.lock - found[1]
        beside = [axes.turns(rotation, (a, other, c)) for a in (0, 2, 4) for c in (0, 2, 4)]
        near = random.uniform(-3.0, 3.0, 3)
        best = axes.turns(rotation, near)
        for branch in (found, *beside):
            whole = [
                x - math.tau * round((x - n) / math.tau) for x, n in zip(branch, near, strict=True)
            ]
            assert (
                sum(np.abs(np.subtract(best, near)))
                <= sum(np.abs(np.subtract(whole, near))) + 2e-6
            )


def test_lock_is_where_the_axes_lie_in_a_plane():
    for axes, _, _ in cases(50):
        for second in (axes.lock, axes.lock + math.pi):
            third = Pose(about(axes.second, second)).point(axes.third)
            assert abs(np.linalg.det([axes.first, axes.second, third])) < 1e-12


@pytest.mark.parametrize(
    ('alpha', 'beta', 'along', 'against'),
    [(90, 90, 0, 0), (60, 60, 0, 60), (90, 50, 40, 40), (120, 80, 40, 20), (130, 130, 0, 80)],
)
def test_what_cannot_be_reached_is_what_no_second_turn_reaches(alpha, beta, along, against):
    axes = bent(math.radians(alpha), math.radians(beta), 0.4)
    ends = [math.degrees(end.beyond) for end in axes.ends]
    assert ends == pytest.approx([along, against], abs=1e-9)
    everywhere = [
        Pose(about(Z, t)).point(axes.third) for t in np.linspace(-math.pi, math.pi, 2001)
    ]
    angles = [math.degrees(angle_between(axes.first, third)) for third in everywhere]
    assert min(angles) == pytest.approx(along, abs=0.2)
    assert 180.0 - max(angles) == pytest.approx(against, abs=0.2)


@pytest.mark.parametrize(('angle', 'end'), [(39.9, ALONG), (140.1, AGAINST)])
def test_beyond_an_end_the_region_is_named_and_just_before_it_is_reached(angle, end):
    axes = bent(math.radians(90), math.radians(50))

    def aim(degrees):
        side = unit(np.cross(axes.first, (0.3, 0.4, 0.5)))
        toward = Pose(about(side, math.radians(degrees))).point(axes.first)
        return turn_to(axes.third, toward)

    with pytest.raises(errors.UnreachableError, match='leaves a cone of 40° out') as refused:
        axes.turns(aim(angle), (0.0, 0.0, 0.0))
    assert refused.value.limit == end
    inside = aim(angle + math.copysign(0.2, 90.0 - angle))
    assert apart(turned(axes, axes.turns(inside, (0.0, 0.0, 0.0))), inside) < 1e-12


def turn_to(one, other):
    """Return a rotation that takes a vector to another, and some roll."""
    turn = about(unit(np.cross(one, other)), angle_between(one, other))
    return product(turn, about(one, 0.7))


def test_axes_that_are_square_to_each_other_reach_everything_and_keep_the_third_turn_at_lock():
    axes = ThreeAxes(X, Y, X)
    found = axes.turns(turned(axes, (0.4, 0.0, 0.3)), (1.0, 0.1, 0.2))
    assert found == pytest.approx((0.5, 0.0, 0.2), abs=1e-12)


@pytest.mark.parametrize('off', [1e-10, 4e-6, 9e-4, 1.9e-3])
def test_a_seam_is_passed_with_the_hand_no_further_off_than_it_is_wide(off):
    """Axes are never square to the last digit."""
    axes = bent(0.5 * math.pi - off, 0.5 * math.pi)
    assert max(end.beyond for end in axes.ends) == pytest.approx(off, abs=1e-12)
    assert off < SEAM
    assert axes.distances(axes.lock) == []
    near = (0.2, axes.lock - 0.1, 0.3)
    for inside in np.linspace(-5.0, 5.0, 41) * off:
        tilted = about(unit(np.cross(axes.first, axes.second)), inside)
        aim = product(product(tilted, turn_to(axes.third, axes.first)), about(axes.third, 0.3))
        found = axes.turns(aim, near)
        assert apart(turned(axes, found), aim) < 3.0 * off + 1e-9


def test_what_is_wider_than_a_seam_is_an_end():
    axes = bent(0.5 * math.pi - 1.05 * SEAM, 0.5 * math.pi)
    assert [name for name, _ in axes.distances(0.0)] == [ALONG, AGAINST]


@pytest.mark.parametrize('beside', [1e-3, 1e-5, 1e-7])
def test_close_to_lock_the_turns_are_still_those_of_the_rotation(beside):
    for axes in (ThreeAxes(X, Y, X), ThreeAxes(Z, Y, X), bent(1.0, 1.0, 0.3)):
        rotation = turned(axes, (0.4, axes.lock + beside, 0.3))
        found = axes.turns(rotation, (0.5, axes.lock, 0.2))
        assert apart(turned(axes, found), rotation) < 1e-14


def test_the_distance_to_an_end_is_0_there_and_1_at_the_other():
    axes = bent(math.radians(90), math.radians(50))
    assert axes.distances(axes.lock) == [(ALONG, 0.0), (AGAINST, 1.0)]
    ((name, far),) = bent(math.radians(60), math.radians(60)).distances(0.3)
    assert name == AGAINST
    assert 0.0 < far < 1.0


def test_a_turn_is_seen_from_what_it_does_to_a_vector():
    axis, before = unit((1.0, 2.0, 3.0)), (0.3, -0.4, 0.5)
    for turn in (-3.0, -0.2, 1e-9, 2.0):
        after = Rotation.from_rotvec(turn * np.array(axis)).apply(before)
        assert turn_about(axis, before, tuple(after)) == pytest.approx(turn, abs=1e-14)


def test_small_angles_are_told_to_the_last_digit():
    assert angle_between(X, (math.cos(1e-9), math.sin(1e-9), 0.0)) == pytest.approx(
        1e-9, rel=1e-12
    )
    assert angle_between(X, (-1.0, 0.0, 0.0)) == math.pi
