"""Supervisors that note what they are told: told the same, another one does the same."""

import math
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wrist_control import WristError, make_wrist
from wrist_control.resolving.commands import Command
from wrist_control.resolving.period import Mode, SupervisorSettings
from wrist_control.resolving.supervisor import Supervisor
from wrist_control.resolving.witness import MOST, Kind, WitnessedSupervisor, positions_of
from wrist_control.wrists.wrist import Configuration

DT = 0.01
WRISTS = ('three_gimbal', 'four_gimbal', 'pitch_yaw', 'stewart')

RATES = st.floats(-0.8, 0.8)
ACTS = st.one_of(
    st.tuples(st.just('command'), st.tuples(RATES, RATES, RATES), st.booleans()),
    st.tuples(st.just('joints'), st.integers(1, 5)),
    st.tuples(st.just('silence'), st.integers(1, 40)),
    st.tuples(st.just('withheld'), st.integers(1, 8)),
    st.tuples(st.just('late'), st.floats(0.0, 0.3)),
    st.tuples(st.sampled_from(['stop', 'enable', 'disable', 'reset', 'fault', 'give_up'])),
    st.tuples(st.just('off'), st.floats(-0.2, 0.2)),
)


class Driven:
    """A supervisor with somebody who does this and that, and a log of what came of it."""

    def __init__(self, kind, wrist):
        self.wrist = wrist
        self.settings = SupervisorSettings(
            dt=DT,
            command_timeout=0.05,
            stop_time=0.05,
            initial_positions=tuple(wrist.home),
            tracking_tolerance=(0.1,) * len(wrist.joints),
            feedback_timeout=0.1,
        )
        self.supervisor = kind(wrist, self.settings)
        self.now = 5.0
        self.ticks, self.results, self.pages = [], [], []

    def tick(self, withheld='', pause=DT):
        self.now += pause
        told = {
            'stamp_time': self.now + 1000.0,
            'receipt_time': self.now,
            'withheld': withheld,
            'pause': pause,
        }
        result = self.supervisor.tick(**told)
        self.ticks.append(told)
        self.results.append(result)
        if isinstance(self.supervisor, WitnessedSupervisor):
            self.pages.append((self.supervisor.before, list(self.supervisor.heard)))
            self.supervisor.turn_over()

    def joints(self, off=0.0):
        names = [joint.name for joint in self.wrist.joints]
        where = [float(x) for x in self.supervisor.state.positions]
        where[0] += off
        with suppress(WristError):
            self.supervisor.take_measured([*names[::-1], 'other'], [*where[::-1], 9.0], self.now)

    def do(self, act):
        name, *more = act
        if name == 'command':
            rates, in_forearm = more
            twist = (0.0, 0.0, 0.0, *rates)
            stamp = self.now + 1000.0
            self.supervisor.take_command(Command(twist, in_forearm, stamp, self.now))
        elif name in ('joints', 'silence', 'withheld'):
            for _ in range(more[0]):
                if name != 'silence':
                    self.joints()
                self.tick('Held.' if name == 'withheld' else '')
        elif name == 'late':
            self.tick(pause=DT + more[0])
        elif name == 'off':
            self.joints(more[0])
        else:
            self.ask(name)
        self.joints()
        self.tick()

    def ask(self, name):
        asked = {
            'stop': lambda: self.supervisor.stop('Stopped.', Mode.DISABLED),
            'fault': lambda: self.supervisor.stop('Broken.', Mode.FAULT),
            'enable': lambda: self.supervisor.enable(True, receipt_time=self.now),
            'disable': lambda: self.supervisor.enable(False, receipt_time=self.now),
            'reset': self.supervisor.reset,
            'give_up': lambda: self.supervisor.give_up('No way.'),
        }
        with suppress(WristError):
            asked[name]()


def begun(kind, name):
    driven = Driven(kind, make_wrist(name))
    for _ in range(4):
        driven.joints()
        driven.tick()
    return driven


