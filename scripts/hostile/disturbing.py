"""Attacks on what the nodes stand on: clocks, processes, parameters, services."""

from __future__ import annotations

import math
import signal
import time
from collections import deque
from typing import Any

from geometry_msgs.msg import TwistStamped
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool, Trigger

from hostile.commanding import OPERATOR, PACE, paced
from hostile.messages import STRINGS, honest, stamp
from hostile.numbers import hostile_number
from hostile.stage import DT, LIMITS, WRIST, Stage
from wrist_control.testing.places import Random

FIXED = ('rate', 'initial_positions', 'require_joint_states', 'use_sim_time', 'no_such', '')
# Where these are narrowed under way the space to stop in is gone, and joints stop as they can.
BRAKES = ('joint_lower_limits', 'joint_upper_limits', 'joint_deceleration_limits')
# Numbers that every other parameter takes.
SOME_NUMBERS = (0.05, 0.1, 0.3, 0.5, 1.0)
# What the live parameters are at the start.
AT_FIRST = {
    **LIMITS,
    'command_timeout': 0.25,
    'stop_time': 0.1,
    'feedback_timeout': 0.25,
    'tracking_tolerance': [0.1],
    'tracking_time': 0.25,
}
LIVE = tuple(AT_FIRST)


class SimulatedClock:
    """A clock that jumps, stands and goes on.

    Attributes:
        now: What it says, s.
    """

    def __init__(self, stage: Stage) -> None:
        """Begin long after zero."""
        self.now = 1e5
        self._publisher = stage.publisher(Clock, 'clock', 2)

    def go_on(self, seconds: float = DT) -> None:
        """Say a later time, or an earlier one, s."""
        self.now = max(1.0, self.now + seconds)
        self._publisher.publish(Clock(clock=stamp(self.now)))

    def ticked(self) -> bool:
        """Go on by a period, in about that time; return that it is so."""
        self.go_on()
        time.sleep(DT)
        return True


