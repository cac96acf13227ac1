"""What every wrist answers. One mechanism is one file beside this one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any, ClassVar, Literal, NamedTuple, TypeVar

import numpy as np

from wrist_control.errors import InvalidValueError
from wrist_control.rotations import Pose, turned

Positions = tuple[float, ...]
Memory = tuple[float, ...]
Kind = Literal['revolute', 'prismatic']
SomeWrist = TypeVar('SomeWrist', bound='Wrist')


class Joint(NamedTuple):
    """One driven joint: rad and rad/s, or m and m/s for a prismatic one."""

    name: str
    kind: Kind = 'revolute'
    lower: float = -math.inf
    upper: float = math.inf
    rate_limit: float = math.inf


class Clearance(NamedTuple):
    """A limit of the whole mechanism: its name and what is left of it, below 0 outside.

    Attributes:
        name: What the operator knows the limit by.
        room: What is left of it; continuous in the joint positions.
        horizon: The room may not shrink faster than `room / horizon`, s: above 0 the hand slows
            on approach, at 0 it runs up to the limit and stops there.
    """

    name: str
    room: float
    horizon: float = 0.0


def parameter(
    default: float, description: str, unit: str, minimum: float, maximum: float = math.inf
) -> Any:
    """Return a dataclass field for a dimension of a mechanism, with what is valid for it.

    The resolver node declares its ROS parameter from the same facts.
    """
    facts = {
        'description': description,
        'unit': unit,
        'minimum': minimum,
        'maximum': maximum,
    }
    return field(default=default, metadata=facts)


def points(description: str) -> Any:
    """Return a dataclass field for points in a row, x, y, z of each in m; None when not given."""
    return field(default=None, metadata={'points': description})


@dataclass(frozen=True)
class Wrist:
    """A mechanism that turns a hand. Subclasses answer for one mechanism each.

    Joint positions are tuples of floats in the order of `joints`. A hand twist is (p, q, r), the
    rates about the hand's own x, y, z axes in rad/s; a wrist that also translates on command
    (`twist_size` 6) takes (vx, vy, vz, p, q, r), all in hand axes.

    Attributes:
        joints: The driven joints, outermost first, with their limits.
    """

    joints: tuple[Joint, ...] = field(default=(), kw_only=True)

    default_joints: ClassVar[tuple[Joint, ...]]
    twist_size: ClassVar[Literal[3, 6]] = 3

    def __post_init__(self) -> None:
        """Check every dimension and settle the joints."""
        for dimension in fields(self):
            if 'minimum' in dimension.metadata:
                _check_dimension(dimension.name, getattr(self, dimension.name), dimension.metadata)
        if not self.joints:
            object.__setattr__(self, 'joints', self.default_joints)

    @classmethod
    def dimensions(cls) -> dict[str, tuple[Any, Any]]:
        """Return the mechanism's own parameters: name to default and what is valid."""
        return {
            own.name: (own.default, own.metadata)
            for own in fields(cls)
            if 'minimum' in own.metadata
        }

    @classmethod
    def point_lists(cls) -> dict[str, str]:
        """Return the mechanism's own lists of points: name to description."""
        return {
            own.name: own.metadata['points'] for own in fields(cls) if 'points' in own.metadata
        }

    @property
    def home(self) -> Positions:
        """Joint positions to start from when nothing else is asked for."""
        return (0.0,) * len(self.joints)

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the pose of the hand in the forearm frame.

        Raises:
            UnreachableError: The mechanism cannot be assembled at these positions.
        """
        raise NotImplementedError

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return the joint positions of a pose, on the branch nearest to `near`.

        Raises:
            UnreachableError: The pose is out of reach.
        """
        raise NotImplementedError

    def assembled(self, positions: Sequence[float], near: Pose) -> Positions:
        """Return joint positions that know which pose they hold, where numbers alone do not.

        Args:
            positions: Joint positions as plain numbers, rad or m.
            near: The pose of the hand before; what follows from it without a jump is meant.

        Raises:
            UnreachableError: The mechanism cannot be assembled there, or it is not sure how.
        """
        return tuple(positions)

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return the hand twist per joint rate, shape (twist_size, joints), hand axes."""
        raise NotImplementedError

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Positions:
        """Return the joint rates that a hand twist needs; finite away from `margin` 0.

        Where the mechanism cannot do all of the twist, the rates do the part that it can.
        """
        raise NotImplementedError

    def margin(self, positions: Sequence[float]) -> float:
        """Return how far from singular: 0 at lock, at most about 1."""
        raise NotImplementedError

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left of each limit that is not a joint's own."""
        return ()

    def advance(self, pose: Pose, twist: Sequence[float], dt: float) -> Pose:
        """Return the pose to aim for after moving with a hand twist for a time.

        Only what the mechanism can do needs to be right: `inverse` must accept it.
        """
        p, q, r = twist
        return Pose(turned(pose.quaternion, (p, q, r), dt), pose.position)

    def steer(
        self, positions: Positions, factor: float, dt: float, memory: Memory
    ) -> tuple[Positions, Memory]:
        """Return the `near` for the coming `inverse`, and what to remember for the next step.

        A wrist with more joints than it needs chooses here how to use them.

        Args:
            positions: Where the joints are.
            factor: The scale factor F of the coming step, 0 to 1; the choice slows with it.
            dt: Duration of the step, s.
            memory: What this method returned for the step before, or () at the start.
        """
        return positions, memory

    def lost_axis(self, positions: Sequence[float]) -> tuple[float, float, float]:
        """Return the rotation that is hardest to make, a unit vector in hand axes."""
        angular = self.jacobian(positions)[-3:]
        x, y, z = np.linalg.svd(angular)[0][:, -1]
        return (float(x), float(y), float(z))

    def with_limits(
        self: SomeWrist,
        rates: float | Sequence[float] | None = None,
        lower: float | Sequence[float] | None = None,
        upper: float | Sequence[float] | None = None,
    ) -> SomeWrist:
        """Return the same wrist with other joint limits, one for all joints or one for each.

        Raises:
            InvalidValueError: Wrong number of values, a limit that is no number, a rate limit
                that is not above 0, or limits that cross.
        """
        kept = self.joints
        new_rates = self._spread('joint_rate_limits', rates, [j.rate_limit for j in kept])
        new_lower = self._spread('joint_lower_limits', lower, [j.lower for j in kept])
        new_upper = self._spread('joint_upper_limits', upper, [j.upper for j in kept])
        joints = tuple(
            joint._replace(rate_limit=rate, lower=low, upper=high)
            for joint, rate, low, high in zip(kept, new_rates, new_lower, new_upper, strict=True)
        )
        for joint in joints:
            _check_joint(joint)
        return replace(self, joints=joints)

    def _spread(
        self, name: str, given: float | Sequence[float] | None, otherwise: list[float]
    ) -> list[float]:
        if given is None:
            return otherwise
        values = one_for_each(
            name,
            [float(v) for v in np.atleast_1d(np.asarray(given, dtype=float))],
            [joint.name for joint in self.joints],
        )
        if any(math.isnan(v) for v in values):
            raise InvalidValueError(f'{name} is {values}; every value must be a number.')
        return values


