"""A joint that stands in for hardware: it goes where it is told, as fast as it really can."""

from __future__ import annotations

from wrist_control.wrists.wrist import Joint


def follow(joint: Joint, position: float, target: float, dt: float) -> float:
    """Return where a joint is after a time, on its way to a target within its limits.

    Args:
        joint: The joint, with its position and rate limits.
        position: Where it is, rad or m.
        target: Where it is told to go, rad or m.
        dt: s.
    """
    reach = joint.rate_limit * dt
    within = min(max(target, joint.lower), joint.upper)
    return min(max(within, position - reach), position + reach)
