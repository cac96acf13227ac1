"""From a stream of joint readings to a platform's poses, each proved. No ROS, no clock."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from wrist_control.errors import InvalidValueError, RefusedError
from wrist_control.resolving.joint_order import in_joint_order
from wrist_control.resolving.limits import TOLERANCE
from wrist_control.rotations import Pose
from wrist_control.stewart.forward_kinematics import Solution, Status, apart
from wrist_control.stewart.measurement import (
    check_jump,
    check_possible,
    platform_twist,
    pose_covariance,
)
from wrist_control.wrists.platform import Platform

MEANINGS = {
    Status.CONVERGED: 'The pose is proved to be the one that the pose before leads to.',
    Status.DIVERGED: 'No pose was found; check the joint readings, and ',
    Status.NEAR_SINGULAR: 'The platform is near lock, and may be on either side of it; none is '
    'published: ',
}
AT_HOME = 'The pose is proved to be the one that home leads to.'


class ObserverSettings(NamedTuple):
    """What an observer is told once.

    Attributes:
        noise: Standard deviation of each reading, m or rad, six or one for all.
        jump_limit: The fastest that a joint moves, m/s or rad/s; readings further apart are
            refused. No faster than its rods' ends, in the distance in which proofs are stated,
            moves the platform; where it is inf, it is where the pose before leads to.
        gap_limit: After this long without a good pose the platform must be home again, s.
    """

    noise: Sequence[float]
    jump_limit: float
    gap_limit: float


class Observed(NamedTuple):
    """What one reading says.

    Attributes:
        solution: The answer and its proof. Its pose counts only when it is CONVERGED.
        covariance: Of the pose, (6, 6): x, y, z, turns about x, y, z, base axes, m² and rad²;
            None where the pose does not count.
        twist: (vx, vy, vz, p, q, r), platform axes; None without joint rates.
        message: One sentence for the operator.
    """

    solution: Solution
    covariance: np.ndarray | None
    twist: tuple[float, ...] | None
    message: str


class Good(NamedTuple):
    """The last good reading and its pose."""

    positions: tuple[float, ...]
    pose: Pose
    stamp: float


class Observer:
    """Follows one platform from reading to reading.

    Readings alone fit several poses, on either side of lock. A pose counts only when the platform
    is proved to be there and nowhere else: at home, or where the pose before leads to, if the
    platform cannot have reached another pose since. Where it can, as near lock or after a gap,
    no pose counts until the platform is home again.

    Home is where every joint is within `Platform.far` of its position there. That is taken for
    granted: the paper's home lengths fit three poses more, overturned by 93° and beyond lock.
    """

    def __init__(self, wrist: Platform, settings: ObserverSettings) -> None:
        """Begin without a pose.

        Args:
            wrist: The platform; readings outside the limits of its joints are refused.
            settings: How good the readings are.

        Raises:
            InvalidValueError: The noise is not one or six finite values of 0 or more.
        """
        name = f'{wrist.measured}_noise'
        if len(settings.noise) not in (1, 6):
            raise InvalidValueError(
                f'{name} has {len(settings.noise)} values; give 1 for all {wrist.drive}s or 6.'
            )
        if not all(math.isfinite(x) and x >= 0.0 for x in settings.noise):
            raise InvalidValueError(
                f'{name} is {settings.noise}; give finite values of 0 {wrist.unit} or more, one '
                'or six.'
            )
        self._wrist, self._settings = wrist, settings
        self._names = [joint.name for joint in wrist.joints]
        self._good: Good | None = None
        self._near = wrist.home.pose
        self._homewards = (
            f'drive it home, until every {wrist.drive} is within {wrist.far:g} {wrist.unit} of '
            f'its {wrist.measured} there.'
        )
        self._doubt = (
            f'There is no pose to go on from, and the {wrist.measured}s alone may fit several; '
            f'none is published: {self._homewards}'
        )

    def take(self, names: Sequence[str], positions: Sequence[float], stamp: float) -> Observed:
        """Return what a reading says of the pose; only a proved one is gone on from.

        Args:
            names: Joint names, in any order; others than the platform's may be among them.
            positions: Their positions, m or rad.
            stamp: When they were read, s.

        Raises:
            RefusedError: The reading does not count; nothing has changed.
        """
        readings = self._checked(names, positions)
        kinematics, lengths = self._wrist.kinematics_at(readings)
        try:
            check_possible(kinematics.platform, kinematics.base, lengths, self._said(readings))
        except InvalidValueError as error:
            none = Solution(None, Status.UNREACHABLE, 0, math.inf, 0.0)
            return Observed(none, None, None, str(error))
        good = self._before(readings, stamp)
        solution = kinematics.solve(lengths, self._near)
        if good is not None:
            if self._leads_only_to(solution, good, stamp - good.stamp):
                return self._counting(solution, MEANINGS[Status.CONVERGED], readings, stamp)
            self._good, self._doubt = None, self._may_have_crossed(stamp - good.stamp)
        if self._is_home(readings):
            at_home = kinematics.solve(lengths)
            if at_home.status == Status.CONVERGED:
                return self._counting(at_home, AT_HOME, readings, stamp)
        return self._not_counting(solution)

    def _said(self, readings: Sequence[float]) -> list[str]:
        """Return what each reading is called in a sentence."""
        unit = self._wrist.unit
        return [f'{name} at {x:g} {unit}' for name, x in zip(self._names, readings, strict=True)]

    def _leads_only_to(self, solution: Solution, good: Good, dt: float) -> bool:
        """Return whether a pose is proved to be where the platform is: (S13).

        Every other that fits is further than the unique radius from this one. The platform
        is no further from the good pose than it moves in dt; where it is seen to move faster than
        the limit says, than it was seen to move.
        """
        if solution.pose is None or solution.status != Status.CONVERGED:
            return False
        if math.isinf(self._settings.jump_limit):
            return True
        travel = apart(good.pose, solution.pose, self._wrist.size)
        reach = max(travel, self._settings.jump_limit * self._wrist.reach * dt)
        return solution.unique_radius > travel + reach

    def _is_home(self, readings: Sequence[float]) -> bool:
        pairs = zip(readings, self._wrist.home, strict=True)
        return all(abs(x - y) <= self._wrist.far for x, y in pairs)

    def _not_counting(self, solution: Solution) -> Observed:
        """Return an answer that is not proved.

        The next is sought near it, or near home: whichever is found, its status alone counts.
        """
        self._near = self._wrist.home.pose if solution.pose is None else solution.pose
        if solution.status == Status.CONVERGED:
            solution = solution._replace(status=Status.UNPROVEN)
        meaning = MEANINGS.get(solution.status)
        message = self._doubt if meaning is None else meaning + self._homewards
        return Observed(solution, None, None, message)

    def _counting(
        self, solution: Solution, message: str, readings: tuple[float, ...], stamp: float
    ) -> Observed:
        """Return a pose that counts, and go on from it."""
        assert solution.pose is not None
        self._near = solution.pose
        self._good = Good(readings, solution.pose, stamp)
        assembly = self._wrist.held(readings, solution.pose)
        noise = np.multiply(self._settings.noise, assembly.levers)
        covariance = pose_covariance(assembly.lines, solution.pose, np.abs(noise).tolist())
        return Observed(solution, covariance, None, message)

    def with_twist(
        self, observed: Observed, names: Sequence[str], velocities: Sequence[float]
    ) -> Observed:
        """Return the same with the platform's twist, where the joint rates tell it.

        Args:
            observed: What the positions of the same reading say.
            names: Joint names.
            velocities: Their rates, m/s or rad/s; none, or nan for every joint, where they are
                not known.

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
                    f'The velocity of {name} is {rate:g} {self._wrist.unit}/s; valid is up to '
                    f'jump_limit, {self._settings.jump_limit:g} {self._wrist.unit}/s.',
                )
        good = self._good
        assert good is not None
        assembly = self._wrist.held(good.positions, good.pose)
        along = np.multiply(rates, assembly.levers).tolist()
        return observed._replace(twist=platform_twist(assembly.lines, along))

    def _checked(self, names: Sequence[str], positions: Sequence[float]) -> tuple[float, ...]:
        readings = in_joint_order(self._names, names, positions)
        finite = all(math.isfinite(x) for x in readings)
        reason = f'impossible {self._wrist.measured}' if finite else 'not finite'
        _refusing(reason, self._wrist.check_readings, readings)
        unit = self._wrist.unit
        for joint, reading in zip(self._wrist.joints, readings, strict=True):
            if not joint.lower - TOLERANCE <= reading <= joint.upper + TOLERANCE:
                raise RefusedError(
                    'outside its limits',
                    f'{joint.name} is at {reading:g} {unit}; valid is {joint.lower:g} to '
                    f'{joint.upper:g} {unit}: check its reading, or the limits.',
                )
        return readings

    def _before(self, readings: Sequence[float], stamp: float) -> Good | None:
        """Return the good reading to go on from; None where there is none, or it is too long ago.

        A clock that goes back by more than the gap has been set again.
        """
        good = self._good
        if good is None:
            return None
        dt, fastest = stamp - good.stamp, self._settings.jump_limit
        if abs(dt) > self._settings.gap_limit:
            self._good, self._doubt = None, self._may_have_crossed(dt)
            return None
        if dt < 0.0:
            raise RefusedError(
                'older than the last',
                f'The reading is {-dt:.3f} s older than the last good one; send them in the order '
                'of their stamps.',
            )
        words = self._wrist.drive, self._wrist.unit
        _refusing('jump', check_jump, readings, good.positions, dt, fastest, *words)
        return good

    def _may_have_crossed(self, dt: float) -> str:
        return (
            f'In the {abs(dt):.3g} s since the last proved pose the platform may have crossed a '
            f'lock, and {self._wrist.measured}s cannot tell the side; none is published: '
            f'{self._homewards}'
        )


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
