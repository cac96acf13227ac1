"""What a recording says of a topic: the definition of its messages, and what its publishers offer.

In rosbag2's words, so that whoever reads it needs none of our packages.
"""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path
from typing import Any

from ament_index_python.packages import PackageNotFoundError, get_package_share_directory
from rclpy.duration import Duration
from rclpy.qos import QoSProfile

from wrist_control.errors import InvalidValueError

# What stands between a definition and those that it is made of.
RULER = '=' * 80
# A field: its type, which may be bounded or of many, and a name.
FIELD = re.compile(r'^\s*([A-Za-z]\w*(?:/\w+)?)(?:<=\d+)?(?:\[[^\]]*\])?\s+[A-Za-z]\w*')
PLAIN = {
    *('bool', 'byte', 'char', 'float32', 'float64', 'string', 'wstring'),
    *(f'{sign}int{size}' for sign in ('', 'u') for size in (8, 16, 32, 64)),
}


def message_class(kind: str) -> Any:
    """Return the class of a type of messages, such as `std_msgs/msg/Empty`.

    Raises:
        InvalidValueError: It is not installed here.
    """
    package, _, name = kind.split('/')
    try:
        return getattr(import_module(f'{package}.msg'), name)
    except (ImportError, AttributeError):
        raise _unknown(kind) from None


def definition(kind: str) -> str:
    """Return the definition of a type, and of all types that it is made of, as text.

    Raises:
        InvalidValueError: One of them is not installed here.
    """
    package, _, name = kind.split('/')
    own = _text(package, name)
    parts, waiting, known = [own], _made_of(package, own), {f'{package}/{name}'}
    while waiting:
        part = waiting.pop(0)
        if part in known:
            continue
        known.add(part)
        text = _text(*part.split('/'))
        parts.append(f'{RULER}\nMSG: {part}\n{text}')
        waiting += _made_of(part.partition('/')[0], text)
    return '\n'.join(parts)


def _text(package: str, name: str) -> str:
    try:
        share = Path(get_package_share_directory(package))
        return (share / 'msg' / f'{name}.msg').read_text(encoding='utf-8')
    except (PackageNotFoundError, OSError):
        raise _unknown(f'{package}/msg/{name}') from None


def _made_of(package: str, text: str) -> list[str]:
    found = (FIELD.match(line) for line in text.splitlines())
    types = [field[1] for field in found if field and field[1] not in PLAIN]
    return [kind if '/' in kind else f'{package}/{kind}' for kind in types]


def _unknown(kind: str) -> InvalidValueError:
    return InvalidValueError(f'{kind} is not installed here; install its package to record it.')


def qos_facts(qos: QoSProfile) -> dict[str, Any]:
    """Return a quality of service as rosbag2 writes it."""
    return {
        'history': qos.history.name.lower(),
        'depth': qos.depth,
        'reliability': qos.reliability.name.lower(),
        'durability': qos.durability.name.lower(),
        'deadline': _time(qos.deadline),
        'lifespan': _time(qos.lifespan),
        'liveliness': qos.liveliness.name.lower(),
        'liveliness_lease_duration': _time(qos.liveliness_lease_duration),
        'avoid_ros_namespace_conventions': qos.avoid_ros_namespace_conventions,
    }


def _time(duration: Duration) -> dict[str, int]:
    seconds, rest = divmod(duration.nanoseconds, 10**9)
    return {'sec': seconds, 'nsec': rest}
