"""A mechanism as what stands behind a bus: told once a period, late, and perhaps with a fault."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from wrist_control.errors import UnstableError
from wrist_control.physics.delay_line import DelayLine
from wrist_control.physics.mechanism import Mechanism
from wrist_control.rotations import Pose
from wrist_control.wrists.joint import Joint

# A loop or a gear that is open by more than this, m or rad, no longer holds anything together.
TORN = 0.02
# Where MuJoCo's solver stops: sooner than a judge needs, and with the same path of the hand to six
# figures.
TOLERANCE = 1e-10
# What a stuck joint holds against, N·m or N: far above what any servo or payload does.
STUCK = 1e6


class Drives(NamedTuple):
    """How a mechanism is driven.

    Attributes:
        period: How often it is told something, s.
        delay: How much later what it is told arrives, s.
        effort_limits: Most that each servo does, N·m or N; inf for no limit.
        friction: Dry friction in each driven joint, N·m or N.
        by_rates: Whether it is told joint rates rather than positions.
    """

    period: float
    delay: float
    effort_limits: Sequence[float]
    friction: Sequence[float]
    by_rates: bool = False


class Reading(NamedTuple):
    """What is measured at the end of a period; every number is finite.

    Attributes:
        positions: Of the joints, rad or m.
        rates: Of the joints, rad/s or m/s.
        efforts: Of the servos, N·m or N.
        hand_pose: Where the hand really is, forearm frame.
    """

    positions: tuple[float, ...]
    rates: tuple[float, ...]
    efforts: tuple[float, ...]
    hand_pose: Pose


class DrivenMechanism:
    """A mechanism that is told something once a period.

    Attributes:
        reading: What was measured last.
    """

    def __init__(
        self,
        mechanism: Mechanism,
        joints: Sequence[Joint],
        drives: Drives,
        positions: Sequence[float],
    ) -> None:
        """Put a mechanism somewhere, at rest, held by its servos.

        Args:
            mechanism: The mechanism; from now on it belongs to this object.
            joints: Its driven joints; no servo is sent out of their ranges.
            drives: How it is driven.
            positions: Where its joints start, rad or m.

        Raises:
            UnreachableError: It cannot be assembled there.
            UnstableError: It can, but the physics has no answer there.
        """
        self._mechanism, self._by_rates = mechanism, drives.by_rates
        self._lower = np.array([joint.lower for joint in joints])
        self._upper = np.array([joint.upper for joint in joints])
        self._friction = dict(zip(mechanism.joints, drives.friction, strict=True))
        self._build_in(drives)
        mechanism.start_at(positions)
        self._target = np.array(positions, dtype=float)
        first = (0.0,) * len(positions) if drives.by_rates else tuple(positions)
        self._line = DelayLine(drives.delay, drives.period, first)
        self.reading = self._measured()

    def stick(self, stuck: str) -> None:
        """Let one joint stick where it is, and every other be free.

        Args:
            stuck: Name of the joint; empty for none.
        """
        model = self._mechanism.model
        for name, friction in self._friction.items():
            freedom = model.joint(name).dofadr[0]
            model.dof_frictionloss[freedom] = STUCK if name == stuck else friction

    def advance(self, told: Sequence[float] | np.ndarray) -> Reading:
        """Let a period pass, and return what is measured at its end.

        Args:
            told: Where the joints shall be, rad or m, or how they shall move, rad/s or m/s; it
                arrives after the delay.

        Raises:
            UnstableError: The physics has no answer; it will have none any more.
        """
        for seconds, arrived in self._line.hand_on(tuple(told)):
            self._tell_servos(np.array(arrived), seconds)
            self._mechanism.advance(seconds)
        self.reading = self._measured()
        return self.reading

    def _build_in(self, drives: Drives) -> None:
        model = self._mechanism.model
        mujoco.set_mju_user_warning(lambda sentence: None)  # it would write a file about each
        model.opt.tolerance = TOLERANCE
        for name, limit in zip(self._friction, drives.effort_limits, strict=True):
            servo = model.actuator(name).id
            model.actuator_forcelimited[servo] = math.isfinite(limit)
            model.actuator_forcerange[servo] = (-limit, limit) if math.isfinite(limit) else 0.0
        self.stick('')

    def _tell_servos(self, arrived: np.ndarray, seconds: float) -> None:
        wanted = self._target + seconds * arrived if self._by_rates else arrived
        inside = np.clip(wanted, self._lower, self._upper)
        if self._by_rates:
            self._mechanism.command(self._target, (inside - self._target) / seconds)
        else:
            self._mechanism.command(inside)
        self._target = inside

    def _measured(self) -> Reading:
        mechanism = self._mechanism
        positions, rates, efforts = mechanism.positions, mechanism.rates, mechanism.efforts
        pose = mechanism.hand_pose
        numbers = (*positions, *rates, *efforts, *pose.quaternion, *pose.position)
        if not np.isfinite(numbers).all():
            raise UnstableError(_torn('not every number is finite'))
        if (gap := mechanism.opening) > TORN:
            raise UnstableError(_torn(f'its loops are open by {gap:.2g} m (rad)'))
        return Reading(
            tuple(positions.tolist()), tuple(rates.tolist()), tuple(efforts.tolist()), pose
        )


def _torn(what: str) -> str:
    return (
        f'The mechanism was torn apart: {what}; choose a shorter step of the physics, or a '
        'smaller bandwidth.'
    )
