"""The spherical five-bar pointer: two drives, and four links of 90°. [Canfield1997], fig. 4.7."""

from __future__ import annotations

from wrist_control.physics.gimbals import SIZE
from wrist_control.physics.linkage import ORIGIN, Linkage, X, Y, Z
from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.wrists.body import BACK
from wrist_control.wrists.five_bar import FiveBar


def five_bar(wrist: FiveBar, settings: Settings) -> Mechanism:
    """Return two links on the forearm, another on each, and these two joined on top.

    All axes cross in one point, so that a ball joint on the last one is as good as a hinge; its
    pin is free to slide along the radius, which the other joints hold already: both would fight.
    """
    linkage = Linkage(SIZE, settings)
    first, second = (joint.name for joint in wrist.joints)
    link_1 = linkage.link(linkage.forearm, 'link_1')
    linkage.hinge(link_1, first, Y, driven=True)
    hand = linkage.link(link_1, 'hand')
    linkage.hinge(hand, 'first elbow', X)
    link_2 = linkage.link(linkage.forearm, 'link_2')
    linkage.hinge(link_2, second, BACK, driven=True)
    link_4 = linkage.link(link_2, 'link_4')
    linkage.hinge(link_4, 'second elbow', Y)
    top = (0.0, 0.0, SIZE)
    pin = linkage.link(link_4, 'pin', top)
    linkage.slide(pin, 'pin', Z)
    linkage.ball('top', pin, ORIGIN, hand, top)
    return linkage.finished(hand, wrist.probe, (first, second))
