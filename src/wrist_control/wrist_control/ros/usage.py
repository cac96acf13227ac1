"""What `--help` says of a node: read from the node itself, which nobody else hears of."""

from __future__ import annotations

import inspect
import os
import signal
import sys
import textwrap
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import rclpy

from wrist_control.errors import WristError
from wrist_control.ros.parameters import OF_RCLPY, ParameterNode, plain

FLAGS = ('-h', '--help')
WIDTH = 99
# Topics and services that every node has.
OF_EVERY_NODE = ('/rosout', '/parameter_events', '/clock')
PARAMETER_SERVICES = 'rcl_interfaces/srv/', 'type_description_interfaces/srv/'


def is_wanted(arguments: Iterable[str]) -> bool:
    """Return whether a command line asks for help."""
    return any(argument in FLAGS for argument in arguments)


def tell(make_node: Callable[[], ParameterNode]) -> int:
    """Print what a node hears, says and can be told, or why not; return the exit code."""
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'OFF'
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)  # whoever reads it may stop in the middle
    rclpy.init(args=[])
    try:
        node = make_node()
        print(*_lines(node), sep='\n')
        node.destroy_node()
    except WristError as error:
        print(f'Cannot start: {error}', file=sys.stderr)
        return 2
    finally:
        rclpy.try_shutdown()
    return 0


def _lines(node: ParameterNode) -> Iterator[str]:
    name, space = node.get_name(), node.get_namespace()
    program = Path(sys.argv[0]).name
    yield (
        f'usage: {program} [--ros-args [-p <parameter>:=<value>] [--params-file <file>] '
        '[-r <name>:=<another>] [-r __ns:=/<namespace>]]'
    )
    about, _, _ = (inspect.getdoc(type(node)) or '').partition('\n\nAttributes:')
    yield f'\n{about}'
    yield '\nHears:'
    yield from _topics(node.get_subscriber_names_and_types_by_node(name, space))
    yield '\nSays:'
    yield from _topics(node.get_publisher_names_and_types_by_node(name, space))
    services = [
        (service, types)
        for service, types in node.get_service_names_and_types_by_node(name, space)
        if not types[0].startswith(PARAMETER_SERVICES)
    ]
    if services:
        yield '\nCan be asked:'
        yield from _topics(services)
    yield '\nParameters (those with a * may change while it runs):'
    for parameter in sorted(node.get_parameters_by_prefix('')):
        if parameter not in OF_RCLPY:
            yield from _parameter(node, parameter)


def _topics(found: Iterable[tuple[str, list[str]]]) -> Iterator[str]:
    for topic, types in sorted(found):
        if topic not in OF_EVERY_NODE:
            yield f'  {topic:<36}{types[0]}'


def _parameter(node: ParameterNode, name: str) -> Iterator[str]:
    value, descriptor = node.get_parameter(name).value, node.describe_parameter(name)
    shown = plain(value)
    yield f'  {name}{"" if descriptor.read_only else " *"} = {shown}'
    text = f'{descriptor.description}; {descriptor.additional_constraints}.'
    yield textwrap.fill(text, WIDTH, initial_indent=' ' * 6, subsequent_indent=' ' * 6)
