"""Laws of a command that is held: calm joints, no stop without need, none without its reason."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from wrist_control.errors import UnreachableError
from wrist_control.resolving.limits import LimitKind, overruns
from wrist_control.resolving.report import sentence
from wrist_control.resolving.state import State, Step
from wrist_control.resolving.step import SINGULAR_MARGIN, step
from wrist_control.testing.broken import require
from wrist_control.testing.lock import locks
from wrist_control.testing.places import Random, is_outside, random_twist, regular_places
from wrist_control.wrists.wrist import Positions, Wrist

MINUTE = 60.0  # s
# Steps per second, and how many commands are held at that rate: fast ones take long.
FLIGHTS = {10.0: 18, 100.0: 3, 500.0: 1}
# Limits of the joints: rad/s and m/s, Barker's 32 deg/s and the legs of a platform; and how far
# from the start the position limits lie at most, rad and m.
SPEED = {'revolute': 0.56, 'prismatic': 0.05}
SPACE = {'revolute': 3.0, 'prismatic': 0.1}
HAND_SPEEDS = (0.02, 0.1, 0.3, 0.8)  # rad/s
# A joint is at full rate from this share of its limit on.
FULL = 0.9
# Through each lock on its way a joint may turn back once, and at two limits besides.
REVERSALS = 2
TENTH = 0.1


class Held(NamedTuple):
    """A command that is held.

    Attributes:
        wrist: The mechanism, with the limits of this flight.
        start: Where it starts.
        twist: What is commanded.
        dt: Duration of a step, s.
    """

    wrist: Wrist
    start: State
    twist: list[float]
    dt: float

    def __str__(self) -> str:
        """Tell how to fly it again."""
        return f'{self.twist} held from {tuple(self.start.positions)}, {1.0 / self.dt:.0f} Hz'

    def steps(self, duration: float) -> Iterator[tuple[State, Step]]:
        """Yield each state and the step from it.

        A flight ends where nothing moves any more: the same step would follow for ever.
        """
        state = self.start
        for _ in range(round(duration / self.dt)):
            taken = step(self.wrist, state, self.twist, self.dt)
            yield state, taken
            if not any(taken.joint_rates) and taken.state.steering_state == state.steering_state:
                return
            state = taken.state


def commands(wrist: Wrist, random: Random) -> Iterator[Held]:
    """Yield commands to hold, from places all over and beside locks, with all kinds of limits."""
    places = [*regular_places(wrist, random, 12), *beside_locks(wrist, random)]
    for rate, flights in FLIGHTS.items():
        for number in range(flights):
            positions = places[random.integers(len(places))]
            twist = np.array(random_twist(wrist, random, float(random.choice(HAND_SPEEDS))))
            if number % 4 == 1:
                lost = np.array(wrist.lost_axis(positions)) + random.choice([0.0, 0.1])
                twist[-3:] = np.linalg.norm(twist[-3:]) * lost
            limited = _limited(wrist, positions, random, in_position=number % 3 == 2)
            start = State(positions, wrist.forward(positions))
            yield Held(limited, start, twist.tolist(), 1.0 / rate)


def beside_locks(wrist: Wrist, random: Random) -> Iterator[Positions]:
    """Yield places where a start is allowed, a hundredth to a tenth of a radian from a lock."""
    for line, at in locks(wrist, random):
        with suppress(UnreachableError):
            positions = line(at + float(random.choice([-1.0, 1.0]) * 10 ** random.uniform(-2, -1)))
            if wrist.margin(positions) > SINGULAR_MARGIN and not is_outside(wrist, positions):
                yield positions


def _limited(wrist: Wrist, positions: Positions, random: Random, *, in_position: bool) -> Wrist:
    rates = [SPEED[joint.kind] for joint in wrist.joints]
    if not in_position:
        return wrist.with_limits(rates=rates)
    space = np.array([SPACE[joint.kind] for joint in wrist.joints])
    here, away = np.array(list(positions)), random.uniform(0.0, 1.0, size=(2, len(space)))
    lower, upper = here - space * away[0], here + space * away[1]
    return wrist.with_limits(rates=rates, lower=lower.tolist(), upper=upper.tolist())


def a_held_command_does_not_make_joints_chatter(wrist: Wrist, random: Random) -> None:
    """In a minute no joint turns back at full rate more often than locks and limits make it.

    A hand that turns about one axis passes a lock once in half a turn at most.
    """
    for held in commands(wrist, random):
        full = [FULL * joint.rate_limit for joint in held.wrist.joints]
        last, reversals = [0.0] * len(full), [0] * len(full)
        turned = 0.0
        for _, taken in held.steps(MINUTE):
            for joint, rate in enumerate(taken.joint_rates):
                if abs(rate) > full[joint]:
                    reversals[joint] += rate * last[joint] < 0.0
                    last[joint] = rate
            turned += held.dt * math.hypot(*taken.achieved[3:])
        most = max(reversals)
        allowed = REVERSALS + turned / math.pi
        require(most <= allowed, f'a joint turns back at full rate {most} times, {held}')


def where_a_tenth_of_the_command_can_be_made_something_moves(wrist: Wrist, random: Random) -> None:
    """The hand stops where a limit is reached, and not because a whole step would be too long."""
    for held in commands(wrist, random):
        for state, taken in held.steps(2.0):
            if not taken.singular and not any(taken.joint_rates):
                possible = _can_be_made(held, state, TENTH)
                require(not possible, f'nothing moves at {tuple(state.positions)}, {held}')


def _can_be_made(held: Held, state: State, share: float) -> bool:
    wrist, twist = held.wrist, [share * x for x in held.twist]
    try:
        near, _ = wrist.choose_branch_reference(
            state.positions, share, held.dt, state.steering_state
        )
        positions = wrist.inverse(wrist.target_pose(state.pose, twist, held.dt), near)
        return not overruns(wrist, state.positions, positions, held.dt)
    except UnreachableError:
        return False


def every_stop_names_what_holds_it(wrist: Wrist, random: Random) -> None:
    """Where a command moves nothing, limits are named, and the sentence names one of them."""
    for held in commands(wrist, random):
        for state, taken in held.steps(2.0):
            if any(taken.joint_rates):
                continue
            where = f'at {tuple(state.positions)}, {held}'
            require(taken.limits, f'nothing moves and no limit is named {where}')
            told = sentence(held.wrist, taken, held.twist)
            names = [limit.joint for limit in taken.limits if limit.kind != LimitKind.RATE]
            require(any(name in told for name in names), f'{told!r} names none of {names} {where}')


HELD = (
    a_held_command_does_not_make_joints_chatter,
    where_a_tenth_of_the_command_can_be_made_something_moves,
    every_stop_names_what_holds_it,
)
