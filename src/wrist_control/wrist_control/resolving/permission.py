"""Whether the hand may move at all: a dead-man's switch, and the ramp once it is released."""

from __future__ import annotations

import math

from wrist_control.resolving.commands import freshness


class Deadman:
    """A switch that somebody has to keep pressing, over and over again."""

    def __init__(self) -> None:
        """Begin unpressed."""
        self._pressed = self._released = -math.inf
        self._held = self._several = False

    def take(self, held: bool, receipt_time: float, publishers: int = 1) -> None:
        """Hear the switch.

        Args:
            held: True while it is pressed.
            receipt_time: Now, s.
            publishers: How many switches there are: released is what one of them says.
        """
        self._held = held
        if held:
            self._pressed = receipt_time
        else:
            self._released = receipt_time
        self._several = publishers > 1

    def withheld(self, receipt_time: float, timeout: float) -> str:
        """Return why the hand may not move, one sentence; empty when it may.

        Args:
            receipt_time: Now, s.
            timeout: How long a press counts, s; with several switches a release, too.
        """
        if self._pressed == self._released == -math.inf:
            return 'Held: nothing was heard on deadman yet; press the dead-man switch to move.'
        if not self._held or (self._several and receipt_time - self._released <= timeout):
            return 'Stopped: the dead-man switch is released; press it to move.'
        if receipt_time - self._pressed > timeout:
            return (
                f'Stopped: deadman has been silent for more than {timeout:g} s (command_timeout); '
                'press the dead-man switch again, and send it more often.'
            )
        return ''


class Permission:
    """How much of a motion is allowed: all of it, or a ramp to a stop since it was withheld.

    Attributes:
        since: When it was withheld, s of receipt time; None while it is allowed.
    """

    def __init__(self) -> None:
        """Begin without: what was never allowed needs no ramp."""
        self.since: float | None = -math.inf

    def share(self, withheld: bool, receipt_time: float, stop_time: float) -> float:
        """Return the share of the motion that is allowed now: 1, then a ramp down to 0.

        Args:
            withheld: True while no motion is allowed.
            receipt_time: Now, s.
            stop_time: How long the ramp takes, s.
        """
        if not withheld:
            self.since = None
            return 1.0
        if self.since is None:
            self.since = receipt_time
        return freshness(receipt_time - self.since, 0.0, stop_time)
