"""Numbers and commands that nobody in earnest would send."""

from __future__ import annotations

import math
from collections.abc import Sequence

from wrist_control.testing.places import Random, random_twist
from wrist_control.wrists import Wrist

NOT_FINITE = (math.nan, math.inf, -math.inf)
EDGES = (0.0, -0.0, 5e-324, 2.2e-308, 1e-300, 1e-16, 1.0, 1e16, 1e150, 1e300, 1.7e308)
HAND_SPEEDS = (0.02, 0.1, 0.3, 0.8, 1.5, 30.0)  # rad/s


def any_size(random: Random) -> float:
    """Return a number of any size from 1e-300 to 1e300, of either sign."""
    return float(random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(-300.0, 300.0))


def hostile_number(random: Random) -> float:
    """Return a number of any size, an edge of the floating point numbers, or one that is none."""
    kind = random.random()
    if kind < 0.4:
        return float(random.choice(NOT_FINITE))
    if kind < 0.7:
        return float(random.choice([-1.0, 1.0]) * random.choice(EDGES))
    return any_size(random)


def ordinary(wrist: Wrist, random: Random) -> list[float]:
    """Return a command that a person might give, or none at all; rad/s and m/s."""
    if random.random() < 0.15:
        return [0.0] * wrist.twist_size
    return list(random_twist(wrist, random, float(random.choice(HAND_SPEEDS))))


def extreme(wrist: Wrist, random: Random) -> list[float]:
    """Return a finite command whose numbers are of any size, some of them zero."""
    share = random.random()
    twist = [any_size(random) if random.random() < share else 0.0 for _ in range(wrist.twist_size)]
    if random.random() < 0.3:  # one ordinary command, far too large or far too small
        scale = abs(any_size(random))
        twist = [scale * x for x in random_twist(wrist, random)]
    return twist if math.isfinite(math.hypot(*twist)) else ordinary(wrist, random)


def not_finite(wrist: Wrist, random: Random) -> list[float]:
    """Return a command in which at least one number is none."""
    twist = ordinary(wrist, random)
    for index in random.integers(0, len(twist), size=int(random.integers(1, 4))):
        twist[index] = float(random.choice(NOT_FINITE))
    return twist


def along(axis: Sequence[float], wrist: Wrist, random: Random) -> list[float]:
    """Return a command about an axis, or nearly."""
    speed, off = float(random.choice(HAND_SPEEDS)), float(random.choice([0.0, 1e-9, 1e-3]))
    twist = [0.0] * (wrist.twist_size - 3)
    return [*twist, *(speed * (x + off) for x in axis)]
