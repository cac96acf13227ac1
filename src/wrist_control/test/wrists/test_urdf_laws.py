"""Every law of wrists, over robots that there are and over axes that nobody would build."""

import numpy as np
import pytest

from wrist_control.testing import LAWS

from .robots import FOLDER, SHIPPED, make_wrist, random_robot, shipped, wrist_of

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
UR5E = (FOLDER / 'ur5e.urdf').read_text()
ROBOTS = {
    'ur5e calibrated': lambda: make_wrist(
        'urdf', description=UR5E.replace('"1.570796327', '"1.5715'), tip='tool0'
    ),
    'camera that looks down': lambda: wrist_of((Z, Y), tip_rpy=(0.0, 0.3, 0.0)),
    'pointer with oblique axes': lambda: wrist_of((Z, (0.3, 1.0, 0.2)), tip_rpy=(0.1, 0.2, 0.3)),
    'first joint spare': lambda: wrist_of(((0.5, 0.5, 0.5), Z, Y, X)),
    'any four': lambda: random_robot(np.random.default_rng(11), 4),
}


@pytest.mark.parametrize('law', LAWS)
@pytest.mark.parametrize('name', SHIPPED)
def test_the_wrists_of_shipped_robots_keep_every_law(name, law):
    LAWS[law](shipped(name), np.random.default_rng(1))


@pytest.mark.parametrize('law', LAWS)
@pytest.mark.parametrize('name', ROBOTS)
def test_wrists_with_any_axes_keep_every_law(name, law):
    LAWS[law](ROBOTS[name](), np.random.default_rng(1))
