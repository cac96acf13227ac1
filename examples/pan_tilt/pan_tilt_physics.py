"""The pan-tilt head as a mechanism of MuJoCo's: two hinges, and nothing of our kinematics."""

from __future__ import annotations

from wrist_control.physics.linkage import Linkage, Y, Z
from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.wrists import Wrist

SIZE = 0.1  # m


def pan_tilt(wrist: Wrist, settings: Settings) -> Mechanism:
    """Return a fork that pans about z, and in it the head that tilts about y."""
    linkage = Linkage(SIZE, settings)
    fork = linkage.link(linkage.forearm, 'fork')
    linkage.hinge(fork, 'pan', Z, driven=True)
    head = linkage.link(fork, 'hand')
    linkage.hinge(head, 'tilt', Y, driven=True)
    return linkage.finished(head, wrist.probe, ('pan', 'tilt'))
