"""What the operator is told after a step: a state, and one plain sentence."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum

from wrist_control.resolving.limits import LimitAtWork, LimitKind
from wrist_control.resolving.state import Step
from wrist_control.resolving.step import MECHANISM
from wrist_control.wrists.wrist import Wrist

# Part of the command that the mechanism may leave out before the operator is told, rad/s or m/s.
NOTICEABLE = 1e-3
SILENT = 'No fresh command: ramped to a stop; send commands again to go on.'
RESETTING = 'Resetting: on the way back to initial_positions; commands do not count now.'


class WristState(IntEnum):
    """What the wrist is doing; the values are those of the WristStatus message."""

    DISABLED = 0
    IDLE = 1
    TRACKING = 2
    SCALED = 3
    SINGULAR = 4
    LIMITED = 5
    STALE = 6
    FAULT = 7
    WAITING = 8


def state_of(step: Step, commanded: Sequence[float]) -> WristState:
    """Return the state that a step shows."""
    if not any(commanded):
        return WristState.TRACKING if any(step.joint_rates) else WristState.IDLE
    kinds = {limit.kind for limit in step.limits}
    held = bool(kinds & {LimitKind.POSITION, LimitKind.WORKSPACE})
    if held:
        return WristState.LIMITED
    if step.singular:
        return WristState.SINGULAR
    return WristState.SCALED if step.scale_factor < 1.0 else WristState.TRACKING


def sentence(wrist: Wrist, step: Step, commanded: Sequence[float]) -> str:
    """Return what is happening and what to do, in one sentence."""
    state = state_of(step, commanded)
    if state == WristState.IDLE:
        return 'Ready: no motion is commanded.'
    if not any(commanded):
        return 'Coming to rest: no motion is commanded.'
    if state == WristState.SINGULAR:
        return _singular(wrist, step)
    if state == WristState.LIMITED:
        return _limited(wrist, step)
    if state == WristState.SCALED:
        return _scaled(wrist, step.limits, step.scale_factor)
    if any(limit.kind == LimitKind.ACCELERATION for limit in step.limits):
        return _changing_speed(wrist, step.limits)
    return _tracking(wrist, step, commanded)


def _singular(wrist: Wrist, step: Step) -> str:
    lost = f'In lock: the hand cannot turn about its axis {_axis(wrist, step)}'
    if all(limit.kind != LimitKind.SINGULARITY for limit in step.limits):
        return (
            f'{lost}; the joints are turning into place at {_coarse(step.scale_factor)} of the '
            'command: keep on, or reverse to back out.'
        )
    if step.scale_factor == 0.0:
        return f'{lost}, and no motion of the joints helps; turn it about another axis.'
    return (
        f'{lost} and leaves that part of the command out; the rest is followed at '
        f'{_coarse(step.scale_factor)}.'
    )


def _limited(wrist: Wrist, step: Step) -> str:
    limit = next(
        one for one in step.limits if one.kind in (LimitKind.POSITION, LimitKind.WORKSPACE)
    )
    if limit.joint == MECHANISM:
        return _nothing_possible(wrist)
    if limit.kind == LimitKind.POSITION:
        where = f'{limit.joint} is at its limit of {limit.allowed:.3f} {_unit(wrist, limit)}'
    else:
        where = f'The wrist is at its limit: {limit.joint}'
    return f'{where}; move the other way.'


def _nothing_possible(wrist: Wrist) -> str:
    *first, last = ('xyz'[axis] for axis in wrist.followed_axes)
    return (
        'Nothing of this command can be done: the wrist turns the hand about its own '
        f'{", ".join(first)} and {last} axes, and no more; command those rates.'
    )


def _scaled(wrist: Wrist, limits: Sequence[LimitAtWork], factor: float) -> str:
    worst = min(limits, key=lambda limit: limit.share)
    if worst.kind == LimitKind.ACCELERATION:
        return _changing_speed(wrist, limits)
    asked, allowed = _number(worst.asked, 1), _number(worst.allowed, 2)
    return (
        f'Slowed to {_coarse(factor)}: {worst.joint} would need {asked} {_unit(wrist, worst)}/s '
        f'and may do {allowed}; ask for less, or turn another way.'
    )


def _changing_speed(wrist: Wrist, limits: Sequence[LimitAtWork]) -> str:
    worst = min(
        (limit for limit in limits if limit.kind == LimitKind.ACCELERATION),
        key=lambda limit: limit.share,
    )
    return (
        f'Changing speed as quickly as {worst.joint} may, by {_number(worst.allowed, 2)} '
        f'{_unit(wrist, worst)}/s in each second; keep on.'
    )


def _tracking(wrist: Wrist, step: Step, commanded: Sequence[float]) -> str:
    asked, impossible = commanded[-wrist.twist_size :], commanded[: -wrist.twist_size]
    achieved = step.achieved[-wrist.twist_size :]
    missing = [want - got for want, got in zip(asked, achieved, strict=True)] + [*impossible]
    if max(abs(x) for x in missing) < NOTICEABLE:
        return 'Following the command.'
    return (
        'Following the part of the command that this mechanism can do; the rest is missing from '
        'the achieved rates.'
    )


def _coarse(share: float) -> str:
    """Return a share in words that do not change from step to step; fields have it exactly."""
    return f'about {5 * round(20.0 * share)}%' if share >= 0.05 else 'less than 5%'


def _number(value: float, digits: int) -> str:
    """Return the size of a value to few digits, without an exponent where it can be."""
    return f'{float(f"{abs(value):.{digits}g}"):g}'


def _axis(wrist: Wrist, step: Step) -> str:
    """Return the lost axis, of its two signs the one whose largest component is positive."""
    axis = wrist.lost_axis(step.state.positions)
    sign = -1.0 if max(axis, key=abs) < 0.0 else 1.0
    # Adding 0 makes 0 of -0.
    return '(' + ', '.join(f'{round(sign * a, 1) + 0.0:.1f}' for a in axis) + ')'


def _unit(wrist: Wrist, limit: LimitAtWork) -> str:
    kinds = {joint.name: joint.kind for joint in wrist.joints}
    return 'm' if kinds[limit.joint] == 'prismatic' else 'rad'