def one_for_each(name: str, values: Sequence[float], joints: Sequence[str]) -> list[float]:
    """Return one value for each joint, where one for each or one for all is given.

    Raises:
        InvalidValueError: Another number of values.
    """
    if len(values) == 1:
        return [*values] * len(joints)
    if len(values) != len(joints):
        raise InvalidValueError(
            f'{name} has {len(values)} values; give 1 for all joints or one for each of '
            f'{", ".join(joints)}.'
        )
    return [*values]


def _check_dimension(name: str, value: object, facts: Any) -> None:
    minimum, maximum, unit = facts['minimum'], facts['maximum'], facts['unit']
    if isinstance(value, (int, float)) and math.isfinite(value) and minimum <= value <= maximum:
        return
    raise InvalidValueError(
        f'{name} is {value}; valid is {minimum:g} to {maximum:g} {unit} ({facts["description"]}).'
    )


def _check_joint(joint: Joint) -> None:
    if not joint.rate_limit > 0.0:
        raise InvalidValueError(
            f'joint_rate_limits has {joint.rate_limit:g} for {joint.name}; it must be above 0, '
            'or .inf for no limit.'
        )
    if not joint.lower < joint.upper:
        raise InvalidValueError(
            f'The limits of {joint.name} cross: lower {joint.lower:g}, upper {joint.upper:g}; '
            'lower must be below upper.'
        )
