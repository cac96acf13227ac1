"""One joint of a URDF: its name and kind, the links it joins, where it is, and its limits."""

from __future__ import annotations

import math
from collections.abc import Iterable
from xml.etree.ElementTree import Element

from wrist_control.errors import InvalidValueError
from wrist_control.rotations import IDENTITY, Pose, Vector, about_x, about_y, about_z, product
from wrist_control.wrists.joint import Joint


def limited_joint(joint: Element) -> Joint:
    """Return a joint's name and limits.

    Raises:
        InvalidValueError: It follows another, or has limits that leave nothing.
    """
    name, limit = name_of(joint), joint.find('limit')
    mimic = joint.find('mimic')
    if mimic is not None:
        raise InvalidValueError(
            f'The joint {name!r} follows {mimic.get("joint")!r} and cannot be driven; name others.'
        )
    speed = math.inf if limit is None else _number(limit, 'velocity', math.inf, name)
    if not speed > 0.0:
        raise InvalidValueError(
            f'The joint {name!r} has the velocity limit {speed:g} in its description; give there '
            'how fast it can turn, rad/s.'
        )
    if kind_of(joint) == 'continuous':
        return Joint(name, rate_limit=speed)
    lower, upper = (
        max(_bounds(joint, 'lower', -math.inf)),
        min(_bounds(joint, 'upper', math.inf)),
    )
    if limit is None or not lower < upper:
        told = 'no limits' if limit is None else f'the limits {lower:g} to {upper:g}'
        raise InvalidValueError(
            f'The joint {name!r} has {told} in its description; give there how far it can turn, '
            'rad, or call it continuous.'
        )
    return Joint(name, lower=lower, upper=upper, rate_limit=speed)


def _bounds(joint: Element, which: str, otherwise: float) -> Iterable[float]:
    """Return the limit of the joint, and of its controller where that has one."""
    for tag, attribute, default in (
        ('limit', which, 0.0),
        ('safety_controller', f'soft_{which}_limit', otherwise),
    ):
        found = joint.find(tag)
        yield otherwise if found is None else _number(found, attribute, default, name_of(joint))


def origin_of(joint: Element) -> Pose:
    """Return where a joint is while it is at 0, axes of its parent link."""
    found = joint.find('origin')
    if found is None:
        return Pose(IDENTITY)
    roll, pitch, yaw = _vector(found, 'rpy', (0.0, 0.0, 0.0), name_of(joint))
    turned = product(product(about_z(yaw), about_y(pitch)), about_x(roll))
    return Pose(turned, _vector(found, 'xyz', (0.0, 0.0, 0.0), name_of(joint)))


def axis_of(joint: Element) -> Vector:
    """Return the unit vector that a joint turns about, its own axes."""
    found = joint.find('axis')
    x, y, z = (
        (1.0, 0.0, 0.0)
        if found is None
        else _vector(found, 'xyz', (1.0, 0.0, 0.0), name_of(joint))
    )
    length = math.hypot(x, y, z)
    if length < 1e-9:
        raise InvalidValueError(f'The axis of the joint {name_of(joint)!r} has no direction.')
    return (x / length, y / length, z / length)


def _vector(element: Element, attribute: str, otherwise: Vector, joint: str) -> Vector:
    text = element.get(attribute)
    if text is None:
        return otherwise
    numbers = [_finite(part) for part in text.split()]
    if len(numbers) != 3 or None in numbers:
        raise InvalidValueError(
            f'{attribute} of the joint {joint!r} is {text[:80]!r}; valid are three numbers.'
        )
    x, y, z = (float(number or 0.0) for number in numbers)
    return (x, y, z)


def _number(element: Element, attribute: str, otherwise: float, joint: str) -> float:
    text = element.get(attribute)
    if text is None:
        return otherwise
    number = _finite(text)
    if number is None:
        raise InvalidValueError(
            f'{attribute} of the joint {joint!r} is {text[:80]!r}; valid is a number.'
        )
    return number


def _finite(text: str) -> float | None:
    try:
        number = float(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def link_of(joint: Element, which: str) -> str:
    """Return the name of a joint's link, its `parent` or its `child`."""
    found = joint.find(which)
    name = None if found is None else found.get('link')
    if name is None:
        raise InvalidValueError(f'The joint {name_of(joint)!r} has no {which} link.')
    return name


def name_of(joint: Element) -> str:
    """Return what a joint is called."""
    return joint.get('name', '')


def kind_of(joint: Element) -> str:
    """Return how a joint moves, as the description calls it."""
    return joint.get('type', '')
