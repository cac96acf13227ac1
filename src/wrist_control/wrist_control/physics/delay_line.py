"""A delay between what is told and what happens, to the instant: a period at a time, no clock."""

from __future__ import annotations

from collections import deque
from typing import Generic, TypeVar

Value = TypeVar('Value')

# Shares of a period below this are round-off of a delay that was a whole number of them.
ROUND_OFF = 1e-9


class DelayLine(Generic[Value]):
    """Hands on values, one a period, after a delay that may end within a period."""

    def __init__(self, delay: float, period: float, before: Value) -> None:
        """Start with nothing on its way.

        Args:
            delay: How long each value is on its way, s, 0 or more.
            period: How often a value comes in, s.
            before: What holds until the first one arrives.
        """
        whole = int(delay / period + ROUND_OFF)
        self._late = max(0.0, delay - whole * period)  # the first values of a period are older
        if self._late < ROUND_OFF * period:
            self._late = 0.0
        self._period = period
        self._on_its_way = deque([before] * (whole + 1), maxlen=whole + 2)

    def hand_on(self, value: Value) -> list[tuple[float, Value]]:
        """Return what holds in this period, in order: for how long, s, and what.

        Args:
            value: What comes in at the beginning of the period.
        """
        self._on_its_way.append(value)
        newest = (self._period - self._late, self._on_its_way[1])
        return [(self._late, self._on_its_way[0]), newest] if self._late else [newest]
