"""A stop on its way: how much of the motion is still made, and what comes after it."""

from __future__ import annotations

from typing import NamedTuple

from wrist_control.resolving.period import Mode, SupervisorSettings
from wrist_control.resolving.state import State, Twist

# A share that is rounding alone.
NOTHING = 1e-9
# Joints that were told nothing for so long stand still, s; sooner a step was only late.
PAUSE = 0.1


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


def scaled(share: float, twist: Twist) -> Twist:
    """Return a share of a twist."""
    vx, vy, vz, p, q, r = (share * x for x in twist)
    return vx, vy, vz, p, q, r


def after_a_pause(
    state: State, ramp: Ramp | None, settings: SupervisorSettings, pause: float
) -> tuple[State, Ramp | None]:
    """Return the state of joints that were told nothing for a while, and how far a stop came.

    They went on to where they were told, and no further: over all of the pause that is slower.
    A stop has nothing left to ramp then, and must not speed them up again.

    Args:
        state: Where they are.
        ramp: The stop on its way, if there is one.
        settings: For the durations of steps and stops.
        pause: Time since the step before, s; if that is not much more than a step nothing changes.
    """
    if pause <= settings.dt + PAUSE:
        return state, ramp
    slower = tuple([rate * settings.dt / pause for rate in state.joint_rates])
    return state._replace(joint_rates=slower), ramp and ramp._replace(share=0.0)
