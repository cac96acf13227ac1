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
from wrist_control.wrists.stewart import FAR, Stewart

HOMEWARDS = f'drive it home, until every leg is within {FAR:g} m of its length there.'
MEANINGS = {
    Status.CONVERGED: 'The pose is proved to be the one that the pose before leads to.',
    Status.DIVERGED: f'No pose was found; check the leg readings, and {HOMEWARDS}',
    Status.NEAR_SINGULAR: 'The platform is near lock, and may be on either side of it; none is '
    f'published: {HOMEWARDS}',
}
AT_HOME = 'The pose is proved to be the one that home leads to.'
NO_START = (
    'There is no pose to go on from, and the lengths alone may fit several; none is published: '
    f'{HOMEWARDS}'
)


class ObserverSettings(NamedTuple):
    """What an observer is told once.

    Attributes:
        length_noise: Standard deviation of each length reading, m, six or one for all.
        jump_limit: The fastest that a leg moves, m/s; readings further apart are refused. No
            faster, in the distance in which proofs are stated, moves the platform; where it is
            inf, the legs go straight from one reading to the next.
        gap_limit: After this long without a good pose the platform must be home again, s.
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

    Lengths alone fit several poses, on either side of lock. A pose counts only when the platform
    is proved to be there and nowhere else: at home, or where the pose before leads to, if the
    platform cannot have reached another pose since. Where it can, as near lock or after a gap,
    no pose counts until the platform is home again.

    Home is where every leg is within `FAR` of its length there. That is taken for granted: the
    paper's home lengths fit three poses more, overturned by 93° and beyond lock.
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
        self._near = wrist.home.pose
        self._doubt = NO_START

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
        solution = self._wrist.forward_kinematics.solve(lengths, self._near)
        if good is not None:
            if self._leads_only_to(solution, good, stamp - good.stamp):
                return self._counting(solution, MEANINGS[Status.CONVERGED], lengths, stamp)
            self._good, self._doubt = None, _may_have_crossed(stamp - good.stamp)
        if self._is_home(lengths):
            at_home = self._wrist.forward_kinematics.solve(lengths)
            if at_home.status == Status.CONVERGED:
                return self._counting(at_home, AT_HOME, lengths, stamp)
        return self._not_counting(solution)

    def _leads_only_to(self, solution: Solution, good: Good, dt: float) -> bool:
        """Return whether a pose is proved to be where the platform is: (S13).

        Every other of its lengths is further than the unique radius from this one. The platform
        is no further from the good pose than it moves in dt; where it is seen to move faster than
        the limit says, than it was seen to move.
        """
        if solution.pose is None or solution.status != Status.CONVERGED:
            return False
        if math.isinf(self._settings.jump_limit):
            return True
        travel = self._wrist.forward_kinematics.apart(good.pose, solution.pose)
        reach = max(travel, self._settings.jump_limit * dt)
        return solution.unique_radius > travel + reach

    def _is_home(self, lengths: Sequence[float]) -> bool:
        return all(abs(x - y) <= FAR for x, y in zip(lengths, self._wrist.home, strict=True))

    def _not_counting(self, solution: Solution) -> Observed:
        """Return an answer that is not proved.

        The next is sought near it, or near home: whichever is found, its status alone counts.
        """
        self._near = self._wrist.home.pose if solution.pose is None else solution.pose
        if solution.status == Status.CONVERGED:
            solution = solution._replace(status=Status.UNPROVEN)
        return Observed(solution, None, None, MEANINGS.get(solution.status, self._doubt))

    def _counting(
        self, solution: Solution, message: str, lengths: tuple[float, ...], stamp: float
    ) -> Observed:
        """Return a pose that counts, and go on from it."""
        assert solution.pose is not None
        self._near = solution.pose
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
        if good is None:
            return None
        dt, fastest = stamp - good.stamp, self._settings.jump_limit
        if abs(dt) > self._settings.gap_limit:
            self._good, self._doubt = None, _may_have_crossed(dt)
            return None
        if dt < 0.0:
            raise RefusedError(
                'older than the last',
                f'The reading is {-dt:.3f} s older than the last good one; send them in the order '
                'of their stamps.',
            )
        _refusing('jump', check_jump, lengths, good.lengths, dt, fastest)
        return good


def _may_have_crossed(dt: float) -> str:
    return (
        f'In the {abs(dt):.3g} s since the last proved pose the platform may have crossed a lock, '
        f'and lengths cannot tell the side; none is published: {HOMEWARDS}'
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
