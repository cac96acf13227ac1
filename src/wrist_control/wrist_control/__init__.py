"""Resolved-rate control of robot wrists: operator rates p, q, r to joint motion."""

from wrist_control.errors import InvalidValueError, UnreachableError, WristError
from wrist_control.flight import Flight, fly
from wrist_control.operating.maneuvers import make_maneuver
from wrist_control.wrists import WRISTS, make_wrist

__all__ = [
    'WRISTS',
    'Flight',
    'InvalidValueError',
    'UnreachableError',
    'WristError',
    'fly',
    'make_maneuver',
    'make_wrist',
]
