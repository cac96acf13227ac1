"""What is read of a URDF."""

import math

import pytest
from scipy.spatial.transform import Rotation

from wrist_control import InvalidValueError
from wrist_control.rotations import Pose
from wrist_control.wrists.robot_description import serial_chain, text_of

from .robots import ABOUT_Y, ABOUT_Z, FOLDER, LIMIT, described, joint, robot, three


def test_the_last_three_joints_before_the_tip_are_found_and_what_is_before_does_not_count():
    chain = serial_chain((FOLDER / 'panda.urdf').read_text(), 'panda_link8')
    names = [one.joint.name for one in chain.driven]
    assert names == ['panda_joint5', 'panda_joint6', 'panda_joint7']
    assert chain.driven[0].origin == (-0.0825, 0.384, 0.0)
    assert chain.driven[1].joint[1:5] == ('revolute', -0.0175, 3.7525, 2.61)


def test_two_joints_are_found_where_there_are_no_more():
    chain = serial_chain((FOLDER / 'pan_tilt.urdf').read_text(), 'camera_optical')
    assert [one.joint.name for one in chain.driven] == ['pan', 'tilt']
    assert math.isinf(chain.driven[0].joint.upper)


def test_axes_are_of_unit_length_and_turned_with_every_origin_before_them():
    origins = ((0.1, 0.2, 0.3), (0.4, 0.5, 0.6), (0.7, 0.8, 0.9))
    rpys = ((0.3, -0.4, 0.5), (-1.0, 0.2, 2.0))
    text = robot(((0, 0, 3.0), (1.0, 1.0, 0.0)), (0.1, 0.2, 0.3), origins, rpys)
    first, second = serial_chain(text, 'tip').driven
    one, other = (Rotation.from_euler('xyz', rpy) for rpy in rpys)
    assert first.axis == pytest.approx(one.apply((0.0, 0.0, 1.0)), abs=1e-15)
    s = math.sqrt(0.5)
    assert second.axis == pytest.approx((one * other).apply((s, s, 0.0)), abs=1e-15)
    assert second.origin == pytest.approx(one.apply(origins[1]) + origins[0])
    tip = serial_chain(text, 'tip').tip
    turned = one * other * Rotation.from_euler('xyz', (0.1, 0.2, 0.3))
    assert tip.rotation == pytest.approx(turned.as_matrix().T)
    assert isinstance(tip, Pose)


def test_an_axis_that_is_not_said_is_x_and_an_origin_that_is_not_said_is_none():
    chain = serial_chain(
        described(joint('one', 'a', 'b'), joint('two', 'b', 'c', inside=ABOUT_Y)), 'c'
    )
    assert [one.axis for one in chain.driven] == [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
    assert chain.tip.position == (0.0, 0.0, 0.0)


def test_the_joint_that_others_mimic_is_like_any_other_and_one_before_the_wrist_does_no_harm():
    follower = joint('finger', 'd', 'e', inside='<mimic joint="three"/>')
    before = joint('rail', 'f', 'a', 'prismatic', LIMIT)
    chain = serial_chain(
        described(
            before,
            joint('one', 'a', 'b', inside=ABOUT_Z),
            joint('two', 'b', 'c', inside=ABOUT_Y),
            joint('three', 'c', 'd', inside=ABOUT_Z),
            follower,
        ),
        'd',
    )
    assert len(chain.driven) == 3


def test_meshes_that_are_not_there_do_not_matter():
    mesh = '<visual><geometry><mesh filename="package://nowhere/x.dae"/></geometry></visual>'
    text = three().replace('<link name="b"/>', f'<link name="b">{mesh}</link>')
    assert serial_chain(text, 'd') == serial_chain(three(), 'd')


def test_the_xml_itself_is_taken_with_whatever_stands_before_it():
    assert text_of('\ufeff\n  <robot/>') == '<robot/>'


def test_a_file_is_read_and_only_the_one_that_is_named(tmp_path):
    file = tmp_path / 'my robot.urdf'
    file.write_bytes(b'\xef\xbb\xbf<robot/>')
    assert text_of(str(file)) == text_of(f'file://{file}') == '<robot/>'


@pytest.mark.parametrize(
    ('name', 'sentence'),
    [
        ('', 'There is no robot description; give the XML of a URDF'),
        (' \n', 'There is no robot description'),
        ('/nowhere/robot.urdf', r"'/nowhere/robot.urdf' cannot be read \(No such file"),
        ('/', r'cannot be read \(Is a directory\)'),
        ('a\0b', 'cannot be read'),
    ],
)
def test_a_file_that_cannot_be_read_is_named(name, sentence):
    with pytest.raises(InvalidValueError, match=sentence):
        text_of(name)


def test_a_file_that_is_no_text_is_named(tmp_path):
    file = tmp_path / 'robot.stl'
    file.write_bytes(b'solid\xff\xfe')
    with pytest.raises(InvalidValueError, match='it is no text in UTF-8'):
        text_of(str(file))
