"""Messages that nobody in earnest would send, of every type that the nodes listen to."""

from __future__ import annotations

import array
import math
import time
from collections.abc import Sequence
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Twist, TwistStamped
from sensor_msgs.msg import JointState, Joy
from std_msgs.msg import Header

from hostile.numbers import EDGES, NOT_FINITE, hostile_number
from wrist_control.testing.places import Random
from wrist_interfaces.msg import WristStatus

ANGULAR, LINEAR = ('angular.x', 'angular.y', 'angular.z'), ('linear.x', 'linear.y', 'linear.z')
STRINGS = ('', ' ', 'base_link', 'hand\nforearm', 'ψ' * 50, '/', 'x' * 5000, '\u202e', '%s{}')
HUGE = 'x' * 300_000
# Beyond every belief, whatever else is right with the message.
UNBELIEVABLE = (*NOT_FINITE, 1e308, -1e308, 1e16, -101.0)


def put(message: Any, path: str, value: object) -> None:
    """Set a field of a message by its dotted path."""
    *way, last = path.split('.')
    for name in way:
        message = getattr(message, name)
    setattr(message, last, value)


def stamp(seconds: float) -> Time:
    """Return a stamp of so many seconds since 1970; those that no stamp can say are cut off."""
    whole = math.floor(seconds)
    return Time(
        sec=min(max(whole, -(2**31)), 2**31 - 1),
        nanosec=min(int(1e9 * (seconds - whole)), 999_999_999),
    )


def a_string(random: Random) -> str:
    """Return a string, seldom a huge one."""
    return HUGE if random.random() < 0.01 else str(random.choice(STRINGS))


def honest(random: Random, now: float | None = None, speed: float = 0.4) -> TwistStamped:
    """Return a command that a person might give, rad/s; it turns slowly with the time."""
    now = time.time() if now is None else now
    message = TwistStamped(header=Header(stamp=stamp(now)))
    for number, path in enumerate(ANGULAR):
        put(message.twist, path, speed * math.sin((0.7 + 0.3 * number) * now + number))
    if random.random() < 0.3:
        message.header.frame_id = str(random.choice(['hand', 'forearm']))
    return message


def refused_twist(random: Random) -> Twist:
    """Return a command that must be refused."""
    twist = honest(random).twist
    path = str(random.choice([*ANGULAR, *LINEAR]))
    put(twist, path, float(random.choice(UNBELIEVABLE)))
    return twist


def refused_stamped(random: Random) -> TwistStamped:
    """Return a stamped command that must be refused, for its numbers, its frame or its stamp."""
    message = honest(random)
    kind, now = random.random(), time.time()
    if kind < 0.5:
        message.twist = refused_twist(random)
    elif kind < 0.7:
        wrong = [each for each in STRINGS if each] + [HUGE] * (random.random() < 0.05)
        message.header.frame_id = str(random.choice(wrong))
    elif kind < 0.85:  # far in the past; zero would count as no stamp at all
        message.header.stamp = stamp(now - float(random.choice([5.0, 60.0, 1e6, 1.6e9, 2e9])))
    else:
        message.header.stamp = stamp(now + float(random.choice([0.5, 5.0, 1e5, 1e9])))
    return message


def hostile_stamped(random: Random) -> TwistStamped:
    """Return a command with anything in any field; some may count."""
    message = honest(random) if random.random() < 0.5 else refused_stamped(random)
    if random.random() < 0.3:
        put(message.twist, str(random.choice([*ANGULAR, *LINEAR])), hostile_number(random))
    if random.random() < 0.1:  # so small that it is hardly a command
        scale = 10.0 ** random.uniform(-300.0, 0.0)
        for path in ANGULAR:
            put(message.twist, path, scale * float(random.normal()))
    if random.random() < 0.2:
        message.header.stamp = Time(
            sec=int(random.integers(-(2**31), 2**31)), nanosec=int(random.integers(0, 2**32))
        )
    return message


def refused_joints(names: Sequence[str], random: Random) -> JointState:
    """Return joint states, or a joint command, that must be refused."""
    count = len(names)
    message = JointState(header=Header(stamp=stamp(time.time())), name=[*names])
    positions = [float(x) for x in random.uniform(-1.0, 1.0, size=count)]
    kind = int(random.integers(7))
    if kind < 2:
        positions[int(random.integers(count))] = float(random.choice(NOT_FINITE))
    elif kind == 2:
        message.name = [a_string(random) or 'x' for _ in names]
    elif kind == 3:
        message.name = [*names, names[int(random.integers(count))]]
        positions.append(0.0)
    elif kind == 4:
        positions = positions[: int(random.integers(0, count))]
    elif kind == 5:
        message.name, positions = [], []
    else:
        message.name, positions = [*names] * 400, positions * 400
    message.position = array.array('d', positions)
    message.velocity = _numbers(random)
    message.effort = _numbers(random)
    message.header.frame_id = a_string(random)
    return message


def hostile_joints(names: Sequence[str], near: Sequence[float], random: Random) -> JointState:
    """Return joint states that may be taken for true, or not.

    Args:
        names: The joints.
        near: Where they are, rad or m.
        random: Chooses what is wrong.
    """
    if random.random() < 0.5:
        return refused_joints(names, random)
    message = JointState(header=Header(stamp=stamp(time.time())), name=[*names])
    kind, positions = random.random(), [*near]
    index = int(random.integers(len(names)))
    if kind < 0.5:
        positions[index] += float(random.normal() * 10.0 ** random.uniform(-6.0, 0.0))
    elif kind < 0.7:
        positions[index] = float(random.choice([-1.0, 1.0]) * random.choice(EDGES))
    message.position = array.array('d', positions)
    message.velocity = _numbers(random)
    message.header.stamp = stamp(time.time() + float(random.choice([0.0, -1e3, 1e3, 1e9])))
    return message


def hostile_joy(random: Random) -> Joy:
    """Return what no joystick says."""
    axes = [max(-3e38, min(3e38, hostile_number(random))) for _ in range(int(random.integers(9)))]
    buttons = [int(random.integers(-(2**31), 2**31)) for _ in range(int(random.integers(9)))]
    if random.random() < 0.5:  # a good one, but for one axis
        axes, buttons = [0.5, -0.5, 0.0, 0.5], [0, 0, 0, 0, 0, 1]
        axes[int(random.integers(4))] = float(random.choice([*NOT_FINITE, 3e38, -1.0, 1.0, 7.0]))
    if random.random() < 0.3:  # at rest: what comes next may count
        axes, buttons = [0.0] * 4, [0, 0, 0, 0, 0, 1]
    if random.random() < 0.02:
        axes, buttons = [0.5] * 20_000, [1] * 20_000
    return Joy(
        header=Header(stamp=stamp(time.time() + float(random.normal() * 1e3))),
        axes=array.array('f', axes),
        buttons=array.array('i', buttons),
    )


def hostile_status(random: Random) -> WristStatus:
    """Return a status that no resolver has."""
    return WristStatus(
        header=Header(stamp=stamp(time.time() + float(random.choice([0.0, -1e3, 1e9])))),
        state=int(random.integers(256)),
        scale_factor=hostile_number(random),
        time_lost=hostile_number(random),
        margin=hostile_number(random),
        message=a_string(random),
    )


def _numbers(random: Random) -> Any:
    return array.array('d', [hostile_number(random) for _ in range(int(random.integers(8)))])
