"""What a supervisor is told once, who is in charge, and what one period brings."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

from wrist_control.resolving.report import WristState
from wrist_control.resolving.state import Step, Twist
from wrist_control.wrists.wrist import Positions


class SupervisorSettings(NamedTuple):
    """What a supervisor is told once.

    Attributes:
        dt: Duration of a step, s.
        command_timeout: Age up to which a command is followed in full, s.
        stop_time: How long the ramp to a stop takes after that, s.
        initial_positions: Where to start, and where `reset` goes, rad or m.
        tracking_tolerance: How far each joint may be from its command, rad or m.
        tracking_time: For how long, s.
        require_joint_states: Whether nothing is commanded before the joints were heard.
        feedback_timeout: Age up to which joint states are good enough to move by, s.
    """

    dt: float
    command_timeout: float
    stop_time: float
    initial_positions: Positions
    tracking_tolerance: tuple[float, ...]
    tracking_time: float = 0.25
    require_joint_states: bool = True
    feedback_timeout: float = 0.25


class PeriodResult(NamedTuple):
    """What one period brought.

    Attributes:
        wrist_state: For the operator's status.
        step: The step that was made.
        commanded: The twist that was followed, hand axes, (vx, vy, vz, p, q, r).
        message: What is happening and what to do, one sentence.
        moving_allowed: False while nothing may be sent to the joints.
    """

    wrist_state: WristState
    step: Step
    commanded: Twist
    message: str
    moving_allowed: bool

    def withheld(self, why: str) -> PeriodResult:
        """Return the same of a hand that may not move, and why; as it is when that is empty."""
        return self._replace(wrist_state=WristState.STALE, message=why) if why else self


class Mode(Enum):
    """Who is in charge of the joints."""

    WAITING = 'nobody: no joint states yet'
    FOLLOWING = 'the operator'
    HOMING = 'the reset'
    DISABLED = 'nobody: disabled'
    FAULT = 'nobody: a fault'
