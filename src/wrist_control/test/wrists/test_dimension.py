"""The dimensions of a mechanism: fields that know what is valid for them."""

import math
from dataclasses import dataclass

import pytest

from wrist_control import InvalidValueError
from wrist_control.wrists.dimension import (
    Dimension,
    PointList,
    Text,
    dimension,
    dimensions_of,
    joint_names,
    point_list,
    point_lists_of,
    text,
    texts_of,
)


@dataclass(frozen=True)
class Mechanism:
    """One field of each kind."""

    radius: float = dimension(0.1, 'from the centre to a hinge', 'm', 0.01, 1.0)
    hinges: list | None = point_list('where the hinges are')
    drawing: str = text('what it is made after', 'robot_drawing', 'a.svg')
    joints: tuple = joint_names('which of its joints')
    name: str = ''


def test_the_fields_of_a_mechanism_are_told_apart_by_what_they_are():
    assert Mechanism() == Mechanism(0.1, None, '', '', joints=())
    facts = Dimension(0.1, 'from the centre to a hinge', 'm', 0.01, 1.0)
    assert dimensions_of(Mechanism) == {'radius': facts}
    assert point_lists_of(Mechanism) == {'hinges': PointList('where the hinges are')}
    assert texts_of(Mechanism) == {
        'drawing': Text('what it is made after', 'robot_drawing', 'a.svg'),
        'joints': Text('which of its joints', 'joints', names=True),
    }


def test_a_text_is_not_printed_with_its_mechanism():
    assert 'long' not in repr(Mechanism(drawing='long'))


def test_values_on_the_bounds_are_valid():
    for value in (0.01, 0.5, 1, 1.0):
        dimensions_of(Mechanism)['radius'].check('radius', value)


@pytest.mark.parametrize('value', [0.0, -0.1, 1.1, math.nan, math.inf, '0.1', None])
def test_a_value_that_is_not_valid_is_refused_with_the_range_and_what_it_is(value):
    with pytest.raises(
        InvalidValueError,
        match=rf'^radius is {value}; valid is 0\.01 to 1 m \(from the centre to a hinge\)\.$',
    ):
        dimensions_of(Mechanism)['radius'].check('radius', value)
