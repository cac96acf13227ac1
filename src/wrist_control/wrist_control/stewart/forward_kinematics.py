"""From six leg lengths to the pose they hold, and how much of that is proved."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import IntEnum
from functools import partial
from typing import NamedTuple

import numpy as np

from wrist_control.rotations import Pose
from wrist_control.stewart import assembly, batch, general, quadratics, stages, tracking
from wrist_control.stewart.certificate import new
from wrist_control.stewart.geometry import Anchors, hadamard_ratio_at
from wrist_control.stewart.measurement import check_lengths, impossible_pair
from wrist_control.stewart.stages import Track

# Nearer than this share of the platform's size to a second root, the two are hard to tell apart.
NEAR_LOCK = 0.01
# What rounding adds to an answer after its proof, as a share of its largest number.
LAST_ROUNDING = 16.0 * 2.0**-52


class Status(IntEnum):
    """What is known of an answer.

    CONVERGED: the pose is proved, and proved to be the one that `near` leads to.
    UNPROVEN: the pose fits the lengths, but it may belong to another assembly than `near`.
    UNREACHABLE: no pose fits the lengths; there is none in the answer.
    DIVERGED: no pose was found; there is none in the answer.
    NEAR_SINGULAR: the pose fits the lengths, but another one is too close to tell them apart.
    """

    CONVERGED = 0
    UNPROVEN = 1
    UNREACHABLE = 2
    DIVERGED = 3
    NEAR_SINGULAR = 4


# Looking up a member of an enumeration costs as much as a call.
CONVERGED, UNPROVEN, NEAR_SINGULAR = Status.CONVERGED, Status.UNPROVEN, Status.NEAR_SINGULAR


class Solution(NamedTuple):
    """An answer with its proof.

    Distances between poses are ‖(Δd, L Δu, L Δv)‖, m: of the position and of the platform's x and
    y axes, with the characteristic length L of the wrist (`Stewart.size`). A pose within e has
    its position within e, and is turned by less than e / L rad.

    Attributes:
        pose: The platform's pose in base axes; None when there is none to give.
        status: What is known of it.
        iterations: Newton steps made, on all stages of the way.
        error_bound: The true pose is within this distance, m; inf when that is not proved.
        unique_radius: No other pose within this distance fits the lengths, m; 0 when not proved.
    """

    pose: Pose | None
    status: Status
    iterations: int
    error_bound: float
    unique_radius: float


class Solutions(NamedTuple):
    """Answers as arrays, one row each; a row without a pose is nan.

    Attributes:
        quaternion: Barker's, shape (n, 4).
        position: m, shape (n, 3).
        status: Values of `Status`, shape (n,).
        iterations: Shape (n,).
        error_bound: m, shape (n,).
        unique_radius: m, shape (n,).
    """

    quaternion: np.ndarray
    position: np.ndarray
    status: np.ndarray
    iterations: np.ndarray
    error_bound: np.ndarray
    unique_radius: np.ndarray


class ColdStart(NamedTuple):
    """What lengths alone say, without a pose before.

    Attributes:
        solution: The pose that home leads to; the nearest of those found where it leads to none.
        others: Other poses that fit the lengths, above the base and on the same side of lock. A
            search found them: there may be more.
        message: One sentence for the operator.
    """

    solution: Solution
    others: tuple[Solution, ...]
    message: str


class ForwardKinematics:
    """The forward kinematics of one platform.

    Attributes:
        home: The pose that lengths are solved from when no other is given.
        size: Characteristic length L, m.
    """

    def __init__(self, platform: Anchors, base: Anchors, size: float, home: Pose) -> None:
        """Settle the equations.

        Args:
            platform: Anchors in platform axes, m.
            base: Anchors in base axes, m.
            size: Characteristic length, m.
            home: An assembled pose; the assembly it belongs to is the one that is meant.
        """
        self.platform, self.base, self.size, self.home = platform, base, size, home
        self.planar = quadratics.coefficients(platform, base, size)
        self._any = general.scaled(platform, base, size)
        # The last answer and where it came from: a start from there needs no new linearisation.
        self._last: tuple[Pose | None, Track | None] = (None, None)

    def solve(self, lengths: Sequence[float], near: Pose | None = None) -> Solution:
        """Return the pose that `near` leads to when its legs go straight to these lengths.

        Straight in the squares of the lengths. Where that way meets a lock, the answer says so
        by its status: nothing but CONVERGED is proved to be the pose that is meant.

        Args:
            lengths: Leg lengths 1 to 6, m.
            near: A pose before; home when not given.

        Raises:
            InvalidValueError: Not six finite lengths above 0; the text says which.
        """
        if len(lengths) != 6:
            check_lengths(lengths)
        l1, l2, l3, l4, l5, l6 = lengths = tuple(map(float, lengths))
        # Six comparisons cost less than min and sum.
        positive = l1 > 0.0 < l2 and l3 > 0.0 < l4 and l5 > 0.0 < l6
        if not positive or math.inf in lengths:
            check_lengths(lengths)
        pose, track = self._last  # one look: another thread may solve, too
        if near is pose and track is not None:
            start, tangent = track.at, track.tangent
        else:
            start, tangent = stages.unknowns(self.home if near is None else near, self.size), None
        if self.planar is not None:
            goal = quadratics.right_side(self.planar, lengths)
            track = tracking.solve(self.planar, goal, start, tangent)
            if track is not None and track.followed:
                solution = self._solution(track)
                self._last = solution.pose, track
                return solution
        return self._solve_far(lengths, start)

    def _solve_far(self, lengths: Sequence[float], start: stages.Unknowns) -> Solution:
        if impossible_pair(self.platform, self.base, lengths):
            return Solution(None, Status.UNREACHABLE, 0, math.inf, 0.0)
        track = self._follow(lengths, start)
        if track is None:
            return Solution(None, Status.DIVERGED, 0, math.inf, 0.0)
        return self._solution(track)

    def _follow(self, lengths: Sequence[float], start: stages.Unknowns) -> Track | None:
        """Follow in stages: by the quadratics, and where z cannot lead by six legs at a time."""
        track = None
        if self.planar is not None:
            track, start = stages.follow(
                partial(tracking.solve, self.planar),
                partial(quadratics.own_side, self.planar),
                quadratics.right_side(self.planar, lengths),
                start,
            )
            if (track is not None and track.followed) or abs(start[6]) > 2.0 * tracking.LOW:
                return track
        other, _ = stages.follow(
            partial(general.solve, self._any),
            partial(general.own_squares, self._any),
            general.squares(self._any, lengths),
            start,
        )
        return other or track

    def _solution(self, track: Track) -> Solution:
        size = self.size
        at, iterations, (error, unique), followed, _ = track
        x, y, _, _, _, _, z, _, _ = at
        # The root is within `error` of the unknowns; making a pose of them moves them no further.
        bound = size * (3.0 * error + LAST_ROUNDING * (1.0 + abs(x) + abs(y) + abs(z)))
        status = CONVERGED if followed else UNPROVEN
        if unique < NEAR_LOCK:
            status = NEAR_SINGULAR
        return new(Solution, (stages.pose_of(at, size), status, iterations, bound, size * unique))

    def solve_batch(self, lengths: np.ndarray, near: Pose | None = None) -> Solutions:
        """Return the poses of many sets of lengths.

        Args:
            lengths: m, shape (n, 6).
            near: One pose before for all, or one for each, as a `Pose` of arrays of shapes
                (n, 4) and (n, 3); home when not given.

        Raises:
            InvalidValueError: Not of those shapes, or a length that is not finite and above 0.
        """
        lengths = batch.checked(lengths)
        near = self.home if near is None else batch.checked_near(near, len(lengths))
        found = Solutions(*batch.empty(len(lengths)))
        if self.planar is not None:
            for part in batch.chunks(len(lengths)):
                start = batch.starts(near, self.size, part)
                self._fill(found, part, batch.solve(self.planar, lengths[part], start))
        for row in np.flatnonzero(found.status == Status.DIVERGED).tolist():
            self._put(found, row, self.solve(tuple(lengths[row].tolist()), batch.row(near, row)))
        return found

    def _fill(self, found: Solutions, part: slice, tracks: batch.Tracks) -> None:
        at, size = tracks.at, self.size
        found.quaternion[part], found.position[part] = batch.poses(at, size)
        found.iterations[part] = tracks.iterations
        reach = 1.0 + np.abs(at[0]) + np.abs(at[1]) + np.abs(at[6])
        found.error_bound[part] = size * (3.0 * tracks.error + LAST_ROUNDING * reach)
        found.unique_radius[part] = size * tracks.unique
        status = np.where(tracks.unique < NEAR_LOCK, Status.NEAR_SINGULAR, Status.CONVERGED)
        # What the fast way does not prove is solved again one by one.
        found.status[part] = np.where(tracks.followed, status, Status.DIVERGED)

    @staticmethod
    def _put(found: Solutions, row: int, solution: Solution) -> None:
        pose = solution.pose
        found.quaternion[row] = math.nan if pose is None else pose.quaternion
        found.position[row] = math.nan if pose is None else pose.position
        found.status[row], found.iterations[row] = solution.status, solution.iterations
        found.error_bound[row] = solution.error_bound
        found.unique_radius[row] = solution.unique_radius

    def assemblies(self, lengths: Sequence[float]) -> tuple[Solution, ...]:
        """Return the different poses above the base that a search finds for lengths.

        Each one is proved to be a pose of its own; that there are no others is not. Their status
        is UNPROVEN: which of them is meant, lengths cannot say.
        """
        check_lengths(lengths)
        starts = assembly.seeds(self.home)
        many = np.tile(np.asarray(lengths, dtype=float), (len(starts.position), 1))
        if self.planar is not None:
            tracks = batch.solve(self.planar, many, batch.starts(starts, self.size))
            candidates = batch.tracks_of(tracks)
        else:
            goal = general.squares(self._any, lengths)
            candidates = [
                track
                for row in range(len(many))
                if (track := general.solve(self._any, goal, self._seed(starts, row)))
            ]
        different = assembly.different(candidates)
        return tuple(
            self._solution(track._replace(followed=False))
            for track in different
            if track.at[6] > 0.0
        )

    def _seed(self, starts: Pose, row: int) -> stages.Unknowns:
        return stages.unknowns(batch.row(starts, row), self.size)

    def cold_start(self, lengths: Sequence[float]) -> ColdStart:
        """Return the pose of lengths when there is no pose before, and whether others fit too.

        Raises:
            InvalidValueError: Not six finite lengths above 0.
        """
        solution = self.solve(lengths)
        if solution.status == Status.UNREACHABLE:
            return ColdStart(solution, (), 'No pose fits these lengths; check the leg readings.')
        found = self.assemblies(lengths)
        if solution.pose is None and found:
            solution = min(found, key=lambda other: self._apart(other, self.home))
        pose = solution.pose
        if pose is None:
            return ColdStart(solution, (), 'No pose was found; check the leg readings.')
        side = self._hold(pose)
        others = tuple(
            other
            for other in found
            if self._apart(other, pose) > 1e-6 * self.size
            and other.pose is not None
            and self._hold(other.pose) * side > 0.0
        )
        return ColdStart(solution, others, _message(solution, len(others)))

    def _hold(self, pose: Pose) -> float:
        return hadamard_ratio_at(self.platform, self.base, self.size, pose)

    def _apart(self, solution: Solution, pose: Pose) -> float:
        assert solution.pose is not None
        one, other = (stages.unknowns(p, self.size) for p in (solution.pose, pose))
        return self.size * math.dist(one, other)


def _message(solution: Solution, others: int) -> str:
    if solution.status == Status.CONVERGED:
        known = 'The pose is proved to be the one that home leads to'
    elif solution.status == Status.NEAR_SINGULAR:
        known = 'The platform is near lock, and its pose is not sure'
    else:
        known = 'A pose fits, but home does not lead to it'
    if not others:
        return f'{known}; a search found no other.'
    return f'{known}; the lengths alone also fit {others} other pose(s): drive home to be sure.'
