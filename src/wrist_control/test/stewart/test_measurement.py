"""Readings of leg lengths: what is refused, and what noise and rates mean for the platform."""

import math

import numpy as np
import pytest

from wrist_control import InvalidValueError, make_wrist
from wrist_control.rotations import IDENTITY, Pose, about_z, rates_between, turned
from wrist_control.stewart.measurement import (
    check_jump,
    check_possible,
    impossible_pair,
    platform_twist,
    pose_covariance,
)

from .platforms import said

WRIST = make_wrist('stewart')
NAMES = [joint.name for joint in WRIST.joints]
POSE = Pose(turned(IDENTITY, (0.3, -0.2, 0.4), 1.0), (0.03, -0.02, 0.45))


def test_covariance_is_that_of_poses_solved_from_noisy_lengths():
    rng = np.random.default_rng(0)
    lengths, sigma = WRIST.assembly_at(POSE), np.array([1, 2, 3, 4, 5, 6]) * 1e-5
    noisy = np.array(lengths) + sigma * rng.normal(size=(20000, 6))
    batch = WRIST.forward_kinematics.solve_batch(noisy, POSE)
    rows = zip(batch.quaternion.tolist(), batch.position.tolist(), strict=True)
    samples = np.array(
        [
            [
                *np.subtract(position, POSE.position),
                *POSE.rotation.T @ rates_between(POSE.quaternion, tuple(quaternion), 1.0),
            ]
            for quaternion, position in rows
        ]
    )
    expected = pose_covariance(lengths.lines, POSE, sigma)
    spread = np.sqrt(np.diag(expected))
    assert np.cov(samples.T) / np.outer(spread, spread) == pytest.approx(
        expected / np.outer(spread, spread), abs=0.05
    )


def test_one_noise_for_all_is_six_equal_ones():
    lines = WRIST.assembly_at(POSE).lines
    assert pose_covariance(lines, POSE, 1e-4) == pytest.approx(
        pose_covariance(lines, POSE, [1e-4] * 6)
    )


@pytest.mark.parametrize('noise', [-1e-4, math.nan, math.inf])
def test_noise_that_is_none_is_refused(noise):
    with pytest.raises(InvalidValueError, match='length_noise is'):
        pose_covariance(WRIST.assembly_at(POSE).lines, POSE, noise)


def test_the_twist_is_what_made_the_rates():
    lengths, twist = WRIST.assembly_at(POSE), (0.1, -0.2, 0.05, 0.3, 0.2, -0.4)
    assert platform_twist(lengths.lines, WRIST.rates(lengths, twist)) == pytest.approx(twist)


def test_lengths_do_not_tell_the_twist_at_lock():
    flat = WRIST.assembly_at(Pose(IDENTITY, (0.0, 0.0, 0.0)))
    with pytest.raises(InvalidValueError, match='at lock'):
        platform_twist(flat.lines, (0.0,) * 6)


def test_legs_that_contradict_each_other_are_named():
    lengths = (0.1, 0.5, 0.5, 0.5, 0.5, 2.5)
    with pytest.raises(InvalidValueError, match=r'leg_1 at 0\.1 m and leg_6 at 2\.5 m'):
        check_possible(WRIST.platform, WRIST.base, lengths, said(lengths))


def test_lengths_of_real_poses_never_contradict_each_other():
    rng = np.random.default_rng(1)
    for _ in range(500):
        pose = Pose(
            turned(IDENTITY, tuple(rng.uniform(-3, 3, 3)), 1.0), tuple(rng.uniform(-0.6, 0.6, 3))
        )
        assert impossible_pair(WRIST.platform, WRIST.base, WRIST.assembly_at(pose)) is None
    stretched = Pose(about_z(0.0), (5.0, 0.0, 0.0))
    assert impossible_pair(WRIST.platform, WRIST.base, WRIST.assembly_at(stretched)) is None


def test_two_legs_too_short_to_span_their_anchors_are_named():
    assert impossible_pair(WRIST.platform, WRIST.base, (0.01,) * 6) is not None


def test_a_jump_is_named():
    before = tuple(WRIST.home)
    after = (*before[:3], before[3] + 0.02, *before[4:])
    check_jump(after, before, 0.1, 0.25)
    with pytest.raises(InvalidValueError, match=r'leg_4 jumped by 0\.02 m in 0\.01 s'):
        check_jump(after, before, 0.01, 0.25)


def stretched(length):
    """Return lengths of legs 1 and 2 that the triangle inequality just allows."""
    apart = sum(math.dist(points[0], points[1]) for points in (WRIST.platform, WRIST.base))
    return [length + apart, length, *[length + 0.5 * apart] * 4]


@pytest.mark.parametrize('length', [0.3 + 1e-9 * (7 * k + 0.37 * k) for k in range(12)])
def test_readings_in_whole_nanometres_are_not_refused_for_their_last_digit(length):
    lengths = [round(x, 9) for x in stretched(length)]
    assert impossible_pair(WRIST.platform, WRIST.base, lengths) is None


def test_a_hundredth_of_a_micrometre_beyond_the_triangle_inequality_is_named():
    lengths = stretched(0.4)
    lengths[0] += 1e-8
    assert impossible_pair(WRIST.platform, WRIST.base, lengths) == (1, 2)
