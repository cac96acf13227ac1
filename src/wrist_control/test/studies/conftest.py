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


@pytest.fixture(scope='session')
def uncovered():
    """Check that no legend of a figure lies on a curve, and that nothing of it is cut off."""

    def checked(figure):
        figure.draw_without_rendering()
        legends = [*figure.legends, *(axes.get_legend() for axes in figure.axes)]
        boxes = [legend.get_window_extent() for legend in legends if legend]
        assert boxes
        for box in boxes:
            assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1
            assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1
            for line in (line for axes in figure.axes for line in axes.get_lines()):
                path = line.get_transform().transform_path(line.get_path())
                assert not path.intersects_bbox(box, filled=False), line.get_label()

    return checked
