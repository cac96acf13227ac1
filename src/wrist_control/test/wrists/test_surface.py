"""Surfaces of shapes: closed, in the right place, and looking outwards."""

import math

import numpy as np
import pytest

from wrist_control.rotations import Pose, about_z
from wrist_control.wrists.body import Arc, Ball, Plate, Rod
from wrist_control.wrists.surface import SIDES, placed, triangles

# Area of a polygon of SIDES corners in a circle of radius 1.
POLYGON = 0.5 * SIDES * math.sin(math.tau / SIDES)
ROD = Rod((0.1, 0.2, 0.3), (0.1, -0.4, 0.3), 0.02)
RING = Arc((0.0, 0.1, 0.0), (0.2, 0.0, 0.0), (0.0, 0.0, 1.0), math.tau, 0.01)
QUARTER = Arc((0.0, 0.0, 0.0), (0.0, 0.0, 0.2), (1.0, 0.0, 0.0), 0.5 * math.pi, 0.01)
BALL = Ball((0.3, 0.0, 0.0), 0.05)
PLATE = Plate(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0)), 0.1)


def volume(surface):
    """Return what a closed surface holds, outside anticlockwise: Gauss."""
    return float(np.einsum('ni,ni->', surface[:, 0], np.cross(surface[:, 1], surface[:, 2]))) / 6.0


@pytest.mark.parametrize(
    ('shape', 'expected', 'tolerance'),
    [
        (ROD, 0.6 * POLYGON * 0.02**2, 1e-9),
        (RING, math.tau * 0.2 * POLYGON * 0.01**2, 0.01),
        (QUARTER, 0.25 * math.tau * 0.2 * POLYGON * 0.01**2, 0.01),
        (BALL, 4.0 / 3.0 * math.pi * 0.05**3, 0.2),
        (PLATE, 2.0 * 0.1, 1e-9),
    ],
)
def test_a_surface_is_closed_and_looks_outwards(shape, expected, tolerance):
    assert volume(triangles(shape)) == pytest.approx(expected, rel=tolerance)


def test_an_arc_ends_where_its_angle_says():
    ends = triangles(QUARTER).reshape(-1, 3)
    far = ends[np.argsort(np.linalg.norm(ends - [0.0, -0.2, 0.0], axis=1))[0]]
    np.testing.assert_allclose(far, [0.0, -0.2, 0.0], atol=1e-12)


def test_points_are_placed_as_a_pose_places_them():
    pose = Pose(about_z(0.4), (0.1, 0.2, 0.3))
    point = (0.5, -0.6, 0.7)
    np.testing.assert_allclose(placed(np.array(point), pose), pose.point(point), atol=1e-15)
