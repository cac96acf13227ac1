"""One joint of a URDF, read from its element alone."""

import math
from xml.etree import ElementTree

import pytest
from scipy.spatial.transform import Rotation

from wrist_control import InvalidValueError
from wrist_control.wrists.urdf_joint import axis_of, kind_of, limited_joint, link_of, origin_of

from .robots import LIMIT, joint


def read(inside='', kind='revolute'):
    return ElementTree.fromstring(joint('one', 'a', 'b', kind, inside))


def test_its_kind_and_its_links_are_those_that_are_said():
    one = read()
    assert (kind_of(one), link_of(one, 'parent'), link_of(one, 'child')) == ('revolute', 'a', 'b')


def test_its_origin_is_turned_about_fixed_x_y_and_z_in_this_order():
    pose = origin_of(read('<origin xyz="1 2 3" rpy="0.3 -0.4 0.5"/>'))
    turned = Rotation.from_euler('xyz', (0.3, -0.4, 0.5))
    assert pose.rotation == pytest.approx(turned.as_matrix().T, abs=1e-15)
    assert pose.position == (1.0, 2.0, 3.0)


@pytest.mark.parametrize('inside', ['', '<origin/>', '<origin rpy="0 0 0"/>'])
def test_an_origin_that_is_not_said_is_none(inside):
    pose = origin_of(read(inside))
    assert pose.position == (0.0, 0.0, 0.0)
    assert pose.xyzw == (0.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize('inside', ['', '<axis/>', '<axis xyz="3 0 0"/>'])
def test_its_axis_is_a_unit_vector_and_x_where_none_is_said(inside):
    assert axis_of(read(inside)) == (1.0, 0.0, 0.0)


def test_its_limits_are_those_of_the_joint_and_of_its_controller():
    soft = '<safety_controller soft_lower_limit="{}" soft_upper_limit="{}"/>'
    assert limited_joint(read(LIMIT))[2:5] == (-1.0, 2.0, 3.0)
    assert limited_joint(read(LIMIT + soft.format(-0.5, 2.5)))[2:5] == (-0.5, 2.0, 3.0)
    assert limited_joint(read(LIMIT + soft.format(-9.0, 1.5)))[2:5] == (-1.0, 1.5, 3.0)


def test_a_limit_that_is_not_said_is_0_as_the_format_has_it():
    assert limited_joint(read('<limit upper="1"/>'))[2:5] == (0.0, 1.0, math.inf)
    with pytest.raises(InvalidValueError, match='has the limits 0 to 0'):
        limited_joint(read('<limit/>'))


def test_a_continuous_joint_has_no_range_whatever_is_said():
    assert limited_joint(read(LIMIT, 'continuous'))[2:5] == (-math.inf, math.inf, 3.0)
