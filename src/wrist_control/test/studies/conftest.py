"""What the studies of pointing are measured by."""

import math

import numpy as np
import pytest


@pytest.fixture(scope='session')
def direction():
    """Give the azimuth and the tilt that a wrist's joints point the hand's z axis at."""

    def pointed(wrist, positions):
        x, y, z = wrist.forward(tuple(positions)).rotation[2]
        return np.array([math.atan2(y, x), math.acos(z)])

    return pointed
