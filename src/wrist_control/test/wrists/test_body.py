"""The shapes that wrists are drawn with, and the drawing that a new wrist gets for nothing."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import WRISTS, make_wrist
from wrist_control.rotations import Pose, about_z, to_forearm
from wrist_control.testing.seen import SEEN
from wrist_control.wrists import body, wrist_class

component = st.floats(-1.0, 1.0)


@given(x=component, y=component, z=component)
def test_the_shortest_turn_takes_the_z_axis_to_a_direction(x, y, z):
    length = math.hypot(x, y, z)
    if length < 1e-6:
        return
    quaternion = body.turn_of_z((x, y, z))
    direction = np.array([x, y, z]) / length
    np.testing.assert_allclose(to_forearm(quaternion, body.Z), direction, atol=1e-8)
    if z > -0.999 * length:
        assert 2.0 * math.acos(min(1.0, quaternion[0])) == pytest.approx(
            math.acos(z / length), abs=1e-6
        )


@pytest.mark.parametrize('direction', [(0.0, 0.0, -2.0), (1e-12, 0.0, -1.0)])
def test_straight_down_is_a_turn_as_well(direction):
    assert to_forearm(body.turn_of_z(direction), body.Z) == pytest.approx((0.0, 0.0, -1.0))


def test_a_yoke_runs_over_its_middle_to_its_opposite():
    arc = body.yoke((0.0, 0.0, 0.2), body.BACK)
    begin, axis = np.array(arc.begin), np.array(arc.axis)

    def at(angle):
        return math.cos(angle) * begin + math.sin(angle) * np.cross(axis, begin)

    np.testing.assert_allclose(at(0.5 * arc.angle), [-0.2, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(at(arc.angle), [0.0, 0.0, -0.2], atol=1e-15)


def test_a_frame_goes_around_its_points_in_any_order():
    corners = [(1.0, 0.0, 0.1), (-1.0, 0.0, 0.3), (0.0, 1.0, 0.2), (0.0, -1.0, 0.0)]
    shapes = body.frame(corners, 0.01)
    rods = [shape for shape in shapes if isinstance(shape, body.Rod)]
    assert all(math.dist(rod.begin, rod.end) < 1.5 for rod in rods)  # none goes across
    assert {rod.begin for rod in rods} == {rod.end for rod in rods} == set(corners)
    assert {ball.centre for ball in shapes if isinstance(ball, body.Ball)} == set(corners)


CORNERS = np.array([[0.2, 0.0, 0.0], [-0.1, 0.17, 0.0], [-0.1, -0.17, 0.0]])
THREE_CORNERS = CORNERS[[0, 1, 1, 2, 2, 0]]
OTHERS = {
    'double_hooke': {'shaft_length': 0.02},
    'omni_wrist': {'shaft_length': 1.0},
    'carpal': {'base_radius': 0.2, 'leg_length': 0.15, 'plunge': 0.03},
    'stewart': {'platform_anchors': THREE_CORNERS.ravel().tolist()},
}


@pytest.mark.parametrize('name', OTHERS)
def test_wrists_of_other_dimensions_are_drawn_as_well(name):
    """A platform whose anchors coincide in pairs has no bars between those."""
    wrist = make_wrist(name, **OTHERS[name])
    for law in SEEN:
        law(wrist, np.random.default_rng(1))
    for seen in wrist.bodies(wrist.home):
        for shape in seen.shapes:
            if isinstance(shape, body.Rod):
                assert math.dist(shape.begin, shape.end) > 0.0


def test_a_hand_points_along_its_probe_and_its_thumb_shows_its_roll():
    pose = Pose(about_z(0.3), (0.1, 0.0, 0.0))
    for probe, thumb in ((body.ALONG_X, 2), (body.ALONG_Z, 0)):
        palm, bar, finger, tip = body.hand(pose, (), probe=probe, palm=0.02).shapes
        assert tip.centre == bar.end == probe
        assert math.hypot(*bar.begin) == pytest.approx(0.02)
        np.testing.assert_allclose(np.cross(bar.begin, probe), 0.0, atol=1e-15)
        np.testing.assert_allclose(np.add(palm.begin, palm.end) / 2.0, bar.begin, atol=1e-15)
        assert np.flatnonzero(np.subtract(finger.end, finger.begin)).tolist() == [thumb]


@pytest.mark.parametrize('name', WRISTS)
def test_the_forearm_stands_behind_the_hand_of_home(name):
    """Nothing of it lies further on than its bars are thick, along the probe."""
    wrist = make_wrist(name)
    forearm, *_ = wrist.bodies(wrist.home)
    along = np.array(wrist.probe) / np.linalg.norm(wrist.probe)
    for shape in forearm.shapes:
        if isinstance(shape, body.Rod):
            assert max(along @ shape.begin, along @ shape.end) <= 1e-12
        if isinstance(shape, body.Ball):
            assert along @ shape.centre <= 1e-12
        if isinstance(shape, body.Arc):
            middle = math.cos(0.5 * shape.angle) * np.array(shape.begin) + math.sin(
                0.5 * shape.angle
            ) * np.cross(shape.axis, shape.begin)
            assert along @ middle <= 1e-12


def test_a_new_wrist_is_drawn_for_nothing():
    kind = wrist_class('carpal')
    plain = type('Plain', (kind,), {'bodies': kind.__mro__[1].bodies})()
    for law in SEEN:
        law(plain, np.random.default_rng(1))
    pose = plain.forward(plain.home)
    assert [seen.name for seen in plain.bodies(plain.home)] == ['forearm', 'hand']
    assert plain.bodies(plain.home)[-1].pose == pose


def test_a_point_of_a_body_is_found_in_the_forearm():
    pose = Pose(about_z(0.5 * math.pi), (1.0, 2.0, 3.0))
    assert pose.point((1.0, 0.0, 0.5)) == pytest.approx((1.0, 3.0, 3.5))
