"""What is drawn of joints in series: their real places, seen also where all are in one point."""

import math

import numpy as np
import pytest

from wrist_control.wrists.body import Rod

from .robots import SHIPPED, shipped, wrist_of

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


@pytest.mark.parametrize('name', SHIPPED)
def test_there_is_a_body_between_every_two_joints_named_after_the_outer_one(name):
    wrist = shipped(name)
    names = [body.name for body in wrist.bodies(wrist.home)]
    between = [f'{joint.name}_link' for joint in wrist.joints[:-1]]
    assert names == ['forearm', *between, 'hand']


def test_rods_lead_from_joint_to_joint_where_these_are():
    wrist = shipped('ur5e')
    first, second, *_ = wrist.bodies(wrist.home)
    lengths = [
        [math.dist(rod.begin, rod.end) for rod in body.shapes if isinstance(rod, Rod)]
        for body in (first, second)
    ]
    assert any(length == pytest.approx(math.hypot(0.3922, 0.1333)) for length in lengths[0])
    assert any(length == pytest.approx(0.0997) for length in lengths[1])


def test_axes_that_meet_in_one_point_are_drums_across_each_other():
    bodies = wrist_of((Z, Y, X)).bodies((0.0, 0.0, 0.0))
    drums = [body.shapes[0] for body in bodies[:-1]]
    along = [np.subtract(drum.end, drum.begin) for drum in drums]
    assert [len(body.shapes) for body in bodies[:-1]] == [1, 1, 1]
    for drum, axis in zip(along, (Z, Y, X), strict=True):
        assert np.linalg.norm(drum) > 0.05
        np.testing.assert_allclose(drum / np.linalg.norm(drum), axis, atol=1e-12)
    assert drums[0].radius > drums[1].radius > drums[2].radius
