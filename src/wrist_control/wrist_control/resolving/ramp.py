"""A stop on its way: how much of the motion is still made, and what comes after it."""

from __future__ import annotations

from typing import NamedTuple

from wrist_control.resolving.period import Mode
from wrist_control.resolving.state import Twist

# A share that is rounding alone.
NOTHING = 1e-9


class Ramp(NamedTuple):
    """A stop that is counted in steps, so that no clock can lengthen it.

    Attributes:
        share: How much of the motion is still made, 1 down to 0.
        then: Who is in charge of the joints once they are at rest.
        message: What happens and what to do, one sentence for the operator.
    """

    share: float
    then: Mode
    message: str

    def after(self, dt: float, stop_time: float) -> Ramp:
        """Return the ramp one step later.

        Args:
            dt: Duration of the step, s.
            stop_time: How long the whole ramp takes, s.
        """
        share = self.share - dt / stop_time
        return self._replace(share=share if share > NOTHING else 0.0)

    def of(self, twist: Twist) -> Twist:
        """Return what is still made of the twist that was followed when the stop began."""
        vx, vy, vz, p, q, r = (self.share * x for x in twist)
        return vx, vy, vz, p, q, r
