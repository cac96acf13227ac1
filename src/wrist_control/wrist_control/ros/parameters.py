"""Declare each parameter once: default, description, unit and range, checked in one place."""

from __future__ import annotations

import array
import difflib
import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter

from wrist_control.errors import InvalidValueError, WristError
from wrist_control.ros.shown import shown

Value = bool | int | float | str | list[float] | list[int] | list[str]
# What rclpy declares by itself.
OF_RCLPY = ('use_sim_time', 'start_type_description_service')
TYPES = {
    bool: (Parameter.Type.BOOL, Parameter.Type.BOOL_ARRAY),
    int: (Parameter.Type.INTEGER, Parameter.Type.INTEGER_ARRAY),
    float: (Parameter.Type.DOUBLE, Parameter.Type.DOUBLE_ARRAY),
    str: (Parameter.Type.STRING, Parameter.Type.STRING_ARRAY),
}
# In place of units: a list of strings, and the name of a frame.
NAMES, FRAME = 'names', 'frame'


class Spec(NamedTuple):
    """One parameter.

    Attributes:
        name: What it is called.
        default: Its value when none is given; its type is the parameter's type.
        description: What it does, one sentence without the unit.
        unit: SI unit, or empty; NAMES for a list of strings; FRAME for a name that shall be
            another in every namespace: its default comes after that of the node.
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

    @property
    def kind(self) -> type:
        """Type of the value, or of each of its items; an empty list is one of numbers."""
        if self.unit == NAMES:
            return str
        if isinstance(self.default, list):
            return type(self.default[0]) if self.default else float
        return type(self.default)

    @property
    def type(self) -> Parameter.Type:
        """Type of the parameter, as ROS calls it."""
        return TYPES[self.kind][isinstance(self.default, list)]


class ParameterNode(Node):
    """A node whose parameters are checked, and keep their types.

    What means the same is as good: 100 for 100.0, one number for a list of one, and the text inf
    where a tool cannot say a number that is not finite.
    """

    def __init__(self, node_name: str, **node_options: Any) -> None:
        """Make the node.

        Args:
            node_name: What it is called.
            node_options: Passed on to rclpy.
        """
        self._specs: dict[str, Spec] = {}
        super().__init__(
            node_name, automatically_declare_parameters_from_overrides=True, **node_options
        )

    def declare_parameters(
        self, namespace: str, parameters: list[Any], ignore_override: bool = False
    ) -> Any:
        """Declare parameters, as rclpy does; an empty list of a file comes without any value."""
        loose = ParameterDescriptor(dynamic_typing=True)
        parameters = [(one[0], None, loose) if one[1:2] == (None,) else one for one in parameters]
        return super().declare_parameters(namespace, parameters, ignore_override)

    def declare(self, specs: Sequence[Spec]) -> dict[str, Any]:
        """Declare parameters and return their values by name; name those that nobody knows.

        Raises:
            InvalidValueError: A value that is not valid, in one sentence.
        """
        given = {name: one.value for name, one in self.get_parameters_by_prefix('').items()}
        specs = [self._of_this_namespace(spec) for spec in specs]
        values = {spec.name: checked(spec, given.get(spec.name, spec.default)) for spec in specs}
        for name in set(given) - set(OF_RCLPY):
            self.undeclare_parameter(name)
        for spec in specs:
            # Loosely at first: rclpy would call an empty list one of bytes.
            loose = ParameterDescriptor(dynamic_typing=True)
            self.declare_parameter(spec.name, spec.default, loose, ignore_override=True)
            self.set_parameters([Parameter(spec.name, spec.type, values[spec.name])])
            self.set_descriptor(spec.name, _descriptor(spec))
        self._specs.update({spec.name: spec for spec in specs})
        for name in sorted(set(given) - set(self._specs) - set(OF_RCLPY)):
            self.get_logger().warning(self._unknown(name))
        return values

    def given(self, spec: Spec) -> Value:
        """Return the value that a parameter is going to have, before it is declared.

        Raises:
            InvalidValueError: It is not valid.
        """
        values = self.get_parameters_by_prefix('')
        return checked(spec, values[spec.name].value if spec.name in values else spec.default)

    def watch(
        self,
        check: Callable[[dict[str, Any]], object],
        apply: Callable[[dict[str, Any]], None],
    ) -> None:
        """Let the live parameters change while the node runs.

        Args:
            check: Called with the new values by name; raises WristError when they cannot be used
                together with what else is set. Must change nothing.
            apply: Called with the same values once they are set.
        """

        def values(parameters: list[Parameter]) -> dict[str, Any]:
            known = [(self._specs[p.name], p.value) for p in parameters if p.name in self._specs]
            return {spec.name: checked(spec, value) for spec, value in known}

        def on_set(parameters: list[Parameter]) -> SetParametersResult:
            try:
                check(values(parameters))
            except WristError as error:
                return _refused(str(error))
            return SetParametersResult(successful=True)

        self.add_on_set_parameters_callback(on_set)
        self.add_post_set_parameters_callback(lambda parameters: apply(values(parameters)))

    def set_parameters_atomically(self, parameter_list: list[Parameter]) -> SetParametersResult:
        """Set parameters, each in its own type, or none; to set what is set already is no change.

        So a whole file can be loaded into a node that it was started with.
        """
        try:
            typed = [self._typed(one) for one in parameter_list]
        except InvalidValueError as error:
            return _refused(str(error))
        changed = [one for one in typed if not self._is_set_for_good(one)]
        if not changed:
            return SetParametersResult(successful=True)
        return super().set_parameters_atomically(changed)

    def _of_this_namespace(self, spec: Spec) -> Spec:
        if spec.unit != FRAME:
            return spec
        frame = f'{self.get_namespace()}/{spec.default}'.strip('/')
        return spec._replace(default=frame, unit='')

    def _typed(self, given: Parameter) -> Parameter:
        spec = self._specs.get(given.name)
        if spec is None:
            return given
        return Parameter(spec.name, spec.type, checked(spec, given.value))

    def _is_set_for_good(self, given: Parameter) -> bool:
        """Return whether a parameter that may not change has this value already."""
        if not self.has_parameter(given.name) or not self.describe_parameter(given.name).read_only:
            return False
        now = self.get_parameter(given.name)
        return now.get_parameter_value() == given.get_parameter_value()

    def _unknown(self, name: str) -> str:
        near = difflib.get_close_matches(name, self._specs, 1)
        meant = f'did you mean {near[0]}?' if near else f'valid are {", ".join(self._specs)}.'
        return f'{shown(name)} is no parameter of {self.get_name()} and changes nothing; {meant}'


def plain(value: Any) -> Any:
    """Return the value of a parameter; an array as a list."""
    return list(value) if hasattr(value, '__len__') and not isinstance(value, str) else value


def checked(spec: Spec, value: object) -> Any:
    """Return a value in the parameter's own type.

    Raises:
        InvalidValueError: It is of the wrong type or out of range.
    """
    if value is None:
        value = []  # as an empty list of a file comes
    if not isinstance(spec.default, list):
        return _item(spec, value)
    if isinstance(value, str) and value.startswith('[') and spec.kind is not str:
        value = [item.strip() for item in value.strip('[] ').split(',') if item.strip()]
    values = list(value) if isinstance(value, (list, tuple, array.array)) else [value]
    if not values and spec.default:
        raise InvalidValueError(_wrong(spec, values))
    return [_item(spec, item) for item in values]


def _item(spec: Spec, value: object) -> Any:
    if spec.kind in (int, float):
        return _number(spec, value)
    if not isinstance(value, spec.kind) or (spec.choices and value not in spec.choices):
        raise InvalidValueError(_wrong(spec, value))
    return value


def _number(spec: Spec, value: object) -> float:
    number = _of_text(value) if isinstance(value, str) else value
    if isinstance(number, bool) or not isinstance(number, (int, float)):
        raise InvalidValueError(_wrong(spec, value))
    if not spec.minimum <= number <= spec.maximum or (spec.kind is int and number % 1):
        raise InvalidValueError(_wrong(spec, value))
    of_its_kind: float = spec.kind(number)
    return of_its_kind


def _of_text(text: str) -> float | None:
    """Return the number that a text says, as YAML writes it or as Python does; or None."""
    try:
        return float(text.replace('.inf', 'inf'))
    except ValueError:
        return None


def _descriptor(spec: Spec) -> ParameterDescriptor:
    descriptor = ParameterDescriptor(
        name=spec.name,
        type=spec.type.value,
        description=spec.description + (f' [{spec.unit}]' if spec.unit else ''),
        additional_constraints=f'valid: {_valid(spec)}',
        read_only=not spec.live,
    )
    if isinstance(spec.default, float):
        descriptor.floating_point_range = [
            FloatingPointRange(from_value=float(spec.minimum), to_value=float(spec.maximum))
        ]
    elif spec.type == Parameter.Type.INTEGER:
        descriptor.integer_range = [
            IntegerRange(from_value=int(spec.minimum), to_value=int(spec.maximum), step=1)
        ]
    return descriptor


def _refused(sentence: str) -> SetParametersResult:
    return SetParametersResult(successful=False, reason=sentence)


def _wrong(spec: Spec, value: object) -> str:
    return f'{spec.name} is {shown(repr(value))}; valid is {_valid(spec)}: {spec.description}.'


def _valid(spec: Spec) -> str:
    if spec.choices:
        return 'one of ' + ', '.join(spec.choices)
    if spec.kind is bool:
        return 'true or false'
    if spec.kind is str:
        return 'a list of names' if isinstance(spec.default, list) else 'a string'
    whole = 'a whole number, ' if spec.kind is int else ''
    number = f'{whole}{spec.minimum:g} to {spec.maximum:g} {spec.unit}'.rstrip()
    return f'a list of numbers, each {number}' if isinstance(spec.default, list) else number
