"""Laws of joints whose rates cannot change at once: how they start, turn back and stop."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from wrist_control.errors import UnreachableError
from wrist_control.resolving.limits import overruns
from wrist_control.resolving.state import State, Step, increments
from wrist_control.resolving.step import start, step
from wrist_control.testing.broken import require
from wrist_control.testing.held import SPEED as FASTEST_HELD
from wrist_control.testing.held import a_held_command_does_not_make_joints_chatter
from wrist_control.testing.motion import confined, no_step_breaks_a_limit
from wrist_control.testing.places import Random, random_twist
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.wrist import Wrist

DT = 0.01
FLIGHTS = 6
COMMANDS = 8
LONGEST_COMMAND = 40  # steps
# How long a joint takes to full speed, and from there to a stop, s.
SPEEDING_UP, SLOWING_DOWN = 0.25, 0.1
# What is achieved has the commanded direction within this, rad; a pointer's hand rolls in a step.
SAME_DIRECTION, OF_A_POINTER = 1e-6, 0.05
# Factors that are tried, and how much the best of them may be missed by.
FACTORS = np.linspace(0.0, 1.3, 53)[1:]
MISSED = 0.02


def sluggish(wrist: Wrist) -> Wrist:
    """Return a wrist whose joints take their time to their rate limits, and from there to rest."""
    rates = [joint.rate_limit for joint in wrist.joints]
    return wrist.with_limits(
        accelerations=[rate / SPEEDING_UP for rate in rates],
        decelerations=[rate / SLOWING_DOWN for rate in rates],
    )


def flown(wrist: Wrist, random: Random) -> Iterator[tuple[State, Step, list[float]]]:
    """Yield the state before, the step and the twist of flights under changing commands."""
    for _ in range(FLIGHTS):
        state = start(wrist)
        for _ in range(COMMANDS):
            twist = list(random_twist(wrist, random, float(random.uniform(0.1, 1.5))))
            if random.random() < 0.2:
                twist = [0.0] * wrist.twist_size
            for _ in range(int(random.integers(1, LONGEST_COMMAND))):
                taken = step(wrist, state, twist, DT)
                yield state, taken, twist
                state = taken.state


def no_rate_changes_faster_than_it_may(wrist: Wrist, random: Random) -> None:
    """The time that each joint needs from one rate to the next is not more than a step."""
    wrist = sluggish(confined(wrist))
    for before, taken, twist in flown(wrist, random):
        time = longest_change(wrist.joints, before.joint_rates, taken.joint_rates)
        where = f'after {twist} at {tuple(before.positions)}'
        require(time <= DT * (1.0 + 1e-6), f'a rate would need {time:.6g} s to change, {where}')


def longest_change(
    joints: Sequence[Joint], before: Sequence[float], after: Sequence[float]
) -> float:
    """Return the time that the slowest joint needs from one rate to another, s.

    Args:
        joints: The joints, with the limits of their accelerations.
        before: Their rates, rad/s or m/s; empty at rest.
        after: The rates that they shall have.
    """
    return max(
        time_to_change(joint, old, new)
        for joint, old, new in zip(joints, before or (0.0,) * len(joints), after, strict=True)
    )


def stopping_time(joints: Sequence[Joint], rates: Sequence[float]) -> float:
    """Return the time that the slowest joint needs to stop, s.

    Args:
        joints: The joints, with the limits of their accelerations.
        rates: Their rates, rad/s or m/s.
    """
    return longest_change(joints, rates, (0.0,) * len(joints))


def time_to_change(joint: Joint, old: float, new: float) -> float:
    """Return how long a joint needs at least from one rate to another, s.

    Args:
        joint: The joint, with its limits.
        old: Its rate before, rad/s or m/s.
        new: Its rate afterwards; through 0 it slows down first.
    """
    if old * new < 0.0:
        return abs(old) / joint.deceleration_limit + abs(new) / joint.acceleration_limit
    gain = abs(new) - abs(old)
    return max(gain / joint.acceleration_limit, -gain / joint.deceleration_limit)


def the_direction_is_left_only_where_no_factor_can_keep_it(wrist: Wrist, random: Random) -> None:
    """And of the factors that can, none is left out that would be larger, up to the free step's.

    The free step is that of joints whose rates may change at once.
    """
    wrist = sluggish(confined(wrist))
    free = wrist.with_limits(accelerations=math.inf, decelerations=math.inf)
    for number, (before, taken, twist) in enumerate(flown(wrist, random)):
        if number % 4 or taken.singular or not any(twist):
            continue
        kept = taken.scale_factor if _is_along(wrist, taken, twist) else 0.0
        most = step(free, before, twist, DT).scale_factor
        for factor in FACTORS:
            if kept + MISSED < factor and (factor < most - MISSED or not kept):
                possible = _can_be_made(wrist, before, twist, factor)
                what = f'{twist} at {tuple(before.positions)} from {before.joint_rates}'
                require(not possible, f'{factor:.3f} of {what} is possible, made is {kept:.3f}')


def _is_along(wrist: Wrist, taken: Step, twist: Sequence[float]) -> bool:
    components = list(wrist.followed_components)
    made = np.array(taken.achieved[-wrist.twist_size :])[components]
    asked = np.array(twist)[components]
    across = made - asked * (made @ asked) / (asked @ asked)
    forward = float(made @ asked) > 0.0
    tolerance = SAME_DIRECTION if len(wrist.followed_axes) == 3 else OF_A_POINTER
    return forward and float(np.linalg.norm(across)) <= tolerance * float(np.linalg.norm(made))


def _can_be_made(wrist: Wrist, before: State, twist: Sequence[float], factor: float) -> bool:
    """Return whether a factor keeps all limits with something to spare, and room to stop."""
    try:
        near, _ = wrist.choose_branch_reference(
            before.positions, factor, DT, before.steering_state
        )
        pose = wrist.target_pose(before.pose, [factor * x for x in twist], DT)
        after = wrist.inverse(pose, near)
        rates = increments(before.positions, after, DT)
        if longest_change(wrist.joints, before.joint_rates, rates) > 0.99 * DT:
            return False
        braking = stopping_time(wrist.joints, rates)
        end = [at + 0.51 * braking * rate for at, rate in zip(after, rates, strict=True)]
        rest = wrist.resolve_assembly(end, wrist.forward(after))
        return not (
            overruns(wrist, before.positions, after, DT)
            or overruns(wrist, before.positions, rest, math.inf)
        )
    except UnreachableError:
        return False


def a_hand_without_a_command_stops_in_time_and_within_its_limits(
    wrist: Wrist, random: Random
) -> None:
    """From anywhere in a flight: straight, in the time that the slowest joint needs."""
    wrist = sluggish(confined(wrist))
    for number, (_, taken, twist) in enumerate(flown(wrist, random)):
        if number % 10:
            continue
        where = f'after {twist} at {tuple(taken.state.positions)}'
        ways = [taken, *_to_rest(wrist, taken)]
        longest = stopping_time(wrist.joints, taken.joint_rates)
        require(
            len(ways) <= longest / DT + 2.0, f'it takes {len(ways) - 1} steps to stop, {where}'
        )
        for before, after in pairwise(ways):
            time = longest_change(wrist.joints, before.joint_rates, after.joint_rates)
            require(time <= DT * (1.0 + 1e-6), f'it stops too quickly, {where}')
        for clearance in wrist.clearances(ways[-1].state.positions):
            require(clearance.remaining >= -2e-9, f'it stops beyond {clearance.name}, {where}')


def _to_rest(wrist: Wrist, taken: Step) -> Iterator[Step]:
    while any(taken.joint_rates):
        taken = step(wrist, taken.state, (0.0,) * wrist.twist_size, DT)
        yield taken


def joints_that_take_their_time_break_no_limit(wrist: Wrist, random: Random) -> None:
    """No position, cone or closure is overshot, at any rate."""
    no_step_breaks_a_limit(sluggish(confined(wrist)), random)


def joints_that_take_their_time_come_to_the_free_joints_rates(
    wrist: Wrist, random: Random
) -> None:
    """Of a command that is held, as much is made in the end as by joints that are free."""
    wrist = sluggish(confined(wrist))
    free = wrist.with_limits(accelerations=math.inf, decelerations=math.inf)
    for _ in range(FLIGHTS):
        state, twist = start(wrist), random_twist(wrist, random, 0.2)
        for _ in range(round(2.0 * SPEEDING_UP / DT)):
            taken = step(wrist, state, twist, DT)
            before, state = state, taken.state
        wanted = step(free, before, twist, DT).scale_factor
        if not taken.limits:
            require(
                taken.scale_factor >= wanted - 1e-9, f'{taken.scale_factor} of {twist} is made'
            )


def a_held_command_does_not_make_joints_chatter_that_take_their_time(
    wrist: Wrist, random: Random
) -> None:
    """Through locks and at limits, as joints do whose rates may change at once."""
    rates = [FASTEST_HELD[joint.kind] for joint in wrist.joints]
    held = sluggish(wrist.with_limits(rates=rates))
    a_held_command_does_not_make_joints_chatter(held, random)


EASED = (
    no_rate_changes_faster_than_it_may,
    the_direction_is_left_only_where_no_factor_can_keep_it,
    a_hand_without_a_command_stops_in_time_and_within_its_limits,
    joints_that_take_their_time_break_no_limit,
    joints_that_take_their_time_come_to_the_free_joints_rates,
    a_held_command_does_not_make_joints_chatter_that_take_their_time,
)
