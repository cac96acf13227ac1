"""Which commands count: a gate for stamps, ages, frames and numbers. No clock of its own.

Two clocks are told apart everywhere: *stamp time* is the clock that messages are stamped by, and
*receipt time* is the one that ages are judged by, which never jumps.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from wrist_control.errors import RefusedError
from wrist_control.rotations import Quaternion, to_hand

# Clocks of two machines may differ by this much, s; a stamp further ahead is refused.
CLOCK_SKEW = 0.05
# No hand is asked for more than this by anybody in earnest: m/s and rad/s.
FASTEST_LINEAR, FASTEST_ANGULAR = 10.0, 100.0


class ReceivedTwist(NamedTuple):
    """A command as it came.

    Attributes:
        twist: (vx, vy, vz, p, q, r), rad/s and m/s.
        frame: The frame it says it is in; empty means the hand's.
        stamp: Its stamp, s of stamp time; None when it has none and so counts as just made.
    """

    twist: tuple[float, ...]
    frame: str = ''
    stamp: float | None = None


class Command(NamedTuple):
    """A command that counts.

    Attributes:
        twist: (vx, vy, vz, p, q, r), rad/s and m/s.
        in_forearm: True when the twist is given in forearm axes, not in hand axes.
        stamp: Its stamp, s of stamp time; None when it has none.
        receipt: When it came, s of receipt time.
    """

    twist: tuple[float, ...]
    in_forearm: bool
    stamp: float | None
    receipt: float


class CommandPolicy(NamedTuple):
    """Which commands count.

    Attributes:
        timeout: Oldest age that still counts, s.
        hand_frame: Name of the hand frame.
        forearm_frame: Name of the forearm frame.
    """

    timeout: float
    hand_frame: str = 'hand'
    forearm_frame: str = 'forearm'

    def accept(
        self, received: ReceivedTwist, *, stamp_time: float, receipt_time: float
    ) -> Command:
        """Return a command that counts.

        Args:
            received: The command as it came.
            stamp_time: Now, s.
            receipt_time: Now, s.

        Raises:
            RefusedError: The command does not count; the sentence says why.
        """
        twist, frame, stamp = received
        if not all(math.isfinite(x) for x in twist):
            raise RefusedError(
                'not finite',
                f'Refused a command that is not finite: {tuple(twist)}; send numbers.',
            )
        if max(map(abs, twist[:3])) > FASTEST_LINEAR or max(map(abs, twist[3:])) > FASTEST_ANGULAR:
            raise RefusedError(
                'beyond belief',
                f'Refused a command of {tuple(twist)}; send at most {FASTEST_LINEAR:g} m/s and '
                f'{FASTEST_ANGULAR:g} rad/s about or along each axis.',
            )
        if frame not in ('', self.hand_frame, self.forearm_frame):
            raise RefusedError(
                'unknown frame',
                f'Refused a command in frame {frame!r}; use {self.hand_frame!r}, '
                f'{self.forearm_frame!r} or an empty frame_id (the hand).',
            )
        if stamp is not None:
            self._check_age(stamp_time - stamp)
        in_forearm = frame == self.forearm_frame and frame not in ('', self.hand_frame)
        return Command(tuple(twist), in_forearm, stamp, receipt_time)

    def _check_age(self, age: float) -> None:
        check_not_ahead('command', -age)
        if age > self.timeout:
            raise RefusedError(
                'too old',
                f'Refused a command {age:.3f} s old; at most {self.timeout:g} s '
                '(command_timeout) counts.',
            )


def check_not_ahead(what: str, ahead: float) -> None:
    """Refuse what is stamped further in the future than clocks may differ.

    Args:
        what: What kind of message it is, in a word.
        ahead: By how much its stamp is in the future, s.

    Raises:
        RefusedError: It is too far ahead.
    """
    if ahead > CLOCK_SKEW:
        raise RefusedError(
            'stamp in the future',
            f'Refused a {what} stamped {ahead:.3f} s in the future; synchronise the clocks.',
        )


def hand_twist(command: Command, orientation: Quaternion) -> tuple[float, ...]:
    """Return a command's twist in hand axes for a hand at an orientation."""
    if not command.in_forearm:
        return command.twist
    vx, vy, vz, p, q, r = command.twist
    return (*to_hand(orientation, (vx, vy, vz)), *to_hand(orientation, (p, q, r)))


def freshness(age: float, timeout: float, stop_time: float) -> float:
    """Return the share of a held command that is still followed: 1, then a ramp down to 0.

    Args:
        age: s since the command came.
        timeout: Age up to which it is followed in full, s.
        stop_time: How long the ramp to a stop takes, s.
    """
    if age <= timeout:
        return 1.0
    return max(0.0, 1.0 - (age - timeout) / stop_time)
