"""From a stream of leg readings to poses, each of them proved. No ROS, no clock."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from wrist_control.errors import InvalidValueError, RefusedError
from wrist_control.resolving.joint_order import in_joint_order
from wrist_control.resolving.limits import TOLERANCE
from wrist_control.rotations import Pose
from wrist_control.stewart.forward_kinematics import Solution, Status
from wrist_control.stewart.measurement import (
    check_jump,
    check_lengths,
    check_possible,
    platform_twist,
    pose_covariance,
)
from wrist_control.wrists.stewart import Stewart

# A search that was in vain is not made again sooner, s. It takes 30 to 150 ms, longer than a
# reading may: so seldom, readings at 100 Hz keep up, and who moves a leg waits no longer.
SEARCH_PERIOD = 1.0
MEANINGS = {
    Status.CONVERGED: 'The pose is proved to be the one that the pose before leads to.',
    Status.UNPROVEN: 'A pose fits, but it is not proved to be the one that the pose before leads '
    'to; none is published: move the platform back.',
    Status.UNREACHABLE: 'No pose fits these lengths; check the leg readings.',
    Status.DIVERGED: 'No pose was found; the last good pose stands: check the leg readings.',
    Status.NEAR_SINGULAR: 'The platform is near lock, and its pose is not sure; none is '
    'published: move the platform back.',
}


class ObserverSettings(NamedTuple):
    """What an observer is told once.

    Attributes:
        length_noise: Standard deviation of each length reading, m, six or one for all.
        jump_limit: The fastest that a leg moves, m/s; readings further apart are refused.
        gap_limit: After this long without a good pose the search from home starts again, s.
    """

    length_noise: Sequence[float]
    jump_limit: float
    gap_limit: float


class Observed(NamedTuple):
    """What one reading says.

    Attributes:
        solution: The answer and its proof. Its pose counts only when it is CONVERGED.
        covariance: Of the pose, (6, 6): x, y, z, turns about x, y, z, base axes, m² and rad²;
            None where the pose does not count.
        twist: (vx, vy, vz, p, q, r), platform axes; None without leg rates.
        message: One sentence for the operator.
    """

    solution: Solution
    covariance: np.ndarray | None
    twist: tuple[float, ...] | None
    message: str


class Good(NamedTuple):
    """The last good reading and its pose."""

    lengths: tuple[float, ...]
    pose: Pose
    stamp: float


class Observer:
    """Follows one platform from reading to reading.

    A pose counts only when it is proved to be the one that the pose before leads to. The first
    pose is the one that home leads to, when a search finds no other that fits: which of several is
    meant, lengths cannot say. That the platform is on home's side of lock is taken for granted.
    """

    def __init__(self, wrist: Stewart, settings: ObserverSettings) -> None:
        """Begin without a pose.

        Args:
            wrist: The platform; readings outside the limits of its joints are refused.
            settings: How good the readings are.

        Raises:
            InvalidValueError: `length_noise` is not one or six finite values of 0 m or more.
        """
        if len(settings.length_noise) not in (1, 6):
            raise InvalidValueError(
                f'length_noise has {len(settings.length_noise)} values; give 1 for all legs or 6.'
            )
        pose_covariance(wrist.home.lines, wrist.home.pose, settings.length_noise)
        self._wrist, self._settings = wrist, settings
        self._names = [joint.name for joint in wrist.joints]
        self._good: Good | None = None
        self._searched = -math.inf
        self._found = ''

    def take(self, names: Sequence[str], positions: Sequence[float], stamp: float) -> Observed:
        """Return what a reading says of the pose; only a proved one is gone on from.

        Args:
            names: Joint names, in any order; others than the legs may be among them.
            positions: Their positions, m.
            stamp: When they were read, s.

        Raises:
            RefusedError: The reading does not count; nothing has changed.
        """
        lengths = self._checked(names, positions)
        try:
            check_possible(self._wrist.platform, self._wrist.base, lengths)
        except InvalidValueError as error:
            none = Solution(None, Status.UNREACHABLE, 0, math.inf, 0.0)
            return Observed(none, None, None, str(error))
        good = self._before(lengths, stamp)
        if good is None:
            solution, message = self._first(lengths, stamp)
        else:
            solution = self._wrist.forward_kinematics.solve(lengths, good.pose)
            message = MEANINGS[solution.status]
        if solution.pose is None or solution.status != Status.CONVERGED:
            return Observed(solution, None, None, message)
        self._good = Good(lengths, solution.pose, stamp)
        lines = self._wrist.assembly_at(solution.pose).lines
        noise = self._settings.length_noise
        return Observed(solution, pose_covariance(lines, solution.pose, noise), None, message)

    def with_twist(
        self, observed: Observed, names: Sequence[str], velocities: Sequence[float]
    ) -> Observed:
        """Return the same with the platform's twist, where the leg rates tell it.

        Args:
            observed: What the positions of the same reading say.
            names: Joint names.
            velocities: Their rates, m/s; none, or nan for every leg, where they are not known.

        Raises:
            RefusedError: Rates that cannot be; the pose stands.
        """
        if observed.covariance is None or observed.solution.pose is None or not len(velocities):
            return observed
        rates = in_joint_order(self._names, names, velocities)
        if all(math.isnan(rate) for rate in rates):
            return observed
        for name, rate in zip(self._names, rates, strict=True):
            if not abs(rate) <= self._settings.jump_limit or math.isinf(rate):
                raise RefusedError(
                    'impossible velocity',
                    f'The velocity of {name} is {rate:g} m/s; valid is up to jump_limit, '
                    f'{self._settings.jump_limit:g} m/s.',
                )
        lines = self._wrist.assembly_at(observed.solution.pose).lines
        return observed._replace(twist=platform_twist(lines, rates))

    def _checked(self, names: Sequence[str], positions: Sequence[float]) -> tuple[float, ...]:
        lengths = in_joint_order(self._names, names, positions)
        finite = all(math.isfinite(x) for x in lengths)
        _refusing('impossible length' if finite else 'not finite', check_lengths, lengths)
        for joint, length in zip(self._wrist.joints, lengths, strict=True):
            if not joint.lower - TOLERANCE <= length <= joint.upper + TOLERANCE:
                raise RefusedError(
                    'outside its limits',
                    f'{joint.name} is {length:g} m long; valid is {joint.lower:g} to '
                    f'{joint.upper:g} m: check its reading, or the limits.',
                )
        return lengths

    def _before(self, lengths: Sequence[float], stamp: float) -> Good | None:
        """Return the good reading to go on from; None where there is none, or it is too long ago.

        A clock that goes back by more than the gap has been set again.
        """
        good = self._good
        if good is None or abs(stamp - good.stamp) > self._settings.gap_limit:
            return None
        if stamp < good.stamp:
            raise RefusedError(
                'older than the last',
                f'The reading is {good.stamp - stamp:.3f} s older than the last good one; send '
                'them in the order of their stamps.',
            )
        dt, fastest = stamp - good.stamp, self._settings.jump_limit
        _refusing('jump', check_jump, lengths, good.lengths, dt, fastest)
        return good

    def _first(self, lengths: Sequence[float], stamp: float) -> tuple[Solution, str]:
        """Return the pose when there is none before: proved, and the only one that was found."""
        if 0.0 <= stamp - self._searched < SEARCH_PERIOD:
            solution = self._wrist.forward_kinematics.solve(lengths)
            return self._unsure(solution), self._found
        cold = self._wrist.forward_kinematics.cold_start(lengths)
        if cold.solution.status == Status.CONVERGED and not cold.others:
            return cold.solution, cold.message
        self._searched, self._found = stamp, cold.message
        return self._unsure(cold.solution), cold.message

    @staticmethod
    def _unsure(solution: Solution) -> Solution:
        if solution.status == Status.CONVERGED:
            return solution._replace(status=Status.UNPROVEN)
        return solution


def _refusing(reason: str, check: Callable[..., Any], *values: Any) -> Any:
    try:
        return check(*values)
    except InvalidValueError as error:
        raise RefusedError(reason, str(error)) from error


def in_metres_and_radians(solution: Solution, size: float) -> tuple[float, float]:
    """Return the error bound and the unique radius by the norm of (translation m, turn rad).

    A solution measures by D = ‖(Δd, L Δu, L Δv)‖. A turn by φ moves the ends of u and v so that
    4 sin²(φ/2) ≤ ‖Δu‖² + ‖Δv‖² ≤ 8 sin²(φ/2), and 2φ/π ≤ 2 sin(φ/2) ≤ φ up to half a turn.
    So ‖(Δd, φ)‖ ≤ D max(1, π / 2L), and D ≤ ‖(Δd, φ)‖ max(1, √2 L): both bounds stay sound.

    Args:
        solution: What to convert.
        size: Characteristic length L, m.

    Returns:
        The error bound, inf where nothing is proved, and the unique radius.
    """
    error = solution.error_bound * max(1.0, 0.5 * math.pi / size)
    return error, solution.unique_radius / max(1.0, math.sqrt(2.0) * size)
