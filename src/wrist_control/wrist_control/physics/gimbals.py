"""Wrists of hinges one after the other: gimbals, roll-pitch-roll, a Hooke joint, pitch-yaw."""

from __future__ import annotations

from collections.abc import Sequence

from wrist_control.physics.linkage import Linkage, X, Y, Z
from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.rotations import Vector
from wrist_control.wrists.four_gimbal import FourGimbal
from wrist_control.wrists.pitch_yaw import PitchYaw
from wrist_control.wrists.roll_pitch_roll import RollPitchRoll
from wrist_control.wrists.single_hooke import SingleHooke
from wrist_control.wrists.three_gimbal import ThreeGimbal
from wrist_control.wrists.wrist import Wrist

# How large a wrist is built that has no dimensions of its own, m.
SIZE = 0.1


def three_gimbal(wrist: ThreeGimbal, settings: Settings) -> Mechanism:
    """Return rings that turn by ψ about z, θ about y, φ about x. [Barker1986], fig. 1."""
    return _row(wrist, settings, (0, 1, 2), (Z, Y, X))


def four_gimbal(wrist: FourGimbal, settings: Settings) -> Mechanism:
    """Return the three gimbals, and a fourth by α about z. [Barker1986], fig. 4."""
    return _row(wrist, settings, (0, 1, 2, 3), (Z, Y, X, Z))


def roll_pitch_roll(wrist: RollPitchRoll, settings: Settings) -> Mechanism:
    """Return a roll about x, a pitch about y, and a roll about x. [McKinney1988], fig. 1."""
    return _row(wrist, settings, (0, 1, 2), (X, Y, X))


def single_hooke(wrist: SingleHooke, settings: Settings) -> Mechanism:
    """Return a shaft that rolls about x, a cross about y, a yoke about z. [McKinney1988]."""
    return _row(wrist, settings, (0, 1, 2), (X, Y, Z))


def pitch_yaw(wrist: PitchYaw, settings: Settings) -> Mechanism:
    """Return a ring that turns by θ2 about y, and in it the hand by θ1 about x. [Canfield1997]."""
    return _row(wrist, settings, (1, 0), (Y, X))


def _row(
    wrist: Wrist, settings: Settings, order: Sequence[int], axes: Sequence[Vector]
) -> Mechanism:
    """Return hinges from the forearm on, their axes through one point."""
    linkage = Linkage(SIZE, settings)
    link = linkage.forearm
    for place, (index, axis) in enumerate(zip(order, axes, strict=True), start=1):
        name = wrist.joints[index].name
        link = linkage.link(link, 'hand' if place == len(order) else f'link_{place}')
        linkage.hinge(link, name, axis, driven=True)
    return linkage.finished(link, wrist.probe, (joint.name for joint in wrist.joints))
