"""Commands that were given once, given again at their times."""

from __future__ import annotations

import bisect
from collections.abc import Sequence
from typing import NamedTuple

from wrist_control.errors import InvalidValueError

Twist = tuple[float, ...]
ZERO: Twist = (0.0,) * 6


class Given(NamedTuple):
    """A command, and when it was given, s."""

    time: float
    twist: Twist


class RecordedCommands:
    """What to ask for at each time since the first command.

    Attributes:
        duration: Until nothing is asked for any more, s.
        began: When the first was given again, s; None before.
        done: True once nothing more is asked for.
    """

    def __init__(self, given: Sequence[Given], held: float) -> None:
        """Prepare.

        Args:
            given: The commands, in the order of their times.
            held: For how long each is held at most, s: when they fell silent, the hand stopped.

        Raises:
            InvalidValueError: There is none.
        """
        if not given:
            raise InvalidValueError('There is no command; record somebody who gives one.')
        self._times = [one.time - given[0].time for one in given]
        self._twists = [one.twist for one in given]
        self._held = held
        self.duration = self._times[-1] + held
        self.began: float | None = None
        self.done = False

    def twist(self, now: float) -> Twist:
        """Return (vx, vy, vz, p, q, r) to ask for now, m/s and rad/s; the first call begins.

        Args:
            now: s.
        """
        if self.began is None:
            self.began = now
        self.done = now - self.began >= self.duration
        return self._at(now - self.began)

    def _at(self, elapsed: float) -> Twist:
        row = bisect.bisect_right(self._times, elapsed) - 1
        if row < 0 or elapsed - self._times[row] >= self._held:
            return ZERO
        return self._twists[row]
