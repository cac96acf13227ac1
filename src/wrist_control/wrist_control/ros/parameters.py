"""Declare each parameter once: default, description, unit and range, checked in one place."""

from __future__ import annotations

import array
import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from wrist_control.errors import InvalidValueError, WristError
from wrist_control.ros.shown import shown

Value = float | str | bool | list[float] | list[str]


class Spec(NamedTuple):
    """One parameter.

    Attributes:
        name: What it is called.
        default: Its value when none is given; its type is the parameter's type.
        description: What it does, one sentence without the unit.
        unit: SI unit, or empty.
        minimum: Smallest valid number.
        maximum: Largest valid number.
        choices: The valid strings; any when empty.
        live: True when it may change while the node runs.
    """

    name: str
    default: Value
    description: str
    unit: str = ''
    minimum: float = -math.inf
    maximum: float = math.inf
    choices: tuple[str, ...] = ()
    live: bool = False


def declare(node: Node, specs: Sequence[Spec]) -> dict[str, Any]:
    """Declare parameters and return their values by name.

    Raises:
        InvalidValueError: A value that is not valid, in one sentence.
    """
    return {spec.name: _declare_one(node, spec) for spec in specs}


def watch(
    node: Node,
    specs: Sequence[Spec],
    check: Callable[[dict[str, Any]], object],
    apply: Callable[[dict[str, Any]], None],
) -> None:
    """Let the live parameters change while the node runs.

    Args:
        node: The node that declared them.
        specs: All that it declared.
        check: Called with the new values by name; raises WristError when they cannot be used
            together with what else is set. Must change nothing.
        apply: Called with the same values once they are set.
    """
    by_name = {spec.name: spec for spec in specs}

    def values(parameters: list[Parameter]) -> dict[str, Any]:
        return {p.name: checked(by_name[p.name], p.value) for p in parameters if p.name in by_name}

    def on_set(parameters: list[Parameter]) -> SetParametersResult:
        try:
            check(values(parameters))
        except WristError as error:
            return SetParametersResult(successful=False, reason=str(error))
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(on_set)
    node.add_post_set_parameters_callback(lambda parameters: apply(values(parameters)))


def checked(spec: Spec, value: object) -> Any:
    """Return a value in the parameter's own type.

    Raises:
        InvalidValueError: It is of the wrong type or out of range.
    """
    if isinstance(spec.default, bool):
        return _as(bool, spec, value)
    if isinstance(spec.default, str):
        text = _as(str, spec, value)
        if spec.choices and text not in spec.choices:
            raise InvalidValueError(
                f'{spec.name} is {shown(repr(text))}; valid is {_valid(spec)}.'
            )
        return text
    if isinstance(spec.default, list):
        values = list(value) if isinstance(value, (list, tuple, array.array)) else [value]
        if (spec.default and isinstance(spec.default[0], str)) or spec.unit == 'names':
            return [_as(str, spec, item) for item in values]
        return [_number(spec, item) for item in values]
    return _number(spec, value)


def _declare_one(node: Node, spec: Spec) -> Any:
    # Declared loosely, so that a bad value is answered here and not by rclpy's own exceptions.
    given = node.declare_parameter(
        spec.name, spec.default, ParameterDescriptor(dynamic_typing=True)
    )
    value = checked(spec, given.value)
    node.set_descriptor(spec.name, _descriptor(spec))
    return value


def _descriptor(spec: Spec) -> ParameterDescriptor:
    descriptor = ParameterDescriptor(
        name=spec.name,
        description=spec.description + (f' [{spec.unit}]' if spec.unit else ''),
        additional_constraints=f'valid: {_valid(spec)}',
        read_only=not spec.live,
        dynamic_typing=True,  # so that 100 is as good as 100.0, and one number as good as a list
    )
    if isinstance(spec.default, float):
        descriptor.floating_point_range = [
            FloatingPointRange(from_value=spec.minimum, to_value=spec.maximum, step=0.0)
        ]
    return descriptor


def _number(spec: Spec, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InvalidValueError(_wrong(spec, value))
    if not spec.minimum <= value <= spec.maximum:
        raise InvalidValueError(_wrong(spec, value))
    return float(value)


def _as(kind: type, spec: Spec, value: object) -> Any:
    if not isinstance(value, kind):
        raise InvalidValueError(_wrong(spec, value))
    return value


def _wrong(spec: Spec, value: object) -> str:
    return f'{spec.name} is {shown(repr(value))}; valid is {_valid(spec)}: {spec.description}.'


def _valid(spec: Spec) -> str:
    if spec.choices:
        return 'one of ' + ', '.join(spec.choices)
    if isinstance(spec.default, bool):
        return 'true or false'
    if isinstance(spec.default, str):
        return 'a string'
    number = f'{spec.minimum:g} to {spec.maximum:g} {spec.unit}'.rstrip()
    if isinstance(spec.default, list):
        return 'a list of names' if spec.unit == 'names' else f'a list of numbers, each {number}'
    return number
