"""From commanded hand rates to joint positions, one step at a time. No ROS and no clock."""

from wrist_control.resolving.limits import LimitAtWork, LimitKind
from wrist_control.resolving.state import State, Step, resting
from wrist_control.resolving.step import SINGULAR_MARGIN, start, step

__all__ = [
    'SINGULAR_MARGIN',
    'LimitAtWork',
    'LimitKind',
    'State',
    'Step',
    'resting',
    'start',
    'step',
]
