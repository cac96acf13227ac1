"""Two Hooke joints with a shaft between them, geared to bend equally. [McKinney1988]."""

from __future__ import annotations

import mujoco

from wrist_control.physics.linkage import ORIGIN, Linkage, X, Y, Z
from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.wrists.double_hooke import DoubleHooke
from wrist_control.wrists.omni_wrist import OmniWrist

# Where along the shaft the slots of the Omni-Wrist's bows hold it, as a share of its length.
HELD = 0.5


def double_hooke(wrist: DoubleHooke, settings: Settings) -> Mechanism:
    """Return a shaft that is rolled and bent by three drives in a row. [McKinney1988], fig. 7."""
    linkage = Linkage(wrist.shaft_length, settings)
    names = [joint.name for joint in wrist.joints]
    _, hand = _joints(linkage, wrist.shaft_length, names, (True, True, True))
    return linkage.finished(hand, wrist.probe, names)


def omni_wrist(wrist: OmniWrist, settings: Settings) -> Mechanism:
    """Return a shaft that is rolled by one drive, and bent by two slotted bows around it.

    The slot of a bow is a curve around the centre of the first joint: what runs in it is a block
    that turns about the bow's own normal. It holds the shaft's middle by a pin that is free to
    slide along the radius, which the joint holds already: both would fight. [McKinney1988],
    fig. 8.
    """
    linkage = Linkage(wrist.shaft_length, settings)
    names = [joint.name for joint in wrist.joints]
    inner = (names[0], 'theta', 'psi')
    shaft, hand = _joints(linkage, wrist.shaft_length, inner, (True, False, False))
    middle = (HELD * wrist.shaft_length, 0.0, 0.0)
    for name, axis, normal in ((names[1], Y, Z), (names[2], Z, Y)):
        bow = linkage.link(linkage.forearm, f'{name} bow')
        linkage.hinge(bow, name, axis, driven=True)
        block = linkage.link(bow, f'{name} block')
        linkage.hinge(block, f'{name} slot', normal)
        pin = linkage.link(block, f'{name} pin', middle)
        linkage.slide(pin, f'{name} pin', X)
        linkage.ball(f'{name} eye', pin, ORIGIN, shaft, middle)
    return linkage.finished(hand, wrist.probe, names)


def _joints(
    linkage: Linkage, length: float, names: list[str] | tuple[str, ...], driven: tuple[bool, ...]
) -> tuple[mujoco.MjsBody, mujoco.MjsBody]:
    """Return the shaft and the hand, on two Hooke joints from the forearm on.

    Args:
        linkage: Where they are built.
        length: From joint to joint, m.
        names: Of the roll, and of the first joint's axes y and z.
        driven: Which of these three have a servo.
    """
    link = linkage.forearm
    for name, body, axis, drive in zip(
        names, ('driver', 'cross', 'shaft'), (X, Y, Z), driven, strict=True
    ):
        link = linkage.link(link, body)
        linkage.hinge(link, name, axis, drive)
    _, across, aside = names
    second = linkage.link(link, 'second cross', (length, 0.0, 0.0))
    linkage.hinge(second, f'{aside}_2', Z)
    hand = linkage.link(second, 'hand')
    linkage.hinge(hand, f'{across}_2', Y)
    linkage.gear(f'{aside}_2', aside)
    linkage.gear(f'{across}_2', across)
    return link, hand
