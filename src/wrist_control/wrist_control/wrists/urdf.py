"""The wrist of a robot of one's own: two to four joints of its URDF, whatever their axes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from wrist_control.errors import InvalidValueError, UnreachableError
from wrist_control.rotations import (
    Pose,
    Quaternion,
    Vector,
    about,
    conjugate,
    cross,
    dot,
    nearest_turn,
    product,
    rates_between,
    to_forearm,
    to_hand,
    turned,
)
from wrist_control.wrists import body
from wrist_control.wrists.body import Body
from wrist_control.wrists.dimension import dimension, joint_names, text
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.robot_description import serial_chain, text_of
from wrist_control.wrists.serial_axes import HAND_AXES, SerialAxes
from wrist_control.wrists.serial_bodies import serial_bodies
from wrist_control.wrists.spare_joint import increment, share_of_space
from wrist_control.wrists.three_axes import turn_about
from wrist_control.wrists.wrist import Clearance, Positions, Rates, SteeringState, Wrist, soft_edge

# Orientations this far from those of two joints, rad, still count as theirs.
TOLERANCE = 1e-6
# A sine of the spare joint's way to a larger margin that is less than this is round-off: both
# ways are as good, and one is taken.
SIDE = 1e-9

# The smallest robot with a wrist: what a node is made of whose parameters are to be shown.
EXAMPLE = (
    '<robot name="example"><link name="mast"/><link name="yoke"/><link name="head"/>'
    '<joint name="pan" type="continuous"><parent link="mast"/><child link="yoke"/>'
    '<axis xyz="0 0 1"/></joint>'
    '<joint name="tilt" type="continuous"><parent link="yoke"/><child link="head"/>'
    '<axis xyz="0 1 0"/></joint></robot>'
)

chain_of = lru_cache(maxsize=16)(serial_chain)
axes_of = lru_cache(maxsize=16)(SerialAxes)


@dataclass(frozen=True)
class Urdf(Wrist):
    """Two to four revolute joints of a robot; for p, q, r their axes' directions alone count.

    Three turn the hand about all its axes. They lock where their axes lie in a plane, and where
    these are not square to each other, orientations beyond that cannot be reached. Two point the
    hand. Of four, one is steered so that the other three stay away from their lock.

    The forearm is the link that carries the first joint, the hand is the tip.

    Choose it for the arm, the head or the hand that you have.
    """

    description: str = text(
        'XML of the robot, or the name of a file with it', 'robot_description', EXAMPLE
    )
    tip: str = text('Name of the link that is turned', 'tip_link', 'head')
    gain: float = dimension(
        0.8, 'gain K of the spare joint of four; above the fastest hand rate', 'rad/s', 0.001, 10.0
    )
    joints: tuple[Joint, ...] = joint_names(
        'Names of two to four joints, outermost first; the last three before the tip when empty'
    )

    def __post_init__(self) -> None:
        """Read the description, and settle the joints.

        Raises:
            InvalidValueError: It describes no wrist; the sentence says why.
        """
        object.__setattr__(self, 'description', text_of(str(self.description)))
        axes = self._axes
        settled = {
            'joints': self._limited or axes.joints,
            'followed_axes': axes.followed_axes,
            'probe': body.scaled(HAND_AXES[axes.pointing_axis], body.PROBE_LENGTH),
        }
        for name, value in settled.items():
            object.__setattr__(self, name, value)
        super().__post_init__()

    @cached_property
    def _axes(self) -> SerialAxes:
        names = tuple(joint.name for joint in self._limited) or _names(self.joints)
        return axes_of(chain_of(self.description, self.tip, names))

    @property
    def _limited(self) -> tuple[Joint, ...]:
        """The joints, where more than their names is given."""
        given: Sequence[object] = self.joints
        return tuple(one for one in given if isinstance(one, Joint))

    @property
    def home(self) -> Positions:
        """Where the description has 0 or, if a limit is there, the middle; and away from lock."""
        return self._axes.home

    def forward(self, positions: Sequence[float]) -> Pose:
        """Return the pose of the tip: a product of exponentials. [Murray1994], (3.3)."""
        return self._axes.poses(positions)[-1]

    def inverse(self, pose: Pose, near: Sequence[float]) -> Positions:
        """Return the joints of an orientation, in closed form; where the tip is does not count.

        The spare one of four joints stays where `near` has it.
        """
        axes = self._axes
        rotation = product(pose.quaternion, conjugate(axes.chain.tip.quaternion))
        if len(near) == 2:
            return self._two(rotation, near)
        if len(near) == 3:
            return axes.three.turns(rotation, near)
        kept = near[axes.spare]
        if axes.spare:
            rotation = product(rotation, about(axes.directions[3], -kept))
            return (*axes.three.turns(rotation, near[:3]), kept)
        rotation = product(about(axes.directions[0], -kept), rotation)
        return (kept, *axes.three.turns(rotation, near[1:]))

    def jacobian(self, positions: Sequence[float]) -> np.ndarray:
        """Return (p, q, r) per joint rate, shape (3, joints): the axes, as the hand has them."""
        return np.array(self._axes.in_hand(positions)).T

    def rates(self, positions: Sequence[float], twist: Sequence[float]) -> Rates:
        """Return the joint rates, by Cramer's rule; two make what they can, the rest is forced."""
        p, q, r = twist
        if p == q == r == 0.0:
            return (0.0,) * len(positions)
        axes = self._axes
        in_hand = axes.in_hand(positions)
        a, b, c = axes.locking(in_hand)
        determinant = dot(a, cross(b, c))
        spare = 0.0
        if len(positions) == 4:
            law, share = self._spare_rate(positions)
            spare = share * law
            x, y, z = in_hand[axes.spare]
            p, q, r = p - spare * x, q - spare * y, r - spare * z
        three = tuple(
            dot((p, q, r), other) / determinant
            for other in (cross(b, c), cross(c, a), cross(a, b))
        )
        if len(positions) < 4:
            return three[: len(positions)]
        return (*three, spare) if axes.spare else (spare, *three)

    def margin(self, positions: Sequence[float]) -> float:
        """Return how far three axes are from a plane, as a share of the furthest.

        Of a pointer the third is the one that it points along; a spare joint does not count.
        """
        return abs(math.sin(self._axes.beyond_lock(positions)))

    def clearances(self, positions: Sequence[float]) -> tuple[Clearance, ...]:
        """Return what is left before each region that cannot be reached."""
        distances = self._axes.three.distances(self._axes.of_three(positions)[1])
        return tuple([soft_edge(name, distance) for name, distance in distances])

    def target_pose(self, pose: Pose, twist: Sequence[float], dt: float) -> Pose:
        """Return the pose after turning for a time; of a pointer right to second order.

        The turn that its mechanism forces turns the axes of the command as well: it is found
        first, then used. Neither pass divides by anything, so both go through lock.
        """
        if len(self.joints) > 2:
            return super().target_pose(pose, twist, dt)
        forced, rates = self._axes.forced_axis, list(twist)
        rates[forced] = 0.0
        found = self._pointed(pose, turned(pose.quaternion, _vector(rates), dt))
        rates[forced] = rates_between(pose.quaternion, found.quaternion, dt)[forced]
        return self._pointed(pose, turned(pose.quaternion, _vector(rates), dt))

    def choose_branch_reference(
        self, positions: Positions, factor: float, dt: float, steering_state: SteeringState
    ) -> tuple[Positions, SteeringState]:
        """Return the spare one of four joints after the step, steered away from lock."""
        if len(positions) < 4:
            return positions, steering_state
        law, share = self._spare_rate(positions)
        way, remembered = increment(law, share, factor * dt, steering_state)
        near = list(positions)
        near[self._axes.spare] += way
        return tuple(near), remembered

    def lost_axis(self, positions: Sequence[float]) -> Vector:
        """Return the rotation that the joints find hardest to make, the spare one left out."""
        driven = self._axes.of_three(self._axes.in_hand(positions))
        return self.hardest_rotation(np.array(driven).T)

    def bodies(self, positions: Sequence[float]) -> tuple[Body, ...]:
        """Return the links between the joints, as rods along and between the axes."""
        return serial_bodies(self._axes, positions, self.probe)

    def _two(self, rotation: Quaternion, near: Sequence[float]) -> Positions:
        outer, inner = self._axes.directions
        seen = to_hand(rotation, outer)
        if abs(dot(seen, inner) - dot(outer, inner)) > TOLERANCE:
            raise UnreachableError(
                'The hand can only point, with the turn that follows; aim for such a pose.',
                'turn that is not free',
            )
        second = turn_about(inner, seen, outer)
        first = turn_about(outer, inner, to_forearm(rotation, inner))
        return (nearest_turn(first, near[0]), nearest_turn(second, near[1]))

    def _pointed(self, pose: Pose, aim: Quaternion) -> Pose:
        """Return the pose nearest to another, of those that point as the aim does."""
        rotation = product(aim, conjugate(self._axes.chain.tip.quaternion))
        before = self.inverse(pose, (0.0, 0.0))
        return self.forward(self._axes.three.turns(rotation, (*before, 0.0))[:2])

    def _spare_rate(self, positions: Sequence[float]) -> tuple[float, float]:
        """Return the rate of the spare joint, rad/s, and the share that the joints have space for.

        With the hand at rest the cosine of the angle of the three axes' ends is P + Q cos ψ, with
        ψ the turn of the spare joint. It goes to where that leaves the largest margin, at K times
        what is missing: Barker's law where all axes are square, [Barker1986], eq. (1).
        """
        axes = self._axes
        in_hand = axes.in_hand(positions)
        a, b, c = axes.of_three(in_hand)
        spare = in_hand[axes.spare]
        middle = dot(a, spare) * dot(spare, c)
        slope = -dot(a, cross(spare, c))
        swing = math.hypot(dot(a, c) - middle, slope)
        least, most = (axes.three.cosine_of(middle + side * swing) for side in (-1.0, 1.0))
        law = self.gain * (math.cos(axes.beyond_lock(positions)) - min(max(0.0, least), most))
        if slope > SIDE * math.hypot(*cross(a, c)):
            law = -law
        moves = [dot(spare, other) for other in (cross(b, c), cross(c, a), cross(a, b))]
        moves.insert(axes.spare, -dot(a, cross(b, c)))
        return law, share_of_space(self.joints, positions, moves, moves[axes.spare], law)


def _names(given: object) -> tuple[str, ...]:
    """Return the names of joints, as somebody gave them.

    Raises:
        InvalidValueError: They are no names.
    """
    names = tuple(given) if isinstance(given, Sequence) and not isinstance(given, str) else None
    if names is None or not all(isinstance(name, str) for name in names):
        raise InvalidValueError(f'joints is {given!r}; valid is a list of names, outermost first.')
    return names


def _vector(rates: Sequence[float]) -> Vector:
    p, q, r = rates
    return (p, q, r)
