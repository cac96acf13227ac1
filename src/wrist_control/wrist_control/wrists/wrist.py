"""What every wrist answers. One mechanism is one file beside this one."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar, Literal, NamedTuple, TypeAlias, TypeVar, overload

import numpy as np

from wrist_control.rotations import Pose, Vector, turned
from wrist_control.wrists import joint as joint_limits
from wrist_control.wrists.body import ALONG_X, Body, plain_bodies
from wrist_control.wrists.dimension import (
    Dimension,
    PointList,
    Text,
    dimensions_of,
    point_lists_of,
    texts_of,
)
from wrist_control.wrists.joint import Joint, Limits

Rates = tuple[float, ...]
SteeringState = tuple[float, ...]
SomeWrist = TypeVar('SomeWrist', bound='Wrist')


@dataclass(frozen=True)
class Configuration(Sequence[float]):
    """Joint positions together with the pose that they hold.

    For a mechanism whose joint positions alone fit several poses. It reads as a sequence of its
    positions and stands wherever joint positions are asked for; a resolver's `State` carries it
    from step to step. `tuple()` of it is the positions alone.

    Attributes:
        positions: Joint positions, rad or m.
        pose: The pose of the hand that they hold.
    """

    positions: tuple[float, ...]
    pose: Pose

    def __len__(self) -> int:
        return len(self.positions)

    def __iter__(self) -> Iterator[float]:
        return iter(self.positions)

    @overload
    def __getitem__(self, index: int) -> float: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[float, ...]: ...

    def __getitem__(self, index: int | slice) -> float | tuple[float, ...]:
        return self.positions[index]


Positions: TypeAlias = 'tuple[float, ...] | Configuration'


class Clearance(NamedTuple):
    """A limit of the whole mechanism: its name and what is left of it, below 0 outside.

    Attributes:
        name: What the operator knows the limit by.
        remaining: What is left of it; continuous in the joint positions.
        horizon: What is left may not shrink faster than `remaining / horizon`, s: above 0 the
            hand slows on approach, at 0 it runs up to the limit and stops there.
    """

    name: str
    remaining: float
    horizon: float = 0.0


def soft_edge(name: str, distance: float, stop: float = 0.02, horizon: float = 0.1) -> Clearance:
    """Return the clearance before an edge that the hand nears slowly and never touches.

    Args:
        name: What the operator knows the edge by.
        distance: How far the edge is, as a share of about 1: the sine of an angle, or a margin.
        stop: The hand stops this far before the edge. Closer, two assemblies of the mechanism
            are too near to each other, or its joints too fast, to be told what to do.
        horizon: The edge is neared over about this time, s, so that the hand arrives slowly.
    """
    return Clearance(name, distance - stop, horizon)


@dataclass(frozen=True)
class Wrist(ABC):
    """A mechanism that turns a hand. Subclasses answer for one mechanism each.

    Joint positions are tuples of floats in the order of `joints`. A hand twist is (p, q, r), the
    rates about the hand's own x, y, z axes in rad/s; a wrist that also translates on command
    (`twist_size` 6) takes (vx, vy, vz, p, q, r), all in hand axes.

    Five answers every wrist must give: `forward`, `inverse`, `jacobian`, `rates` and `margin`.
    The others have an answer already that is right for a mechanism with as many joints as
    freedoms, no limits but its joints' own, and one pose for each set of joint positions.

    Attributes:
        joints: The driven joints, outermost first, with their limits.
        default_joints: The same, without a caller's limits.
        twist_size: 3, or 6 for a wrist that also translates on command.
        followed_axes: The hand axes that it turns about on command, 0 to 2 for x, y, z. A pointer
            has (0, 1): its roll is what the mechanism forces.
        probe: Where the probe that the hand is drawn with ends, hand axes, m.
    """

    joints: tuple[Joint, ...] = field(default=(), kw_only=True)

    default_joints: ClassVar[tuple[Joint, ...]] = ()
    twist_size: ClassVar[Literal[3, 6]] = 3
    followed_axes: ClassVar[tuple[int, ...]] = (0, 1, 2)
    probe: ClassVar[Vector] = ALONG_X

    def __post_init__(self) -> None:
        """Check every dimension and settle the joints.

        Raises:
            InvalidValueError: A dimension that is not valid.
            TypeError: A subclass without `default_joints`.
        """
        for name, facts in self.dimensions().items():
            facts.check(name, getattr(self, name))
        if not (self.joints or self.default_joints):
            raise TypeError(f'{type(self).__name__} names no joints: give it default_joints.')
        if not self.joints:
            object.__setattr__(self, 'joints', self.default_joints)

    @classmethod
    def dimensions(cls) -> dict[str, Dimension]:
        """Return the mechanism's own dimensions by name."""
        return dimensions_of(cls)

    @classmethod
    def point_lists(cls) -> dict[str, PointList]:
        """Return the mechanism's own lists of points by name."""
        return point_lists_of(cls)

    @classmethod
    def texts(cls) -> dict[str, Text]:
        """Return the texts that the mechanism is described by, by name."""
        return texts_of(cls)

    @property
    def home(self) -> Positions:
        """Joint positions to start from when nothing else is asked for; 0 unless overridden."""
        return (0.0,) * len(self.joints)

    @cached_property
    def followed_components(self) -> tuple[int, ...]:
        """The components of a command that it can follow, as indices; the rest is forced."""
        linear = self.twist_size - 3
        return (*range(linear), *(linear + axis for axis in self.followed_axes))

    @cached_property
    def limits_acceleration(self) -> bool:
        """Whether there is a joint whose rate may not change at once."""
        return any(
            math.isfinite(limit)
            for joint in self.joints
            for limit in (joint.acceleration_limit, joint.deceleration_limit)
        )

    @abstractmethod
    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the pose of the hand in the forearm frame.

        Raises:
            UnreachableError: The mechanism cannot be assembled at these positions.
        """

    @abstractmethod
    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return the joint positions of a pose, on the branch nearest to `near`.

        Raises:
            UnreachableError: The pose is out of reach.
        """

    @abstractmethod
    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return the hand twist per joint rate, shape (twist_size, joints), hand axes."""

    @abstractmethod
    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return the joint rates that a hand twist needs; finite away from `margin` 0.

        Where the mechanism cannot do all of the twist, the rates do the part that it can.
        """

    @abstractmethod
    def margin(self, positions: Sequence[float]) -> float:
        """Return how far from singular: 0 at lock, at most about 1.

        A growing function of the least singular value of what `rates` invert.
        """

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left of each limit that is not a joint's own.

        For a mechanism with a cone, a closure or another edge of its workspace: each reaches 0
        before `inverse` fails there.
        """
        return ()

    def target_pose(self, pose: Pose, twist: Sequence[float], dt: float) -> Pose:
        """Return the pose to aim for after moving with a hand twist for a time.

        A wrist overrides it when the hand cannot follow every twist, or moves as it turns; only
        what the mechanism can do needs to be right: `inverse` must accept it.

        Raises:
            UnreachableError: There is no such pose.
        """
        p, q, r = twist
        return Pose(turned(pose.quaternion, (p, q, r), dt), pose.position)

    def choose_branch_reference(
        self, positions: Positions, factor: float, dt: float, steering_state: SteeringState
    ) -> tuple[Positions, SteeringState]:
        """Return the `near` for the coming `inverse`, and the steering state after the step.

        A wrist with more joints than it needs overrides it, and chooses here how to use them.

        Args:
            positions: Where the joints are.
            factor: The scale factor F of the coming step, 0 to 1; the choice slows with it.
            dt: Duration of the step, s.
            steering_state: What this method returned for the step before, or () at the start.
        """
        return positions, steering_state

    def resolve_assembly(self, positions: Sequence[float], near: Pose) -> Positions:
        """Return joint positions that say which pose they hold.

        A wrist whose joint positions alone fit several poses overrides it, and returns a
        `Configuration`.

        Args:
            positions: Joint positions as plain numbers, rad or m.
            near: The pose of the hand before; what follows from it without a jump is meant.

        Raises:
            UnreachableError: The mechanism cannot be assembled there, or it is not sure how.
        """
        return tuple(positions)

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return what a person sees of the mechanism: the forearm first, the hand last.

        A wrist overrides it to show more than those two. Shapes and pins stay as they are in
        their bodies' axes: only the bodies' poses depend on the joints.

        Raises:
            UnreachableError: The mechanism cannot be assembled at these positions.
        """
        return plain_bodies(self.forward(positions), self.probe)

    def lost_axis(self, positions: Sequence[float]) -> Vector:
        """Return the rotation on command that is hardest to make, a unit vector in hand axes."""
        return self.hardest_rotation(self.jacobian(positions)[-3:])

    def hardest_rotation(self, jacobian: np.ndarray) -> Vector:
        """Return the direction of the least singular value among the axes that are followed.

        Args:
            jacobian: (p, q, r) per rate of the joints that the command moves, shape (3, joints).
        """
        axes = list(self.followed_axes)
        found = np.zeros(3)
        found[axes] = np.linalg.svd(jacobian[axes])[0][:, -1]
        x, y, z = found.tolist()
        return (x, y, z)

    def with_limits(
        self: SomeWrist,
        rates: Limits = None,
        lower: Limits = None,
        upper: Limits = None,
        accelerations: Limits = None,
        decelerations: Limits = None,
    ) -> SomeWrist:
        """Return the same wrist with other joint limits, one for all joints or one for each.

        Raises:
            InvalidValueError: Wrong number of values, a limit that is no number, one of rates or
                their changes that is not above 0, or limits that cross.
        """
        joints = joint_limits.with_limits(
            self.joints, rates, lower, upper, accelerations, decelerations
        )
        return replace(self, joints=joints)
