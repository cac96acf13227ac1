"""From the keys of a terminal to hand rates: a key moves the hand while it repeats.

A terminal never says that a key was let go. So each time that a key comes, it holds for LEASE and
no longer; a key that is held down comes again 10 to 40 times a second. The first repeat alone is
late, by 0.25 to 0.66 s as the terminal is set: so the hand makes a small step, waits, and moves
on. A terminal repeats only the key that was pressed last.
"""

from __future__ import annotations

import re

from wrist_control.errors import InvalidValueError
from wrist_control.operating.maneuvers import ZERO_RATES
from wrist_control.rotations import Vector

# How long a key holds after it came, s: longer than between two repeats of a slow terminal.
LEASE = 0.2
# For so long after the last key zeros are asked for, s: longer than the wait for the first repeat.
ZEROS = 0.7
# More keys at once were not pressed now: they were pasted, or held up on their way.
MOST_AT_ONCE = 4
# The axis of each key, 0 to 2 for p, q, r, and the sign.
AXES = {'d': (0, 1), 'a': (0, -1), 'w': (1, 1), 's': (1, -1), 'q': (2, 1), 'e': (2, -1)}
STOP, ENABLE = ' ', 'g'
FASTER, SLOWER = '+=', '-_'
STEP = 1.25
SLOWEST = 0.01
# What arrow keys and the like send, and letters with Alt.
ESCAPED = re.compile(r'\x1b(\[[0-?]*[ -/]*[@-~]|O.|.|$)', re.DOTALL)


class Keys:
    """Which keys count at this moment, and what they ask for.

    Attributes:
        speed: rad/s about one axis.
        most_speed: The fastest that `speed` can be made, rad/s.
    """

    def __init__(self, speed: float, most_speed: float) -> None:
        """Start with no key held.

        Raises:
            InvalidValueError: It would be faster than it may be.
        """
        if speed > most_speed:
            raise InvalidValueError(
                f'speed is {speed:g} rad/s; valid is at most max_speed, {most_speed:g} rad/s.'
            )
        self.speed = speed
        self.most_speed = most_speed
        self._until: dict[str, float] = {}
        self._last: float | None = None

    def take(self, text: str, now: float) -> str:
        """Hear what the terminal sent since it was last asked.

        Args:
            text: The characters.
            now: Receipt time, s.

        Returns:
            STOP or ENABLE where that was asked for, else nothing; a stop wins, and both let go
            of every key.
        """
        keys = ESCAPED.sub('', text)
        for ask in (STOP, ENABLE):
            if ask in keys:
                self.let_go()
                return ask
        if len(keys) > MOST_AT_ONCE:
            return ''
        for key in keys:
            if key in AXES:
                self._until[key] = now + LEASE
                self._last = now
            elif key in FASTER:
                self.speed = min(self.speed * STEP, self.most_speed)
            elif key in SLOWER:
                self.speed = max(self.speed / STEP, min(SLOWEST, self.speed))
        return ''

    def let_go(self) -> None:
        """Hold no key any more."""
        self._until.clear()

    def rates(self, now: float) -> Vector | None:
        """Return p, q, r now, rad/s; None where nobody has held a key for a while."""
        if self._last is None or now - self._last > ZEROS:
            return None
        rates = list(ZERO_RATES)
        for key, until in self._until.items():
            if now < until:
                axis, sign = AXES[key]
                rates[axis] += sign * self.speed
        p, q, r = rates
        return (p, q, r)
