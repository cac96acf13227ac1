"""Everything in a URDF that cannot be used has its sentence, and nothing in it can do harm."""

import time

import pytest

from wrist_control import InvalidValueError
from wrist_control.wrists.robot_description import LARGEST, serial_chain

from .robots import FOLDER, LIMIT, described, joint, three

BAD = {
    'not XML': ('<robot', {}, 'is not XML: unclosed token'),
    'no URDF': ('<mujoco/>', {}, 'is no URDF: it begins with <mujoco>, not <robot>'),
    'xacro': (
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="x"/></robot>',
        {},
        'still has xacro in it; expand it first',
    ),
    'no tip': (three(), {'tip': ''}, "There is no link '' for the tip; valid is one of a, b, c"),
    'a tip nearly right': (
        (FOLDER / 'panda.urdf').read_text(),
        {'tip': 'panda_link9'},
        "There is no link 'panda_link9' for the tip; did you mean 'panda_link",
    ),
    'no joint': (three(), {'names': ['one', 'four']}, "There is no joint 'four' before the tip"),
    'one joint': (three(), {'names': ['one']}, 'A wrist has two to four joints, each named once'),
    'a joint twice': (three(), {'names': ['one', 'one']}, 'each named once; joints is one, one'),
    'another order': (
        three(),
        {'names': ['two', 'one', 'three']},
        'joints is two, one, three; outermost first it is one, two, three',
    ),
    'one left out': (
        three(),
        {'names': ['one', 'three']},
        "Between 'one' and the tip 'd' is 'two', which turns too; name it among the joints",
    ),
    'too few': (
        described(joint('one', 'a', 'b')),
        {'tip': 'b'},
        "Before 'b' there are fewer than two joints that turn it (one); choose a tip further out",
    ),
    'prismatic between': (
        three(three=joint('three', 'c', 'd', 'prismatic', LIMIT)),
        {},
        "Between 'one' and the tip 'd' is 'three', which is prismatic",
    ),
    'prismatic named': (
        three(three=joint('three', 'c', 'd', 'prismatic', LIMIT)),
        {'names': ['two', 'three']},
        "The joint 'three' is prismatic; those of a wrist are revolute or continuous",
    ),
    'floating': (
        three(two=joint('two', 'b', 'c', 'floating')),
        {'names': ['one', 'three']},
        "is 'two', which is floating; choose joints and a tip without it",
    ),
    'planar': (
        three(two=joint('two', 'b', 'c', 'planar')),
        {'names': ['one', 'two']},
        "The joint 'two' is planar",
    ),
    'mimic between': (
        three(two=joint('two', 'b', 'c', inside='<mimic joint="one"/>')),
        {},
        "is 'two', which moves with 'one'; such a hand turns about no axis of its own",
    ),
    'mimic named': (
        three(two=joint('two', 'b', 'c', inside='<mimic joint="one"/>')),
        {'names': ['one', 'two']},
        "The joint 'two' follows 'one' and cannot be driven",
    ),
    'a circle': (
        three(four=joint('four', 'd', 'a')),
        {},
        "The joints before 'd' go round in a circle by 'three'",
    ),
    'two parents': (
        three(four=joint('four', 'e', 'd')),
        {},
        "The link 'd' is the child of two joints, 'three' and 'four'; a URDF is a tree",
    ),
    'no child': (
        described('<joint name="one" type="fixed"><parent link="a"/></joint>'),
        {'tip': 'a'},
        "The joint 'one' has no child link",
    ),
    'no limits': (
        three(one=joint('one', 'a', 'b', 'revolute')),
        {},
        "The joint 'one' has no limits in its description",
    ),
    'limits that are empty': (
        three(one=joint('one', 'a', 'b', 'revolute', '<limit velocity="1"/>')),
        {},
        "The joint 'one' has the limits 0 to 0 in its description",
    ),
    'no speed': (
        three(one=joint('one', 'a', 'b', inside='<limit velocity="0"/>')),
        {},
        "The joint 'one' has the velocity limit 0 in its description",
    ),
    'no number': (
        three(one=joint('one', 'a', 'b', inside='<limit velocity="fast"/>')),
        {},
        "velocity of the joint 'one' is 'fast'; valid is a number",
    ),
    'not three numbers': (
        three(one=joint('one', 'a', 'b', inside='<axis xyz="0 1"/>')),
        {},
        "xyz of the joint 'one' is '0 1'; valid are three numbers",
    ),
    'no finite number': (
        three(one=joint('one', 'a', 'b', inside='<origin rpy="0 nan 0"/>')),
        {},
        "rpy of the joint 'one' is '0 nan 0'; valid are three numbers",
    ),
    'no axis': (
        three(one=joint('one', 'a', 'b', inside='<axis xyz="0 0 0"/>')),
        {},
        "The axis of the joint 'one' has no direction",
    ),
}


@pytest.mark.parametrize('case', BAD)
def test_what_cannot_be_used_is_one_sentence(case):
    text, arguments, sentence = BAD[case]
    with pytest.raises(InvalidValueError) as refused:
        serial_chain(text, **{'tip': 'd'} | arguments)
    assert sentence in str(refused.value)
    assert '\n' not in str(refused.value)


@pytest.mark.parametrize(
    'inside',
    [
        '<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;">',
        ''.join(f'<!ENTITY e{n + 1} "{f"&e{n};" * 10}">' for n in range(12)),
        '<!ENTITY file SYSTEM "file:///etc/hostname">',
        '',
    ],
)
def test_a_document_type_is_refused_before_anything_in_it_can_grow(inside):
    text = f'<?xml version="1.0"?><!DOCTYPE robot [{inside}]><robot>&e12;</robot>'
    began = time.process_time()
    with pytest.raises(InvalidValueError, match='has a document type, which could name other'):
        serial_chain(text, 'd')
    assert time.process_time() - began < 5.0


def test_a_description_that_is_far_too_long_is_refused():
    with pytest.raises(InvalidValueError, match='is longer than 16 MB'):
        serial_chain(f'<robot>{" " * LARGEST}</robot>', 'd')
