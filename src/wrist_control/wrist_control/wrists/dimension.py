"""The dimensions of a mechanism: dataclass fields that know what is valid for them.

A resolver node declares a ROS parameter for each, from the same facts.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import field, fields
from typing import NamedTuple

from wrist_control.errors import InvalidValueError
from wrist_control.wrists.joint import Joint

KEY = 'wrist_control'


class Dimension(NamedTuple):
    """One number that describes a mechanism.

    Attributes:
        default: Its value when none is given.
        description: What it is, without the unit.
        unit: SI unit.
        minimum: Smallest valid value.
        maximum: Largest valid value.
    """

    default: float
    description: str
    unit: str
    minimum: float
    maximum: float = math.inf

    def check(self, name: str, value: object) -> None:
        """Raise InvalidValueError unless a value is a finite number in the valid range."""
        number = isinstance(value, (int, float)) and math.isfinite(value)
        if number and self.minimum <= value <= self.maximum:  # type: ignore[operator]
            return
        raise InvalidValueError(
            f'{name} is {value}; valid is {self.minimum:g} to {self.maximum:g} {self.unit} '
            f'({self.description}).'
        )


class PointList(NamedTuple):
    """A row of points that describe a mechanism, x, y, z of each in m; None when not given."""

    description: str


class Text(NamedTuple):
    """A text that describes a mechanism, or a list of names.

    Attributes:
        description: What it is.
        parameter: What it is called as a parameter of a node.
        example: One that is valid.
        names: It is a list of names.
    """

    description: str
    parameter: str
    example: str = ''
    names: bool = False


def dimension(
    default: float, description: str, unit: str, minimum: float, maximum: float = math.inf
) -> float:
    """Return a dataclass field for a `Dimension`; the arguments are its attributes."""
    facts = Dimension(default, description, unit, minimum, maximum)
    of_the_class: float = field(default=default, metadata={KEY: facts})
    return of_the_class


def point_list(description: str) -> Sequence[float] | None:
    """Return a dataclass field for a `PointList`."""
    of_the_class: Sequence[float] | None = field(
        default=None, metadata={KEY: PointList(description)}
    )
    return of_the_class


def text(description: str, parameter: str, example: str) -> str:
    """Return a dataclass field for a `Text`; the arguments are its attributes."""
    facts = Text(description, parameter, example)
    # Whoever prints a wrist does not want to read the whole of it.
    of_the_class: str = field(default='', repr=False, metadata={KEY: facts})
    return of_the_class


def joint_names(description: str) -> tuple[Joint, ...]:
    """Return a dataclass field for the joints of a wrist that takes their names as well."""
    facts = Text(description, 'joints', names=True)
    of_the_class: tuple[Joint, ...] = field(default=(), kw_only=True, metadata={KEY: facts})
    return of_the_class


def dimensions_of(kind: type) -> dict[str, Dimension]:
    """Return the dimensions of a class of wrists by name."""
    found = {own.name: own.metadata.get(KEY) for own in fields(kind)}
    return {name: facts for name, facts in found.items() if isinstance(facts, Dimension)}


def point_lists_of(kind: type) -> dict[str, PointList]:
    """Return the lists of points of a class of wrists by name."""
    found = {own.name: own.metadata.get(KEY) for own in fields(kind)}
    return {name: facts for name, facts in found.items() if isinstance(facts, PointList)}


def texts_of(kind: type) -> dict[str, Text]:
    """Return the texts of a class of wrists by name."""
    found = {own.name: own.metadata.get(KEY) for own in fields(kind)}
    return {name: facts for name, facts in found.items() if isinstance(facts, Text)}
