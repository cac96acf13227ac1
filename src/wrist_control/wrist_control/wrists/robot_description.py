"""A robot description in URDF, read as far as a wrist needs it: the joints on the way to a link.

Read by Python's own XML parser, without a document type: nothing in it can grow or be fetched.
What hangs elsewhere in the robot, and what its links look like, is not looked at.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from typing import NamedTuple, NoReturn
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

from wrist_control.errors import InvalidValueError
from wrist_control.rotations import IDENTITY, Pose, Vector, placed, to_forearm
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.urdf_joint import (
    axis_of,
    kind_of,
    limited_joint,
    link_of,
    name_of,
    origin_of,
)

# Descriptions of whole humanoids are below 1 MB.
LARGEST = 16_000_000
# So many names are told of those that there are.
TOLD = 12
TURNING = ('revolute', 'continuous')


class DrivenJoint(NamedTuple):
    """A joint of a chain, while all of them are at 0.

    Attributes:
        joint: Its name and its limits.
        origin: Where it is, axes of the link that carries the first one, m.
        axis: Unit vector that it turns about, the same axes.
    """

    joint: Joint
    origin: Vector
    axis: Vector


class Chain(NamedTuple):
    """The joints that turn a link, outermost first.

    Attributes:
        driven: The joints.
        tip: Where the link is while they are at 0, axes of the link that carries the first one.
    """

    driven: tuple[DrivenJoint, ...]
    tip: Pose


def text_of(description: str) -> str:
    """Return the XML that is given, or that is in the file which is named.

    Raises:
        InvalidValueError: There is neither.
    """
    if not description.strip():
        raise InvalidValueError(
            'There is no robot description; give the XML of a URDF, or the name of a file with it.'
        )
    if description.lstrip('\ufeff \t\r\n').startswith('<'):
        return description.lstrip('\ufeff \t\r\n')
    name = description.strip().removeprefix('file://')
    try:
        with open(name, 'rb') as file:
            found = file.read(LARGEST + 1)
        return found.decode('utf-8-sig').lstrip()
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else 'it is no text in UTF-8'
        raise InvalidValueError(
            f'The robot description {name[:200]!r} cannot be read ({reason}); give the XML of a '
            'URDF, or the name of a file with it.'
        ) from error


def serial_chain(text: str, tip: str, names: Sequence[str] = ()) -> Chain:
    """Return the chain of joints that turn a link.

    Args:
        text: The description, XML.
        tip: Name of the link that they turn.
        names: Their names, outermost first; the last three that turn it when there are none.

    Raises:
        InvalidValueError: The description says nothing that can be used; the sentence says why.
    """
    way = _way_to(_robot(text), tip)
    driven = _named(way, tip, names) if names else _last_three(way, tip)
    return _chain(way[way.index(driven[0]) :], driven, tip)


class _NoDocumentType(ElementTree.TreeBuilder):
    def doctype(self, *_: object) -> NoReturn:
        raise InvalidValueError(
            'The robot description has a document type, which could name other files or grow '
            'without end; take the line <!DOCTYPE ...> out.'
        )


def _robot(text: str) -> Element:
    if len(text) > LARGEST:
        raise InvalidValueError(
            f'The robot description is longer than {LARGEST // 1_000_000} MB; give one without '
            'what is no link and no joint.'
        )
    parser = ElementTree.XMLParser(target=_NoDocumentType())
    try:
        parser.feed(text)
        root: Element = parser.close()
    except (ElementTree.ParseError, ValueError) as error:
        if isinstance(error, InvalidValueError):
            raise
        raise InvalidValueError(f'The robot description is not XML: {error}.') from error
    if root.tag != 'robot':
        raise InvalidValueError(
            f'The robot description is no URDF: it begins with <{root.tag[:80]}>, not <robot>.'
        )
    if any('xacro' in str(element.tag) for element in root.iter()):
        raise InvalidValueError(
            'The robot description still has xacro in it; expand it first: xacro robot.urdf.xacro.'
        )
    return root


def _way_to(robot: Element, tip: str) -> list[Element]:
    """Return the joints from the robot's base to a link."""
    above: dict[str, Element] = {}
    for joint in robot.findall('joint'):
        child = link_of(joint, 'child')
        if child in above:
            raise InvalidValueError(
                f'The link {child!r} is the child of two joints, {name_of(above[child])!r} and '
                f'{name_of(joint)!r}; a URDF is a tree.'
            )
        above[child] = joint
    links = [str(link.get('name')) for link in robot.findall('link')]
    if tip not in links:
        raise InvalidValueError(f'There is no link {tip!r} for the tip; {_valid(tip, links)}')
    way: list[Element] = []
    link = tip
    while link in above:
        if above[link] in way:
            raise InvalidValueError(
                f'The joints before {tip!r} go round in a circle by {name_of(above[link])!r}; a '
                'URDF is a tree.'
            )
        way.insert(0, above[link])
        link = link_of(above[link], 'parent')
    return way


