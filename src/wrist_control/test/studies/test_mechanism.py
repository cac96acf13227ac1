"""Pictures of mechanisms: closed surfaces, in the right place, the nearest drawn last."""

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from wrist_control import WRISTS, make_wrist
from wrist_control.rotations import IDENTITY, Pose
from wrist_control.studies.mechanism import draw, seen, window
from wrist_control.wrists import body
from wrist_control.wrists.body import FOREARM, HAND, Ball, Body, colours

BALL = Ball((0.3, 0.0, 0.0), 0.05)


def test_the_picture_keeps_lengths_and_hands():
    axes = seen(np.eye(3))
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[2, 0] == pytest.approx(0.0)  # up is up
    assert axes[2, 1] > 0.8
    assert axes[0, 0] > 0.7  # and x goes to the right


def test_what_is_nearer_is_drawn_later():
    near, far = (
        Body(name, Pose(IDENTITY, tuple(0.5 * sign * seen(np.eye(3))[:, 2])), (BALL,))
        for name, sign in (('forearm', 1.0), ('hand', -1.0))
    )
    drawn = draw(Figure().add_subplot(), (near, far))
    hues = drawn.get_facecolor()[:, :3]

    def is_of(hue, colour):
        return np.allclose(hue / hue.max(), np.array(to_rgb(colour)) / max(to_rgb(colour)))

    order = [is_of(hue, FOREARM) for hue in hues]
    assert order == sorted(order)
    assert any(order)
    assert not all(order)


@pytest.mark.parametrize('name', WRISTS)
def test_every_body_is_in_the_picture(name):
    wrist = make_wrist(name)
    bodies = wrist.bodies(wrist.home)
    figure = Figure()
    axes = figure.add_subplot()
    drawn = draw(axes, bodies)
    hues = drawn.get_facecolor()[:, :3]
    hues = hues / hues.max(axis=1)[:, None]
    for colour in colours(bodies):
        expected = np.array(to_rgb(colour)) / max(to_rgb(colour))
        assert np.isclose(hues, expected).all(axis=1).any(), colour
    corners = np.concatenate([path.vertices for path in drawn.get_paths()])
    left, right, bottom, top = window([bodies])
    assert np.isfinite(corners).all()
    assert left < corners[:, 0].min() < corners[:, 0].max() < right
    assert bottom < corners[:, 1].min() < corners[:, 1].max() < top
    assert right - left == pytest.approx(top - bottom)


def test_the_two_links_of_a_leg_have_one_colour_and_the_legs_have_three():
    wrist = make_wrist('carpal')
    found = dict(
        zip(
            (b.name for b in wrist.bodies(wrist.home)),
            colours(wrist.bodies(wrist.home)),
            strict=True,
        )
    )
    assert found['forearm'] == FOREARM
    assert found['hand'] == HAND
    for leg in (1, 2, 3):
        assert found[f'lower_leg_{leg}'] == found[f'upper_leg_{leg}']
    assert len(set(found.values())) == 5


def test_the_trail_is_drawn_where_the_tip_was():
    wrist = make_wrist('three_gimbal')
    axes = Figure().add_subplot()
    trail = np.array([body.ALONG_X, (0.1, 0.1, 0.0), (0.0, 0.15, 0.0)])
    draw(axes, wrist.bodies(wrist.home), trail)
    (line,) = axes.lines
    np.testing.assert_allclose(np.column_stack(line.get_data()), seen(trail)[:, :2])
