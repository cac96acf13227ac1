"""Laws of motion: what the resolver's step makes of a wrist, at limits, at edges, through lock."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from wrist_control.errors import UnreachableError
from wrist_control.resolving.state import State, Step
from wrist_control.resolving.step import SINGULAR_MARGIN, start, step
from wrist_control.testing.broken import require, require_close
from wrist_control.testing.lock import locks
from wrist_control.testing.places import (
    Conditioning,
    Random,
    is_outside,
    random_twist,
    rate_map,
)
from wrist_control.wrists.wrist import Positions, SteeringState, Wrist

FLIGHTS = 8
DT = 0.05
# How far the joints of a confined wrist may go from home, and how fast: rad and m.
REACH = {'revolute': 0.6, 'prismatic': 0.03}
SPEED = {'revolute': 1.0, 'prismatic': 0.05}
# A path is followed in steps of this, rad, to where it ends.
PATH_STEP = 0.01
LONGEST_PATH = math.pi
SHORTEST_STEP = 1e-7


def confined(wrist: Wrist) -> Wrist:
    """Return the wrist with rate limits, and position limits around its home."""
    reach = np.array([REACH[joint.kind] for joint in wrist.joints])
    home = np.array(list(wrist.home))
    return wrist.with_limits(
        rates=[SPEED[joint.kind] for joint in wrist.joints],
        lower=(home - reach).tolist(),
        upper=(home + 0.7 * reach).tolist(),
    )


def flown(
    wrist: Wrist, random: Random, steps: int = 6
) -> Iterator[tuple[State, Step, list[float]]]:
    """Yield the state before, the step and the twist of flights under random commands."""
    for _ in range(FLIGHTS):
        state = start(wrist)
        for _ in range(6):
            twist = list(random_twist(wrist, random, random.uniform(0.1, 1.5)))
            for _ in range(steps):
                taken = step(wrist, state, twist, DT)
                yield state, taken, twist
                state = taken.state


def no_step_breaks_a_limit(wrist: Wrist, random: Random) -> None:
    """No joint is faster or further than it may, no clearance is overdrawn, all stays finite."""
    wrist = confined(wrist)
    for before, taken, twist in flown(wrist, random):
        after = taken.state
        where = f'after {twist} at {tuple(before.positions)}'
        for joint, position, rate in zip(
            wrist.joints, after.positions, taken.joint_rates, strict=True
        ):
            fast = abs(rate) <= joint.rate_limit * (1.0 + 1e-6)
            require(
                fast, f'{joint.name} moves at {rate:.4g}, limit {joint.rate_limit:.4g}, {where}'
            )
            inside = joint.lower - 2e-9 <= position <= joint.upper + 2e-9
            require(inside, f'{joint.name} is at {position:.4g}, outside its limits, {where}')
        for clearance in wrist.clearances(after.positions):
            kept = clearance.remaining >= -2e-9
            require(kept, f'{clearance.name} is overdrawn by {-clearance.remaining:.2g}, {where}')
        require(0.0 <= taken.scale_factor <= 1.0, f'F is {taken.scale_factor}, {where}')
        finite = math.isfinite(sum(after.positions) + sum(taken.achieved) + taken.margin)
        require(finite, f'something is not finite, {where}')


def the_hand_slows_but_keeps_its_direction(wrist: Wrist, random: Random) -> None:
    """Away from lock the hand does F times the command in all that it follows."""
    tolerance = 1e-7 if len(wrist.followed_axes) == 3 else 0.2
    components = list(wrist.followed_components)
    for _, taken, twist in flown(confined(wrist), random):
        if not taken.singular:
            achieved = taken.achieved[-wrist.twist_size :]
            for component in components:
                wanted = taken.scale_factor * twist[component]
                what = f'component {component} of what is achieved of {twist}'
                require_close(achieved[component], wanted, tolerance, what)


def no_command_leaves_everything_as_it_is(wrist: Wrist, random: Random) -> None:
    """A step without a command moves nothing and loses no time."""
    for _, taken, _ in flown(wrist, random):
        rest = step(wrist, taken.state, (0.0,) * wrist.twist_size, DT)
        still = rest.state == taken.state._replace(joint_rates=()) and not any(rest.joint_rates)
        require(still and rest.scale_factor == 1.0, f'it moves by {rest.joint_rates} at rest')


def a_hand_that_runs_into_a_limit_can_back_out(wrist: Wrist, random: Random) -> None:
    """Only the way back is promised: in a corner of two limits other ways may be closed."""
    wrist = confined(wrist)
    came_by = None
    for _, taken, twist in flown(wrist, random, steps=20):
        if taken.scale_factor < 1e-3 and twist == came_by:
            back = step(wrist, taken.state, [-x for x in twist], DT)
            moves = back.scale_factor > 0.0 and any(back.joint_rates)
            require(moves, f'it cannot back out of {tuple(taken.state.positions)}')
        came_by = twist if taken.scale_factor > 0.05 else None


def a_command_and_its_reverse_come_back(wrist: Wrist, random: Random) -> None:
    """The same way back ends where it began: hand and joints, or the hand of a spare joint.

    A joint may be off by as much as the hand is, where that needs more of it.
    """
    spare = len(wrist.joints) > wrist.twist_size
    for _ in range(FLIGHTS):
        twist = random_twist(wrist, random, 0.5)
        before = state = start(wrist)
        passed = []
        for _ in range(40):
            taken = step(wrist, state, twist, 0.01)
            if taken.scale_factor < 1.0 or taken.singular:
                break
            passed.append(state)
            state = taken.state
        for _ in passed:
            state = step(wrist, state, [-x for x in twist], 0.01).state
        what = f'of the way along {twist} and back'
        require_close(state.pose.rotation, before.pose.rotation, 1e-3, f'the end {what}')
        if not spare:
            ends = list(state.positions), list(before.positions)
            per_metre = np.linalg.norm(rate_map(wrist, before.positions)[:, :-3], axis=1)
            most = 1e-3 * float(per_metre.max(initial=1.0))
            require_close(*ends, most, f'the end {what}, in joints,')


def a_clearance_is_used_up_before_inverse_fails(wrist: Wrist, random: Random) -> None:
    """Whatever way the hand goes, where no pose follows any more a clearance has said so."""
    for _ in range(2 * FLIGHTS):
        twist = random_twist(wrist, random)
        places, error = _path(wrist, twist)
        require(
            error is None,
            f'along {twist} no pose follows {tuple(places[-1])} ({error}), but no clearance is '
            'used up there',
        )


def _path(wrist: Wrist, twist: Sequence[float]) -> tuple[list[Positions], UnreachableError | None]:
    """Return the joint positions along a twist from home to where a clearance is used up.

    Where no pose follows before that, ever shorter steps are tried, since joints may run to an
    edge like a root; then the error is returned, too.
    """
    pose = wrist.forward(wrist.home)
    steering_state: SteeringState = ()
    places: list[Positions] = [wrist.home]
    length, turned = PATH_STEP, 0.0
    while turned < LONGEST_PATH and not is_outside(wrist, places[-1]):
        try:
            near, after = wrist.choose_branch_reference(places[-1], 1.0, length, steering_state)
            target = wrist.target_pose(pose, twist, length)
            places.append(wrist.inverse(target, near))
        except UnreachableError as error:
            length *= 0.5
            if length < SHORTEST_STEP:
                return places, error
            continue
        pose, steering_state, turned = target, after, turned + length
    return places, None


def joints_never_jump_away_from_lock(wrist: Wrist, random: Random) -> None:
    """Along a path inside its workspace `inverse` goes on from where it was."""
    conditioning = Conditioning(wrist)
    for _ in range(FLIGHTS // 2):
        twist = random_twist(wrist, random)
        places, _ = _path(wrist, twist)
        for before, after in pairwise(places):
            if min(conditioning(before), conditioning(after)) < 0.1:
                break
            fastest = max(1.0, float(np.abs(wrist.rates(before, twist)).max()))
            jump = float(np.abs(np.subtract(list(after), list(before))).max())
            allowed = 2.0 * fastest * PATH_STEP
            require(jump <= allowed, f'the joints jump by {jump:.2g} after {tuple(before)}')


def a_passage_through_lock_stays_on_its_branch(wrist: Wrist, random: Random) -> None:
    """Where the joints lead straight through a lock, `inverse` follows them to the other side.

    Where the lock is the edge of the workspace, two branches meet in it, and nothing is asked.
    """
    for line, at in locks(wrist, random):
        if is_outside(wrist, line(at)):
            continue
        near = line(at - 0.1)
        for count in range(1, 8):
            positions = line(at - 0.1 + 0.03 * count)
            if wrist.margin(positions) < 2.0 * SINGULAR_MARGIN:
                continue
            near = wrist.inverse(
                wrist.forward(positions), _with_spare_joints(wrist, near, positions)
            )
            what = f'inverse through the lock at {tuple(line(at))}'
            require_close(list(near), list(positions), 1e-6, what)


def _with_spare_joints(wrist: Wrist, near: Positions, there: Positions) -> Positions:
    """Return `near`, with those joints as they are there that no command moves."""
    moved = np.abs(rate_map(wrist, there)).max(axis=1) > 0.0
    return tuple(np.where(moved, list(near), list(there)).tolist())


MOTION = (
    no_step_breaks_a_limit,
    the_hand_slows_but_keeps_its_direction,
    no_command_leaves_everything_as_it_is,
    a_hand_that_runs_into_a_limit_can_back_out,
    a_command_and_its_reverse_come_back,
    a_clearance_is_used_up_before_inverse_fails,
    joints_never_jump_away_from_lock,
    a_passage_through_lock_stays_on_its_branch,
)