def _last_three(way: list[Element], tip: str) -> list[Element]:
    found = [joint for joint in way if kind_of(joint) in TURNING and joint.find('mimic') is None]
    if len(found) < 2:
        raise InvalidValueError(
            f'Before {tip!r} there are fewer than two joints that turn it '
            f'({_list(map(name_of, found)) or "none"}); choose a tip further out.'
        )
    return found[-3:]


def _named(way: list[Element], tip: str, names: Sequence[str]) -> list[Element]:
    known = {name_of(joint): joint for joint in way}
    for name in names:
        if name not in known:
            turning = [name_of(joint) for joint in way if kind_of(joint) in TURNING]
            raise InvalidValueError(
                f'There is no joint {name!r} before the tip {tip!r}; {_valid(name, turning)}'
            )
    found = [known[name] for name in names]
    if not 2 <= len(found) <= 4 or len(set(names)) < len(names):
        raise InvalidValueError(
            f'A wrist has two to four joints, each named once; joints is {_list(names)}.'
        )
    in_order = [name_of(joint) for joint in way if joint in found]
    if in_order != [*names]:
        raise InvalidValueError(
            f'joints is {_list(names)}; outermost first it is {_list(in_order)}.'
        )
    for joint in found:
        if kind_of(joint) not in TURNING:
            raise InvalidValueError(
                f'The joint {name_of(joint)!r} is {kind_of(joint)}; those of a wrist are '
                f'{" or ".join(TURNING)}.'
            )
    return found


def _chain(way: list[Element], driven: list[Element], tip: str) -> Chain:
    """Return the geometry of the way from the link that carries the first driven joint."""
    found = []
    at = Pose(IDENTITY)
    for joint in way:
        at = placed(at, origin_of(joint))
        if joint in driven:
            axis = to_forearm(at.quaternion, axis_of(joint))
            found.append(DrivenJoint(limited_joint(joint), at.position, axis))
        elif kind_of(joint) != 'fixed':
            raise InvalidValueError(_between(joint, driven[0], tip))
    return Chain(tuple(found), at)


def _between(joint: Element, first: Element, tip: str) -> str:
    begin = f'Between {name_of(first)!r} and the tip {tip!r} is {name_of(joint)!r}, which '
    mimic = joint.find('mimic')
    if mimic is not None:
        return (
            f'{begin}moves with {mimic.get("joint")!r}; such a hand turns about no axis of its '
            'own: choose joints and a tip without it between them.'
        )
    if kind_of(joint) in TURNING:
        return f'{begin}turns too; name it among the joints, or choose a tip before it.'
    return f'{begin}is {kind_of(joint)}; choose joints and a tip without it between them.'


def _valid(name: str, names: Sequence[str]) -> str:
    near = difflib.get_close_matches(name, names, 1)
    return f'did you mean {near[0]!r}?' if near else f'valid is one of {_list(names)}.'


def _list(names: Iterable[str]) -> str:
    every = [*names]
    more = f' and {len(every) - TOLD} more' if len(every) > TOLD else ''
    return ', '.join(name[:80] for name in every[:TOLD]) + more
