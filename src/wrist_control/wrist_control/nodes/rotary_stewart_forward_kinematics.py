"""The forward kinematics of the rotary Stewart platform: servo angles in, proved poses out."""

from __future__ import annotations

import sys
from typing import ClassVar

from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics, specs
from wrist_control.ros.running import run

SPECS = specs('rotary_stewart')


class RotaryStewartForwardKinematics(StewartForwardKinematics):
    """Publishes the pose of the platform, and how much of it is proved."""

    wrist_name: ClassVar[str] = 'rotary_stewart'


def main() -> None:
    """Run the forward kinematics of the rotary Stewart platform."""
    sys.exit(run(RotaryStewartForwardKinematics))
