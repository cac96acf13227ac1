"""Which strips a page shows of a wrist, and what they are fed with."""

from __future__ import annotations

import math
from typing import Any

from wrist_control.web.samples import Sample
from wrist_control.wrists import Wrist
from wrist_control.wrists.joint import Joint

ASKED, MADE, JOINT = '#94a3b8', '#38bdf8', '#34d399'
# How rates are shown, and up to where if a joint has no limit.
WIDE = {'revolute': 90.0, 'prismatic': 200.0}
FACTOR = {'revolute': math.degrees(1.0), 'prismatic': 1000.0}
UNIT = {'revolute': 'deg/s', 'prismatic': 'mm/s'}


def strips(wrist: Wrist) -> list[dict[str, Any]]:
    """Return p, q, r commanded and achieved, F, margin, and every joint's rate."""
    hand = [
        _strip(f'{name} deg/s, dashed: asked', -60.0, 60.0, _line(ASKED, dashed=True), _line(MADE))
        for name in 'pqr'
    ]
    shares = [_strip(name, 0.0, 1.0, _line(MADE)) for name in ('F', 'margin')]
    return [*hand, *shares, *map(_joint_strip, wrist.joints)]


def row(wrist: Wrist, sample: Sample) -> list[float]:
    """Return a sample as the strips take it: time, and one value for each line."""
    hand = [
        math.degrees(rate)
        for pair in zip(sample.commanded, sample.achieved, strict=True)
        for rate in pair
    ]
    joints = [
        FACTOR[joint.kind] * rate
        for joint, rate in zip(wrist.joints, sample.joint_rates, strict=True)
    ]
    return [
        round(value, 4)
        for value in (sample.time, *hand, sample.scale_factor, sample.margin, *joints)
    ]


def _joint_strip(joint: Joint) -> dict[str, Any]:
    limit = FACTOR[joint.kind] * joint.rate_limit
    high = 1.25 * (limit if math.isfinite(limit) else WIDE[joint.kind])
    limits = [-limit, limit] if math.isfinite(limit) else None
    return _strip(f'{joint.name} {UNIT[joint.kind]}', -high, high, _line(JOINT, limits=limits))


def _strip(title: str, low: float, high: float, *lines: dict[str, Any]) -> dict[str, Any]:
    return {'title': title, 'low': low, 'high': high, 'lines': lines}


def _line(
    colour: str, *, dashed: bool = False, limits: list[float] | None = None
) -> dict[str, Any]:
    return {'colour': colour, 'dashed': dashed, 'limits': limits}