def clock_jumps(stage: Stage, random: Random, count: int) -> None:
    """Let a simulated clock jump to and fro, stand still, run fast and slow."""
    stage.hand(use_sim_time=True)
    clock = SimulatedClock(stage)
    stage.until(lambda: clock.ticked() and stage.judge.heard > 0, 'no joint_command')
    publisher = stage.publisher(TwistStamped, 'cmd_vel')
    ahead = 1.0
    for _ in paced(count // 2, 1.0 / DT):
        kind = random.random()
        if kind < 0.01:
            clock.go_on(float(random.choice([-500.0, -1.0, -0.05, 0.05, 0.5, 500.0, 1e6])))
        elif kind < 0.015:
            time.sleep(float(random.choice([0.1, 0.4])))
        elif kind < 0.025:
            ahead = float(random.choice([0.3, 1.0, 1.0, 2.0]))
        clock.go_on(ahead * DT)
        stage.judge.allow(2.0 * stage.judge.grace)
        publisher.publish(honest(random, clock.now))
        stage.sent(2)
    stage.follows_again(clock.go_on)
    for _ in paced(200, 1.0 / DT):  # /diagnostics is on a steady clock, joint states are not
        clock.go_on()


def _stopped_processes(stage: Stage, random: Random, count: int, executable: str) -> None:
    stage.hand()
    stage.until_held()
    publisher = stage.publisher(TwistStamped, 'cmd_vel')
    enable = stage.client(SetBool, f'{WRIST}_resolver/enable')
    until, stopped = 0, False
    for number in paced(count, 4.0 * OPERATOR):
        if number >= until:
            stopped = not stopped
            stage.signal(executable, signal.SIGSTOP if stopped else signal.SIGCONT)
            most = 200 if stopped else 100
            until = number + int(random.integers(2, most))
            if not stopped:
                enable.call_async(SetBool.Request(data=True))
        stage.judge.allow()
        publisher.publish(honest(random))
        stage.sent()
    stage.signal(executable, signal.SIGCONT)


def stopped_resolver(stage: Stage, random: Random, count: int) -> None:
    """Hold up the resolver's process, for a moment or a second, under way."""
    _stopped_processes(stage, random, count, f'{WRIST}_resolver')


def stopped_joints(stage: Stage, random: Random, count: int) -> None:
    """Hold up the joints' process, for a moment or a second, under way."""
    _stopped_processes(stage, random, count, 'joint_simulator')


def killed_joints(stage: Stage, random: Random, count: int) -> None:
    """Kill the joints under way, and start them somewhere else."""
    stage.hand()
    stage.until_held()
    publisher = stage.publisher(TwistStamped, 'cmd_vel')
    enable = stage.client(SetBool, f'{WRIST}_resolver/enable')
    dead, until = False, 100
    for number in paced(count, 4.0 * OPERATOR):
        if number >= until:
            if dead:
                stage.again('joint_simulator')
            else:
                stage.signal('joint_simulator', signal.SIGKILL)
            dead, until = not dead, number + int(random.integers(100, 600))
        if number % 50 == 0:
            enable.call_async(SetBool.Request(data=True))
        stage.judge.allow()
        publisher.publish(honest(random))
        stage.sent()
    if dead:
        stage.again('joint_simulator')


def killed_operator(stage: Stage, random: Random, count: int) -> None:
    """Kill an operator that turns the hand: it comes to rest, and follows the next one."""
    stage.hand()
    stage.until_held()
    parameters = stage.client(SetParameters, f'{WRIST}_resolver/set_parameters')
    end = max(1, count // 100)
    for kills in range(end):
        rates = [float(x) for x in random.uniform(-0.3, 0.3, size=3)]
        stage.judge.allow(60.0)
        stage.start('operator', maneuver='constant', constant_rates=rates)
        stage.until(lambda: stage.judge.moving, 'the operator does not move the hand')
        for _ in paced(100, 4.0 * OPERATOR):
            _call(parameters, 'no_such', hostile_number(random))
            stage.sent()
        stage.signal('operator', signal.SIGKILL)
        stage.judge.forbid()
        time.sleep(2.0 * stage.judge.grace)
        if kills == end - 1:
            stage.judge.allow(math.inf)
            stage.again('operator')


def parameters_and_services(stage: Stage, random: Random, count: int) -> None:
    """Set parameters of any kind and call services at any time, under way."""
    stage.hand()
    stage.until_held()
    stage.judge.grace = 4.0  # some of what is set makes stops slower
    publisher = stage.publisher(TwistStamped, 'cmd_vel')
    name = f'{WRIST}_resolver'
    parameters = stage.client(SetParameters, f'{name}/set_parameters')
    enable = stage.client(SetBool, f'{name}/enable')
    reset = stage.client(Trigger, f'{name}/reset')
    pending: deque[Any] = deque()
    for number in paced(count, PACE / 3.0):
        while pending and pending[0].done():
            pending.popleft()
        kind = random.random()
        if len(pending) > 100:
            time.sleep(0.01)
        elif kind < 0.9:
            which = str(random.choice([*LIVE, *LIVE, *FIXED]))
            pending.append(_call(parameters, which, _value(which, random)))
        elif kind < 0.97:
            pending.append(enable.call_async(SetBool.Request(data=bool(random.random() < 0.8))))
        else:
            pending.append(reset.call_async(Trigger.Request()))
        if number % 10 == 0:
            stage.judge.allow()
            publisher.publish(honest(random))
        stage.sent()
    restored = [_call(parameters, which, value) for which, value in AT_FIRST.items()]
    stage.until(lambda: all(one.done() for one in restored), 'no answer to parameters')


def _value(name: str, random: Random) -> object:
    """Return a value for a parameter: of any kind, or, seldom, one that it takes."""
    kind = random.random()
    if name in BRAKES and kind < 0.7:
        return [math.nan] * int(random.integers(0, 9))
    if kind < 0.3:
        number = float(random.choice(SOME_NUMBERS))
        return [number] if name.endswith(('_limits', 'tolerance')) else number
    if kind < 0.5:
        bad = hostile_number(random)
        return bad if not math.isfinite(bad) or bad <= 0.0 else -bad
    if kind < 0.7:
        count = int(random.integers(0, 9))
        return [float(random.choice([math.nan, -1.0, -math.inf])) for _ in range(count)]
    others = (True, int(random.integers(-(2**62), 0)), str(random.choice(STRINGS)), None)
    return others[int(random.integers(len(others)))]


def _call(client: Any, name: str, value: object) -> Any:
    parameter = Parameter(name=name, value=_message(value))
    return client.call_async(SetParameters.Request(parameters=[parameter]))


def _message(value: object) -> ParameterValue:
    if isinstance(value, bool):
        return ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=value)
    if isinstance(value, int):
        return ParameterValue(type=ParameterType.PARAMETER_INTEGER, integer_value=value)
    if isinstance(value, float):
        return ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=value)
    if isinstance(value, str):
        return ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=value)
    if isinstance(value, list):
        kind = ParameterType.PARAMETER_DOUBLE_ARRAY
        return ParameterValue(type=kind, double_array_value=value)
    return ParameterValue()
