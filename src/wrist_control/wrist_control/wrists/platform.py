"""What two platforms have in common that six rods join, whatever drives the rods' other ends.

The hand moves in all six directions, joint positions alone fit several poses, and the rods lock
where their six lines no longer hold the hand. A wrist of this kind says where its rods are.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np

from wrist_control.errors import InvalidValueError, UnreachableError
from wrist_control.rotations import IDENTITY, Pose, Vector, to_forearm, turned
from wrist_control.stewart.forward_kinematics import ForwardKinematics, Status
from wrist_control.stewart.geometry import (
    SHORTEST,
    Anchors,
    Line,
    Points,
    anchors,
    checked_anchors,
    hadamard_ratio,
    legs,
    length,
    line,
)
from wrist_control.stewart.solution import Solution
from wrist_control.wrists import body
from wrist_control.wrists.body import Pin, Shape
from wrist_control.wrists.wrist import Clearance, Configuration, Wrist, soft_edge

# The hand stops at this margin; of the paper's platform, 2.5° of yaw before lock. Ten times closer
# its pose cannot be told from its twin beyond lock (NEAR_SINGULAR), and Barker's singular region
# begins; ten times further off, a fifth of the yaw would be lost.
EDGE = 0.01
# The edge is neared over this long, s: a yaw of 1 rad/s slows by 1.8 rad/s². Over a tenth of it
# the hand would stop ten times as hard, and over ten times as much it would brake harder too, all
# at once, since the braking begins where the margin falls fastest.
HORIZON = 0.5


@dataclass(frozen=True)
class Assembly(Configuration):
    """Six joint positions and the pose they hold: positions alone can fit several poses.

    Attributes:
        lines: Direction and moment of each rod, platform axes.
        size: Characteristic length that makes moments comparable with directions, m.
        levers: How fast each rod's end moves along the rod per joint rate: 1 where the joint is
            the rod's length; else m.
    """

    lines: tuple[Line, ...]
    size: float
    levers: tuple[float, ...] = (1.0,) * 6

    @cached_property
    def hadamard_ratio(self) -> float:
        """How well the rods hold the platform: `geometry.hadamard_ratio`."""
        return hadamard_ratio(self.lines, self.size)


@dataclass(frozen=True)
class Platform(Wrist):
    """A platform on six rods.

    Its joint positions come as an `Assembly`; where plain numbers are given, they are taken to
    belong to the assembly that the home pose belongs to, and cost a forward-kinematics solve.

    Attributes:
        far: Positions this much further on than a pose belong to it only if a search finds no
            other that they fit, and positions this close to home's belong to home, m or rad.
        rods: What the operator knows the rods by.
        drive: What the operator knows the joints by, without their numbers.
        measured: What a joint's reading is.
        unit: What it is in.
    """

    twist_size: ClassVar[Literal[3, 6]] = 6
    probe: ClassVar[Vector] = body.ALONG_Z
    far: ClassVar[float]
    rods: ClassVar[str]
    drive: ClassVar[str]
    measured: ClassVar[Literal['length', 'angle']]
    unit: ClassVar[Literal['m', 'rad']]

    def __post_init__(self) -> None:
        """Settle the points, and refuse rods that hold the platform at no pose."""
        super().__post_init__()
        for name in self.point_lists():
            given = getattr(self, name)
            if given is not None:
                object.__setattr__(self, name, checked_anchors(name, given))
        try:
            margin = self.home.hadamard_ratio
        except UnreachableError as error:
            raise InvalidValueError(
                f'There is no home at that home_height: {error} Choose another.'
            ) from error
        if abs(margin) < EDGE:
            raise InvalidValueError(
                f'These anchors do not hold the platform at home (margin {margin:.2g}); choose '
                f'others, or a home_height where the margin is above {EDGE:g}.'
            )

    if TYPE_CHECKING:  # dimensions of every platform, each in the order of its own
        platform_radius: float
        platform_angle: float
        platform_anchors: Points | None
        home_height: float

    @cached_property
    def platform(self) -> Anchors:
        """The platform's anchors p, platform axes, m."""
        given = self.platform_anchors
        return anchors('platform_anchors', given, self.platform_radius, self.platform_angle)

    @cached_property
    def home_pose(self) -> Pose:
        """Where the platform is at home: level and centred at the home height."""
        return Pose(IDENTITY, (0.0, 0.0, self.home_height))

    @cached_property
    def home(self) -> Assembly:  # type: ignore[override]
        """Joint positions that hold the platform at home, on the branch nearest to their zero."""
        return self.inverse(self.home_pose, (0.0,) * 6)

    @property
    @abstractmethod
    def reach(self) -> float:
        """How far a joint moves its rod's end at most, m per m or rad."""

    @abstractmethod
    def inverse(self, pose: Pose, near: Sequence[float]) -> Assembly:
        """Return the joint positions of a pose, on the branch nearest to `near`."""

    @abstractmethod
    def kinematics_at(self, positions: Sequence[float]) -> tuple[ForwardKinematics, Rods]:
        """Return what takes rods to poses while the joints are there, and the rods' lengths, m."""

    @abstractmethod
    def held(self, positions: Sequence[float], pose: Pose) -> Assembly:
        """Return joint positions with the pose that they are known to hold."""

    def assembly_at(self, pose: Pose) -> Assembly:
        """Return the joint positions that hold the platform at a pose, on home's branch.

        Raises:
            UnreachableError: There are none.
        """
        return self.inverse(pose, self.home)

    @cached_property
    def size(self) -> float:
        """Characteristic length: the platform anchors' root mean square distance from P, m."""
        return math.sqrt(sum(x * x + y * y + z * z for x, y, z in self.platform) / 6.0)

    def vectors(self, base: Anchors, pose: Pose) -> list[Vector]:
        """Return the rods from their other ends to the platform, platform axes, m.

        Args:
            base: The other ends, forearm axes, m.
            pose: Where the platform is.

        Raises:
            UnreachableError: An anchor of the platform would lie on a rod's other end.
        """
        vectors = legs(self.platform, base, pose)
        shortest = min(vectors, key=length)
        if not length(shortest) > SHORTEST * self.size:
            name = f'{self.rods}_{vectors.index(shortest) + 1}'
            raise UnreachableError(
                f'{name} would have no length; keep the platform off the base.',
                f'{name} without length',
            )
        return vectors

    def lines_along(self, vectors: Sequence[Vector]) -> tuple[Line, ...]:
        """Return direction and moment of rods, platform axes, from their vectors."""
        return tuple(
            [
                line(vector, length(vector), anchor)
                for vector, anchor in zip(vectors, self.platform, strict=True)
            ]
        )

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (vx, vy, vz, p, q, r) per joint rate, shape (6, 6), platform axes."""
        assembly = self.assembled(positions)
        found: np.ndarray = np.linalg.inv(np.array(assembly.lines)) * assembly.levers
        return found

    def lock_clearance(self, assembly: Assembly) -> Clearance:
        """Return what is left before lock, on home's side of it: the hand never crosses."""
        side = math.copysign(1.0, self.home.hadamard_ratio)
        name = f'the {self.rods}s near lock'
        return soft_edge(name, side * assembly.hadamard_ratio, EDGE, HORIZON)

    def target_pose(self, pose: Pose, twist: Sequence[float], dt: float) -> Pose:
        """Return the pose after a hand twist for a time: along the axes where it started."""
        vx, vy, vz, p, q, r = twist
        dx, dy, dz = to_forearm(pose.quaternion, (vx * dt, vy * dt, vz * dt))
        x, y, z = pose.position
        return Pose(turned(pose.quaternion, (p, q, r), dt), (x + dx, y + dy, z + dz))

    def assembled(self, positions: Sequence[float]) -> Assembly:
        """Return joint positions with the pose that they hold, if need be as home leads there.

        Raises:
            UnreachableError: No pose could be proved to be the one that home leads to.
        """
        if isinstance(positions, Assembly):
            return positions
        return self.held(positions, self._proved(positions, self.home_pose, 'home'))

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the pose that the rods hold.

        Raises:
            UnreachableError: No pose could be proved to be the one that they hold.
        """
        return self.assembled(positions).pose

    def solve(self, positions: Sequence[float], near: Pose | None = None) -> Solution:
        """Return the pose that `near` leads to, and what is proved of it.

        Args:
            positions: Joint positions, m or rad.
            near: A pose before; home when not given.
        """
        kinematics, lengths = self.kinematics_at(positions)
        return kinematics.solve(lengths, near)

    def resolve_assembly(self, positions: Sequence[float], near: Pose) -> Assembly:
        """Return the positions with the pose that the rods hold, continued from a pose before.

        Raises:
            UnreachableError: No pose could be proved to be the one that `near` leads to; or the
                positions are far from there, and are found to fit another pose as well.
        """
        pose = self._proved(positions, near, 'the pose before')
        before = self.inverse(near, positions)
        travel = max(abs(x - y) for x, y in zip(positions, before, strict=True))
        if travel > self.far:
            kinematics, lengths = self.kinematics_at(positions)
            if kinematics.cold_start(lengths).others:
                raise UnreachableError(
                    f'The {self._of(positions)} fit more than one pose; set initial_positions '
                    f'within {self.far:g} {self.unit} of them, or drive the {self.rods}s home.',
                    'more than one assembly',
                )
        return self.held(positions, pose)

    def check_readings(self, readings: Sequence[float]) -> None:
        """Refuse what cannot be the positions of joints.

        Raises:
            InvalidValueError: The text names the joint and says what is valid.
        """
        for joint, reading in zip(self.joints, readings, strict=True):
            if not (math.isfinite(reading) and (self.measured == 'angle' or reading > 0.0)):
                raise InvalidValueError(
                    f'The {self.measured} of {joint.name} is {reading}; it must be finite'
                    f'{" and above 0 m" if self.measured == "length" else ""}.'
                )

    def _of(self, positions: Sequence[float]) -> str:
        return f'{self.measured}s {tuple(positions)} {self.unit}'

    def _proved(self, positions: Sequence[float], near: Pose, name: str) -> Pose:
        solution = self.solve(positions, near)
        if solution.pose is None or solution.status != Status.CONVERGED:
            raise UnreachableError(
                f'The {self._of(positions)} have no pose that {name} is proved to lead to '
                f'({solution.status.name}); check the joint readings.',
                'no proved assembly',
            )
        return solution.pose

    def carried(self, tops: Sequence[Pin], bar: float) -> list[Shape]:
        """Return what the hand is drawn with besides its palm: a frame and its spokes."""
        points = [pin.point for pin in tops]
        spokes = body.rods_between([(body.ORIGIN, point) for point in points], 0.5 * bar)
        return [*body.frame(points, bar), *spokes]


Rods = tuple[float, float, float, float, float, float]


def turn_of(twist: Sequence[float] | np.ndarray) -> Vector:
    """Return the direction of a twist's turn, a unit vector; z where it does not turn."""
    x, y, z = (float(part) for part in twist[3:])
    norm = math.sqrt(x * x + y * y + z * z)
    return (x / norm, y / norm, z / norm) if norm else (0.0, 0.0, 1.0)
