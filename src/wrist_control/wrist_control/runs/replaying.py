"""The steps of a recorded run made again, each from what it was made from, and compared.

A supervisor of the same wrist is told what the recorded one was told, in the recorded order and
at the recorded times: its clock is the recording's. The same code then makes the same numbers, to
the last bit; where it does not, the code or its parameters are others than they were.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from wrist_control.bags.run import Run, numbers, stamp_of, twist_of
from wrist_control.errors import InvalidValueError
from wrist_control.resolving.feedback import Remembered
from wrist_control.resolving.period import Mode, PeriodResult
from wrist_control.resolving.state import State
from wrist_control.resolving.witness import Before, Heard, Kind, WitnessedSupervisor, positions_of
from wrist_control.runs.resolver import Resolver, resolver_of
from wrist_control.runs.series import pose_of


@dataclass
class Comparison:
    """How the steps that were made again compare with those that are recorded.

    Attributes:
        recorded: How many steps are recorded.
        replayed: How many of them were made again.
        compared: How many joint commands were compared.
        same: How many of them are the same to the last bit.
        unheard: How many joint commands the recording lacks.
        unmade: How many joint commands it has of steps that could not be made again.
        lost: How many steps the recording lacks.
        commands: How many commands counted in those steps.
        found: How many of those are on the topics of commands as well.
        largest: The largest difference of a joint position, rad or m.
        first: When the first difference was, s from the beginning, and of which joint.
    """

    recorded: int = 0
    replayed: int = 0
    compared: int = 0
    same: int = 0
    unheard: int = 0
    unmade: int = 0
    lost: int = 0
    commands: int = 0
    found: int = 0
    largest: float = 0.0
    first: tuple[float, str] | None = None

    @property
    def exact(self) -> bool:
        """Whether there is something to compare, and all of it is the same."""
        return self.compared == self.same > 0

    def sentences(self) -> Iterator[str]:
        """Say how they compare, and what could not be compared."""
        yield (
            f'Made {self.replayed} of {self.recorded} steps again, from {self.commands} commands '
            f'that counted; {self.found} of those are recorded as they were sent.'
        )
        if self.exact:
            yield f'All {self.compared} joint commands are the same to the last bit.'
        elif self.compared:
            when, joint = self.first or (0.0, '')
            yield (
                f'{self.compared - self.same} of {self.compared} joint commands differ, first '
                f'{when:.3f} s after the beginning, in {joint}; by at most {self.largest:.3g} '
                'rad (m).'
            )
        else:
            yield 'There was no joint command to compare: nobody was allowed to move the joints.'
        if self.lost:
            yield (
                f'{self.lost} steps are not in the recording; after each gap the replay begins '
                'anew where the hand rests.'
            )
        if self.unmade:
            yield (
                f'{self.unmade} joint commands are of steps that are not in the recording, or '
                'from before the hand rested: they were not compared.'
            )
        if self.unheard:
            yield f'{self.unheard} joint commands are not in the recording.'


class Replay:
    """Makes the steps of a run again."""

    def __init__(self, run: Run) -> None:
        """Prepare.

        Args:
            run: What was recorded.

        Raises:
            InvalidValueError: The steps were not recorded.
        """
        self._run = run
        self._steps = [each.message for each in run.messages('step_inputs')]
        if not self._steps:
            raise InvalidValueError(
                f'{run.path} does not say what its steps were made from: there is nothing on '
                f'{run.space}step_inputs; record it with `recorder`.'
            )
        self._told = {stamp_of(one): one for _, one in run.messages('joint_command')}
        self._asked = _asked(run)
        self._resolver: Resolver | None = None
        self._supervisor: WitnessedSupervisor | None = None
        self.comparison = Comparison(recorded=len(self._steps))

    def make(self, tell: Callable[[float], None] = lambda share: None) -> Comparison:
        """Make the steps, and compare each.

        Args:
            tell: Called now and then with the share that is made, 0 to 1.

        Raises:
            InvalidValueError: There is no step to begin with.
        """
        last = 0
        for count, inputs in enumerate(self._steps):
            number = int(inputs.number)
            if last and number != last + 1:
                self._supervisor = None  # until it rests again
                self.comparison.lost += max(0, number - last - 1)
            last = number
            self._make(inputs)
            if count % 64 == 0:
                tell(count / len(self._steps))
        tell(1.0)
        if not self.comparison.replayed:
            raise InvalidValueError(
                f'{self._run.path} has no moment at which the hand rests, to begin a replay with; '
                'begin to record before it moves.'
            )
        self.comparison.unmade = len(self._told) - self.comparison.compared
        return self.comparison

    def _make(self, inputs: Any) -> None:
        heard = [_heard(one) for one in inputs.heard]
        if self._supervisor is None:
            self._begin(inputs, heard)
        if self._supervisor is None:
            return
        for one in heard:
            self._hear(self._supervisor, one)
        result = self._supervisor.tick(
            stamp_time=1e-9 * stamp_of(inputs),  # as convert.seconds_of
            receipt_time=float(inputs.receipt_time),
            withheld=inputs.withheld,
            pause=float(inputs.pause),
        )
        self._supervisor.turn_over()
        self.comparison.replayed += 1
        self._compare(stamp_of(inputs), result)

    def _begin(self, inputs: Any, heard: list[Heard]) -> None:
        """Begin where the recorded hand rests, once its resolver is known."""
        if heard and heard[0].kind is Kind.PARAMETERS:
            self._resolver = resolver_of(self._run, heard[0].text)
        if self._resolver is not None and inputs.resting:
            _, wrist, settings, _ = self._resolver
            self._supervisor = WitnessedSupervisor(wrist, settings)
            self._supervisor.begin_where(_before(self._resolver, inputs))
        elif any(one.kind is Kind.PARAMETERS for one in heard):
            text = [one.text for one in heard if one.kind is Kind.PARAMETERS][-1]
            self._resolver = resolver_of(self._run, text)

    def _hear(self, supervisor: WitnessedSupervisor, heard: Heard) -> None:
        if heard.kind is Kind.PARAMETERS:
            self._resolver = resolver_of(self._run, heard.text)
            supervisor.wrist = self._resolver.wrist
            supervisor.settings = self._resolver.settings
            return
        if heard.kind is Kind.COMMAND:
            self.comparison.commands += 1
            self.comparison.found += (heard.stamp, heard.values) in self._asked
        supervisor.hear(heard)

    def _compare(self, stamp: int, result: PeriodResult) -> None:
        told, seen = self._told.get(stamp), self.comparison
        if told is None:
            seen.unheard += result.moving_allowed
            return
        positions, rates = numbers(told.position), numbers(told.velocity)
        made = tuple(map(float, result.step.state.positions))
        seen.compared += 1
        same = (*positions, *rates) == (*made, *map(float, result.step.joint_rates))
        if result.moving_allowed and same:
            seen.same += 1
            return
        gaps = np.abs(np.array(positions) - np.array(made))
        seen.largest = max(seen.largest, float(gaps.max()))
        if seen.first is None:
            since = 1e-9 * (stamp - stamp_of(self._steps[0]))
            seen.first = since, str(told.name[int(gaps.argmax())])


def _asked(run: Run) -> set[tuple[float | None, tuple[float, ...]]]:
    """Return every command of the recording, by its stamp, s, and its twist."""
    stamped = {
        (1e-9 * stamp_of(one) if stamp_of(one) else None, twist_of(one.twist))
        for _, one in run.messages('cmd_vel')
    }
    return stamped | {(None, twist_of(one)) for _, one in run.messages('cmd_vel_unstamped')}


def _heard(one: Any) -> Heard:
    return Heard(
        kind=Kind(int(one.kind)),
        receipt_time=float(one.receipt_time),
        stamp=None if math.isnan(one.stamp) else float(one.stamp),
        values=numbers(one.values),
        names=tuple(one.names),
        flag=bool(one.flag),
        text=one.text,
        then=one.then,
    )


def _before(resolver: Resolver, inputs: Any) -> Before:
    pose = pose_of(inputs)
    positions = numbers(inputs.positions)
    state = State(
        positions_of(resolver.wrist, positions, pose, bool(inputs.assembled)),
        pose,
        numbers(inputs.steering),
        float(inputs.time_lost),
    )
    since = float(inputs.withheld_since)
    return Before(
        Mode[inputs.mode],
        bool(inputs.resting),
        bool(inputs.adopted),
        state,
        None if math.isnan(since) else since,
        Remembered(
            numbers(inputs.joints),
            numbers(inputs.joints_first),
            int(inputs.joints_count),
            float(inputs.joints_receipt),
        ),
    )
