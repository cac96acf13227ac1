"""What the operator asks of the hand: rates p, q, r as functions of time."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from wrist_control.errors import InvalidValueError
from wrist_control.rotations import Vector

# [Barker1986], basic test maneuver: 1° for each step of 1/32 s.
BARKER_SPEED = math.radians(32.0)
QUARTER_TURN = 0.5 * math.pi
# Times closer than this are the same, s: round-off in a sum of steps must not add a step.
EARLY = 1e-9
ZERO_RATES: Vector = (0.0, 0.0, 0.0)


class Segment(NamedTuple):
    """Constant hand rates p, q, r, rad/s, for a time, s."""

    rates: Vector
    duration: float


class Order(NamedTuple):
    """What to ask for now.

    Attributes:
        rates: p, q, r, rad/s.
        share: How far the maneuver's clock advances for each second that this is followed.
    """

    rates: Vector
    share: float


@dataclass(frozen=True)
class Maneuver:
    """Segments flown one after the other.

    Attributes:
        name: What it is called by.
        segments: The parts, in order.
        waits: The operator watches the hand and holds each command until the hand has done it,
            so the maneuver's clock stands still while time is being lost.
    """

    name: str
    segments: tuple[Segment, ...]
    waits: bool = True

    @property
    def duration(self) -> float:
        """Time without any loss, s."""
        return sum(segment.duration for segment in self.segments)

    def order(self, time: float, dt: float) -> Order:
        """Return what to ask for from a time on.

        Where the operator waits for the hand, a segment that would end within the holding time
        is flown slower, so that it ends exactly; the maneuver's clock then runs slower, too.

        Args:
            time: The maneuver's own time since its start, s.
            dt: How long the command will be held, s.
        """
        left = -max(time, 0.0)
        for segment in self.segments:
            left += segment.duration
            if left > EARLY:
                share = min(1.0, left / dt) if self.waits and left < dt - EARLY else 1.0
                p, q, r = segment.rates
                return Order((share * p, share * q, share * r), share)
        return Order(ZERO_RATES, 1.0)


def turn(axis: int, angle: float, speed: float) -> Segment:
    """Return a turn about one hand axis (0, 1, 2 for x, y, z) at constant speed."""
    rates = [0.0, 0.0, 0.0]
    rates[axis] = math.copysign(speed, angle)
    return Segment((rates[0], rates[1], rates[2]), abs(angle) / speed)


def basic_test(speed: float) -> Maneuver:
    """Pitch until the probe is vertical, then yaw until it points along y. [Barker1986]."""
    return Maneuver('basic_test', (turn(1, QUARTER_TURN, speed), turn(2, QUARTER_TURN, speed)))


def extended_test(speed: float) -> Maneuver:
    """Pitch until the probe is vertical, then yaw on for a whole turn. [Barker1986], fig. 10.

    The paper does not print where its figure ends; a whole turn shows the limit cycle.
    """
    return Maneuver('extended_test', (turn(1, QUARTER_TURN, speed), turn(2, math.tau, speed)))


def pitch_then_roll(speed: float) -> Maneuver:
    """Pitch by 40°, which lies inside every wrist's reach, then roll by a whole turn."""
    pitch = turn(1, math.radians(40.0), speed)
    return Maneuver('pitch_then_roll', (pitch, turn(0, math.tau, speed)))


def roll_at_full_bend(speed: float) -> Maneuver:
    """Pitch to the edge of a hemisphere, then roll by a whole turn."""
    pitch = turn(1, QUARTER_TURN, speed)
    return Maneuver('roll_at_full_bend', (pitch, turn(0, math.tau, speed)))


def hold(speed: float) -> Maneuver:
    """Ask for nothing for two seconds."""
    return Maneuver('hold', (Segment(ZERO_RATES, 2.0),))


def stick(speed: float, seed: int = 1, duration: float = 60.0) -> Maneuver:
    """Return a pseudo-random stick: a new direction every half second, at most at `speed`.

    The operator does not wait for the hand, as a person exploring does not.
    """
    chance = random.Random(seed)
    segments = []
    for _ in range(round(duration / 0.5)):
        x, y, z = (chance.gauss(0.0, 1.0) for _ in range(3))
        scale = speed * chance.random() / math.sqrt(x * x + y * y + z * z)
        segments.append(Segment((scale * x, scale * y, scale * z), 0.5))
    return Maneuver('stick', tuple(segments), waits=False)


MANEUVERS: dict[str, Callable[[float], Maneuver]] = {
    'basic_test': basic_test,
    'extended_test': extended_test,
    'pitch_then_roll': pitch_then_roll,
    'roll_at_full_bend': roll_at_full_bend,
    'hold': hold,
    'stick': stick,
}


def make_maneuver(name: str, speed: float = BARKER_SPEED) -> Maneuver:
    """Return a maneuver by name, flown at a hand speed in rad/s.

    Raises:
        InvalidValueError: No maneuver of that name, or a speed that is not finite and above 0.
    """
    if name not in MANEUVERS:
        raise InvalidValueError(
            f'There is no maneuver {name!r}; the maneuvers are {", ".join(MANEUVERS)}.'
        )
    if not (math.isfinite(speed) and speed > 0.0):
        raise InvalidValueError(f'speed is {speed}; it must be finite and above 0 rad/s.')
    return MANEUVERS[name](speed)