def again(driven, first):
    """Return what another supervisor makes of what was noted, from a moment of rest on."""
    other = WitnessedSupervisor(driven.wrist, driven.settings)
    before = driven.pages[first][0]
    state = before.state
    known = isinstance(state.positions, Configuration)
    plain = tuple(map(float, state.positions))  # as a message says them
    positions = positions_of(driven.wrist, plain, state.pose, known)
    other.begin_where(before._replace(state=state._replace(positions=positions)))
    results = []
    for (_, heard), told in zip(driven.pages[first:], driven.ticks[first:], strict=True):
        for one in heard:
            other.hear(one)
        results.append(other.tick(**told))
        other.turn_over()
    return results


def numbers(result):
    """Return all of a result but its words."""
    state = result.step.state
    return (
        result.moving_allowed,
        tuple(state.positions),
        state.pose,
        state.steering_state,
        state.time_lost,
        result.step.joint_rates,
        result.step.scale_factor,
        result.commanded,
        result.wrist_state,
    )


@pytest.mark.parametrize('name', WRISTS)
@settings(max_examples=25, deadline=None)
@given(acts=st.lists(ACTS, min_size=1, max_size=25))
def test_what_was_noted_is_enough_from_every_moment_of_rest_on(name, acts):
    driven = begun(WitnessedSupervisor, name)
    for act in acts:
        driven.do(act)
    at_rest = [row for row, (before, _) in enumerate(driven.pages) if before.resting]
    assert at_rest[0] == 0
    for first in {0, at_rest[min(1, len(at_rest) - 1)], at_rest[len(at_rest) // 2], at_rest[-1]}:
        made = again(driven, first)
        assert [numbers(one) for one in made] == [numbers(one) for one in driven.results[first:]]


@settings(max_examples=25, deadline=None)
@given(acts=st.lists(ACTS, min_size=1, max_size=25))
def test_it_does_as_every_supervisor_does(acts):
    witnessed, plain = (
        begun(WitnessedSupervisor, 'three_gimbal'),
        begun(Supervisor, 'three_gimbal'),
    )
    for act in acts:
        witnessed.do(act)
        plain.do(act)
    assert witnessed.results == plain.results


def test_a_moving_hand_is_not_at_rest_and_neither_is_one_that_is_asked_to_move():
    driven = begun(WitnessedSupervisor, 'three_gimbal')
    assert driven.supervisor.before.resting
    twist = (0.0, 0.0, 0.0, 0.2, 0.0, 0.0)
    driven.supervisor.take_command(Command(twist, False, None, driven.now))
    driven.supervisor.turn_over()
    assert not driven.supervisor.before.resting
    driven.tick()
    assert not driven.supervisor.before.resting


def test_what_is_refused_and_what_is_others_is_not_noted():
    driven = begun(WitnessedSupervisor, 'three_gimbal')
    with pytest.raises(WristError):
        driven.supervisor.take_measured(['psi', 'theta', 'phi'], [math.nan] * 3, driven.now)
    assert driven.supervisor.heard == []
    driven.joints()
    (heard,) = driven.supervisor.heard
    assert (heard.kind, heard.names) == (Kind.JOINTS, ('phi', 'theta', 'psi'))


def test_what_a_supervisor_does_by_itself_is_not_noted():
    driven = begun(WitnessedSupervisor, 'three_gimbal')
    twist = (0.0, 0.0, 0.0, 0.2, 0.0, 0.0)
    driven.supervisor.take_command(Command(twist, False, None, driven.now))
    for _ in range(40):  # the joints fall silent: it stops itself, into a fault
        driven.tick()
    assert driven.supervisor.mode is Mode.FAULT
    kinds = [one.kind for _, heard in driven.pages for one in heard]
    assert set(kinds) == {Kind.JOINTS, Kind.COMMAND}


def test_who_is_told_too_much_forgets_it_and_counts_a_step_more():
    driven = begun(WitnessedSupervisor, 'three_gimbal')
    before = driven.supervisor.number
    for _ in range(MOST + 1):
        driven.joints()
    assert len(driven.supervisor.heard) == 1
    driven.tick()
    assert driven.supervisor.number == before + 2
