"""What the studies of pointing are measured by, and what is read from their pictures."""

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


@pytest.fixture(scope='session')
def curves():
    """Give the curves of a panel that are named in its legend, (x, y) by name."""

    def named(axes):
        lines = [line for line in axes.get_lines() if not line.get_label().startswith('_')]
        return {line.get_label(): line.get_data() for line in lines}

    return named
