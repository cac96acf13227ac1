"""Where a search starts from: everywhere, and nowhere twice."""

import math

import numpy as np

from wrist_control.stewart import assembly

from .platforms import HOME


def test_no_pose_is_searched_from_twice():
    starts = assembly.seeds(HOME)
    assert len({(one.quaternion, one.position) for one in starts}) == len(starts) == 24 * 33


def test_no_place_of_the_grid_is_searched_from_twice_and_it_is_even_in_angle():
    u1, u2, v2 = assembly.planar_seeds()[[2, 4, 5]]
    assert len({*zip(u1, u2, v2, strict=True)}) == len(u1)
    step = math.pi / assembly.GRID
    for values in (u1, u2, v2):
        angles = np.arcsin(np.unique(values))
        assert len(angles) == assembly.GRID
        np.testing.assert_allclose(np.diff(angles), step, atol=1e-12)
        np.testing.assert_allclose(angles[[0, -1]], 0.5 * (math.pi - step) * np.array([-1, 1]))
