"""The edge of reach that a page draws, against what each wrist says of itself."""

import math

import numpy as np
import pytest

pytest.importorskip('nicegui', reason='the console needs the extra `console`')

from wrist_control import WRISTS, make_wrist
from wrist_control.web.reach import ANGLES, HEADINGS, edge_of_reach

STEP = ANGLES[1]


def tilt(wrist, tip):
    """Return how far a tip is tilted from where the probe points at home, rad."""
    pose = wrist.forward(wrist.home)
    along = np.array(pose.point(wrist.probe)) - pose.position
    way = np.array(tip) - pose.position
    return math.acos(way @ along / np.linalg.norm(way) / np.linalg.norm(along))


@pytest.mark.parametrize('name', ['three_gimbal', 'four_gimbal', 'roll_pitch_roll'])
def test_a_wrist_without_an_edge_shows_none(name):
    assert edge_of_reach(make_wrist(name)) == ()


def test_a_cone_is_shown_all_round_at_its_half_angle():
    wrist = make_wrist('single_hooke')
    edge = edge_of_reach(wrist)
    assert len(edge) == HEADINGS
    for tip in edge:
        assert -1e-9 <= wrist.cone_half_angle - tilt(wrist, tip) <= STEP + 1e-9


@pytest.mark.parametrize('name', ['double_hooke', 'omni_wrist'])
def test_two_joints_in_a_row_bend_the_hand_twice_as_far_as_the_shaft_between(name):
    wrist = make_wrist(name)
    half, length = wrist.cone_half_angle, wrist.shaft_length
    reach = math.hypot(*wrist.probe)
    edge = edge_of_reach(wrist)
    assert len(edge) == HEADINGS
    for x, y, z in edge:
        along = length * math.cos(half) + reach * math.cos(2.0 * half)
        aside = length * math.sin(half) + reach * math.sin(2.0 * half)
        assert (x, math.hypot(y, z)) == pytest.approx((along, aside), abs=STEP * (length + reach))


@pytest.mark.parametrize('name', WRISTS)
def test_every_wrist_has_an_answer_and_points_on_it_are_where_its_probe_can_be(name):
    wrist = make_wrist(name)
    assert all(math.isfinite(part) for tip in edge_of_reach(wrist) for part in tip)


def test_a_joint_that_ends_is_an_edge_too():
    wrist = make_wrist('three_gimbal').with_limits(lower=-0.5, upper=0.5)
    edge = edge_of_reach(wrist)
    assert edge
    assert min(tilt(wrist, tip) for tip in edge) == pytest.approx(0.5, abs=STEP)
