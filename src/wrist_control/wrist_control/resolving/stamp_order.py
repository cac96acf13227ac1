"""What is older than the last that counted comes too late: a stop is never undone by the past."""

from __future__ import annotations

import math

from wrist_control.errors import RefusedError
from wrist_control.resolving.commands import CLOCK_SKEW, Command


class StampOrder:
    """Lets the commands of one topic through whose stamps do not go back."""

    def __init__(self) -> None:
        """Start with no command."""
        self._stamp = self._receipt = -math.inf

    def check(self, command: Command, *, stamp_time: float, timeout: float) -> None:
        """Remember a command that is in order.

        Args:
            command: One that counts otherwise; without a stamp it was made just now.
            stamp_time: Now, s.
            timeout: Oldest age that still counts, s.

        Raises:
            RefusedError: It is older than the last.
        """
        stamp = stamp_time if command.stamp is None else command.stamp
        # After this long whatever was older than the last is too old by itself; a clock that
        # has been set back shall not be refused any longer.
        remembered = 0.0 <= command.receipt - self._receipt <= timeout + CLOCK_SKEW
        if stamp < self._stamp and remembered:
            raise RefusedError(
                'out of order',
                f'Refused a command stamped {self._stamp - stamp:.3f} s before the last one; '
                'send commands in the order of their stamps.',
            )
        self._stamp, self._receipt = stamp, command.receipt
