"""What platforms on six rods share: how readings are judged, and the turn of a twist."""

import math

import pytest

from wrist_control import InvalidValueError, make_wrist
from wrist_control.rotations import Pose, turned
from wrist_control.stewart.geometry import anchors
from wrist_control.wrists.platform import turn_of

PLATFORMS = {name: make_wrist(name) for name in ('stewart', 'rotary_stewart')}
every_platform = pytest.mark.parametrize('wrist', PLATFORMS.values(), ids=PLATFORMS)


@every_platform
def test_positions_come_back_as_they_were_read(wrist):
    """A reading is held exactly: the pose goes with it, and no search moves it."""
    home = wrist.home.pose
    pose = Pose(turned(home.quaternion, (0.05, -0.1, 0.02), 1.0), home.position)
    positions = tuple(wrist.assembly_at(pose))
    found = wrist.resolve_assembly(positions, home)
    assert tuple(found) == pytest.approx(positions, abs=1e-14)
    assert found.pose.position == pytest.approx(pose.position, abs=1e-13)
    assert found.levers == pytest.approx(wrist.assembly_at(pose).levers, abs=1e-12)


@every_platform
def test_a_joint_moves_its_rods_end_no_further_than_reach(wrist):
    assert 0.9 < max(map(abs, wrist.home.levers)) / wrist.reach <= 1.0


@pytest.mark.parametrize(
    ('name', 'value', 'says'),
    [
        ('stewart', -0.1, 'The length of leg_2 is -0.1; it must be finite and above 0 m'),
        ('stewart', math.inf, 'The length of leg_2 is inf'),
        ('rotary_stewart', math.nan, r'The angle of servo_2 is nan; it must be finite\.'),
    ],
)
def test_readings_that_cannot_be_are_named(name, value, says):
    wrist = PLATFORMS[name]
    readings = [*wrist.home]
    wrist.check_readings(readings)
    readings[1] = value
    with pytest.raises(InvalidValueError, match=says):
        wrist.check_readings(readings)


def test_an_angle_may_be_zero_or_below():
    PLATFORMS['rotary_stewart'].check_readings([0.0, -3.0, 0.0, 0.0, 0.0, 0.0])


def test_given_points_stand_for_the_ring():
    ring = anchors('base_anchors', None, 0.3, 0.2)
    assert anchors('base_anchors', [x for p in ring for x in p], 9.0, 9.0) == ring


def test_a_twist_that_does_not_turn_has_the_platforms_normal():
    assert turn_of((1.0, 2.0, 3.0, 0.0, 0.0, 0.0)) == (0.0, 0.0, 1.0)
    assert turn_of((0.0, 0.0, 0.0, 3.0, 0.0, -4.0)) == (0.6, 0.0, -0.8)
