"""Answers of the forward kinematics: what their numbers mean, and what is known of them."""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np

from wrist_control.rotations import Pose


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

    @staticmethod
    def unsolved(n: int) -> Solutions:
        """Return room for n answers, all of them DIVERGED so far."""
        return Solutions(
            np.full((n, 4), math.nan),
            np.full((n, 3), math.nan),
            np.full(n, int(Status.DIVERGED)),
            np.zeros(n, dtype=int),
            np.full(n, math.inf),
            np.zeros(n),
        )

    def put(self, row: int, solution: Solution) -> None:
        """Write one answer into its row."""
        pose = solution.pose
        self.quaternion[row] = math.nan if pose is None else pose.quaternion
        self.position[row] = math.nan if pose is None else pose.position
        self.status[row], self.iterations[row] = solution.status, solution.iterations
        self.error_bound[row] = solution.error_bound
        self.unique_radius[row] = solution.unique_radius


class ColdStart(NamedTuple):
    """What lengths alone say, without a pose before.

    Attributes:
        solution: The pose that home leads to; the nearest of those found where it leads to none.
        others: Other poses that fit the lengths, above the base and on the same side of lock. A
            search found them: there are at least so many, and none found does not prove that the
            pose is the only one.
        message: One sentence for the operator.
    """

    solution: Solution
    others: tuple[Solution, ...]
    message: str

    @staticmethod
    def told(solution: Solution, others: tuple[Solution, ...]) -> ColdStart:
        """Return the same with the sentence that belongs to it."""
        if solution.status == Status.UNREACHABLE:
            return ColdStart(solution, (), 'No pose fits these lengths; check the leg readings.')
        if solution.pose is None:
            return ColdStart(solution, (), 'No pose was found; check the leg readings.')
        if solution.status == Status.CONVERGED:
            known = 'The pose is proved to be the one that home leads to'
        elif solution.status == Status.NEAR_SINGULAR:
            known = 'The platform is near lock, and its pose is not sure'
        else:
            known = 'A pose fits, but home does not lead to it'
        fits = (
            f'the lengths alone also fit at least {len(others)} other pose(s): drive home to be '
            'sure.'
            if others
            else 'a search found no other on its side of lock, but there may be one.'
        )
        return ColdStart(solution, others, f'{known}; {fits}')
