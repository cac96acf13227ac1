"""From six leg lengths to the pose they hold, and how much of that is proved."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial

import numpy as np

from wrist_control.rotations import Pose, Poses
from wrist_control.stewart import assembly, batch, general, quadratics, stages, tracking
from wrist_control.stewart.certificate import make_tuple
from wrist_control.stewart.geometry import Anchors, hadamard_ratio_at
from wrist_control.stewart.measurement import check_lengths, impossible_pair
from wrist_control.stewart.solution import ColdStart, Solution, Solutions, Status
from wrist_control.stewart.stages import Track

# A second pose may be as near as this share of the platform's size: with the paper's, 2.7 mm or
# 0.6°. That is what a leg moves between readings (0.5 m/s at 200 Hz), and what play can amount to.
NEAR_LOCK = 0.01
# The pose made of a trial point is no further from the root than this times the point: 2 / √trace
# of `stages.SMALLEST_TRACE`, √8, and 6 % for what is of second order. Proved as (S10).
POSE_ERROR = 3.0
# What rounding adds to that, as a share of the numbers: 2.3 units in the last place, measured, of
# the quaternion, and one of each product with the size; seven times that.
LAST_ROUNDING = 16.0 * 2.0**-52
# Answers closer than this share of the size are one pose found twice. On one side of lock two
# poses do not come near each other, so anything between rounding and NEAR_LOCK does the same.
SAME_POSE = 1e-6
# Where the fast way stopped higher than this, it has met a lock, where six legs at a time would
# stop as well. Higher costs time alone; lower than LOW the slow way would never be tried.
CLEARLY_HIGH = 2.0 * tracking.LOW


# Looking up a member of an enumeration costs as much as a call.
CONVERGED, UNPROVEN, NEAR_SINGULAR = Status.CONVERGED, Status.UNPROVEN, Status.NEAR_SINGULAR


class Last:
    """The last answer and where it came from: a start from there needs no new linearisation."""

    answer: tuple[Pose | None, Track | None] = (None, None)


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
        self._last = Last()

    def moved_to(self, base: Anchors) -> ForwardKinematics:
        """Return the same platform on other base anchors, m, such as the tips of turning horns.

        What does not depend on them is not computed again, and the last answer is remembered.
        Six legs at a time are solved, also where both sets of anchors are in planes.
        """
        moved = object.__new__(ForwardKinematics)
        moved.platform, moved.base, moved.size, moved.home = (
            self.platform, base, self.size, self.home
        )  # fmt: skip
        moved.planar, moved._any, moved._last = None, general.moved(self._any, base), self._last
        return moved

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
        pose, track = self._last.answer  # one look: another thread may solve, too
        if near is pose and track is not None:
            start, tangent = track.at, track.tangent
        else:
            start, tangent = stages.unknowns(self.home if near is None else near, self.size), None
        if self.planar is not None:
            goal = quadratics.right_side(self.planar, lengths)
            track = tracking.solve_planar(self.planar, goal, start, tangent)
        else:
            goal = general.squares(self._any, lengths)
            track = general.solve_general(self._any, goal, start, tangent)
        if track is not None and track.followed:
            solution = self._solution(track)
            self._last.answer = solution.pose, track
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
                partial(tracking.solve_planar, self.planar),
                partial(quadratics.right_side_at, self.planar),
                quadratics.right_side(self.planar, lengths),
                start,
            )
            if (track is not None and track.followed) or abs(start[6]) > CLEARLY_HIGH:
                return track
        other, _ = stages.follow(
            partial(general.solve_general, self._any),
            partial(general.squares_at, self._any),
            general.squares(self._any, lengths),
            start,
        )
        return other or track

    def _solution(self, track: Track) -> Solution:
        size = self.size
        at, iterations, (error, unique), followed, _ = track
        x, y, _, _, _, _, z, _, _ = at
        bound = size * (POSE_ERROR * error + LAST_ROUNDING * (1.0 + abs(x) + abs(y) + abs(z)))
        status = CONVERGED if followed else UNPROVEN
        if unique < NEAR_LOCK:
            status = NEAR_SINGULAR
        return make_tuple(
            Solution, (stages.pose_of(at, size), status, iterations, bound, size * unique)
        )

    def solve_batch(self, lengths: np.ndarray, near: Pose | Poses | None = None) -> Solutions:
        """Return the poses of many sets of lengths.

        Args:
            lengths: m, shape (n, 6).
            near: One pose before for all, or one for each; home when not given.

        Raises:
            InvalidValueError: Not of those shapes, or a length that is not finite and above 0.
        """
        lengths = batch.checked_lengths(lengths)
        before = batch.checked_near(self.home if near is None else near, len(lengths))
        found = Solutions.unsolved(len(lengths))
        if self.planar is not None:
            for part in batch.chunks(len(lengths)):
                start = batch.unknowns_of(before, self.size, part)
                self._fill(found, part, batch.solve_rows(self.planar, lengths[part], start))
        for row in np.flatnonzero(found.status == Status.DIVERGED).tolist():
            one = batch.pose_in_row(before, row)
            found.put(row, self.solve(tuple(lengths[row].tolist()), one))
        return found

    def _fill(self, found: Solutions, part: slice, tracks: batch.Tracks) -> None:
        at, size = tracks.at, self.size
        found.quaternion[part], found.position[part] = batch.poses_of(at, size)
        found.iterations[part] = tracks.iterations
        reach = 1.0 + np.abs(at[0]) + np.abs(at[1]) + np.abs(at[6])
        found.error_bound[part] = size * (POSE_ERROR * tracks.error + LAST_ROUNDING * reach)
        found.unique_radius[part] = size * tracks.unique
        status = np.where(tracks.unique < NEAR_LOCK, Status.NEAR_SINGULAR, Status.CONVERGED)
        # What the fast way does not prove is solved again one by one.
        found.status[part] = np.where(tracks.followed, status, Status.DIVERGED)

    def assemblies(self, lengths: Sequence[float]) -> tuple[Solution, ...]:
        """Return the different poses above the base that a search finds: there are at least these.

        Each one is proved to be a pose of its own; that there are no others is not. Their status
        is UNPROVEN: which of them is meant, lengths cannot say.
        """
        check_lengths(lengths)
        if self.planar is None:
            tracks = self._searched(lengths, assembly.seeds(self.home))
        else:
            starts = assembly.planar_seeds()
            many = np.broadcast_to(np.asarray(lengths, dtype=float), (starts.shape[1], 6))
            low = assembly.seeds(self.home, assembly.LOW_HEIGHTS, assembly.OVERTURNED)
            tracks = batch.tracks_of(batch.solve_rows(self.planar, many, starts))
            tracks += self._searched(lengths, low)
        return tuple(
            self._solution(track._replace(followed=False))
            for track in assembly.different(tracks)
            if track.at[6] > 0.0
        )

    def _searched(self, lengths: Sequence[float], starts: Sequence[Pose]) -> list[Track]:
        goal = general.squares(self._any, lengths)
        tracks = (
            general.solve_general(self._any, goal, stages.unknowns(start, self.size))
            for start in starts
        )
        return [track for track in tracks if track is not None]

    def cold_start(self, lengths: Sequence[float]) -> ColdStart:
        """Return the pose of lengths when there is no pose before, and others that fit too.

        Raises:
            InvalidValueError: Not six finite lengths above 0.
        """
        solution = self.solve(lengths)
        if solution.status == Status.UNREACHABLE:
            return ColdStart.told(solution, ())
        found = self.assemblies(lengths)
        if solution.pose is None and found:
            solution = min(found, key=self._from_home)
        pose = solution.pose
        if pose is None:
            return ColdStart.told(solution, ())
        side = self._hadamard_ratio(pose)
        others = tuple(
            other
            for other in found
            if other.pose is not None
            and self.apart(other.pose, pose) > SAME_POSE * self.size
            and self._hadamard_ratio(other.pose) * side > 0.0
        )
        return ColdStart.told(solution, others)

    def _hadamard_ratio(self, pose: Pose) -> float:
        return hadamard_ratio_at(self.platform, self.base, self.size, pose)

    def _from_home(self, solution: Solution) -> float:
        assert solution.pose is not None
        return self.apart(solution.pose, self.home)

    def apart(self, one: Pose, other: Pose) -> float:
        """Return the distance of two poses, m, in which `Solution` states its proofs."""
        return apart(one, other, self.size)


def apart(one: Pose, other: Pose, size: float) -> float:
    """Return the distance of two poses, m, in which `Solution` states its proofs."""
    return size * math.dist(stages.unknowns(one, size), stages.unknowns(other, size))
