"""Every check of the hostile campaign can go red: what breaks a rule is found and counted."""

import math
import time

import numpy as np
import pytest
from rich.console import Console
from sensor_msgs.msg import JointState

import campaign
from hostile import library, live, steps, supervised
from hostile.listening import Judge, floats_of
from hostile.messages import refused_joints, refused_stamped, refused_twist, stamp
from hostile.rules import broken_clearances, broken_limits, speeds_up
from hostile.verdict import Verdict
from wrist_control.errors import RefusedError
from wrist_control.resolving.commands import CommandPolicy, ReceivedTwist
from wrist_control.resolving.joint_order import in_joint_order
from wrist_control.resolving.period import Mode
from wrist_control.resolving.state import State
from wrist_control.resolving.step import step
from wrist_control.resolving.supervisor import Supervisor
from wrist_control.ros import convert
from wrist_control.wrists import Clearance, Joint, make_wrist

DT = 0.01
JOINT = Joint('psi', 'revolute', -1.0, 1.0, 0.5, acceleration_limit=2.0, deceleration_limit=5.0)


class Stream:
    """Joint commands of one joint, and what the judge finds in them."""

    def __init__(self):
        self.verdict = Verdict('test')
        self.judge = Judge([JOINT], DT, self.verdict)
        self.now = 1e9  # a clock of its own: only when they are heard counts

    def say(self, position, rate, periods=1.0, name='psi'):
        self.now += periods * DT
        message = JointState(name=[name], position=[position], velocity=[rate])
        message.header.stamp = stamp(self.now)
        self.judge.hear(message)

    def found(self):
        return self.verdict.limits, self.verdict.nonfinite, self.verdict.uncommanded


@pytest.fixture
def stream():
    made = Stream()
    made.judge.allow(60.0)
    made.say(0.0, 0.0)
    return made


def speed_up(stream, position=0.0):
    for number in range(1, 11):
        position += 0.02 * number * DT
        stream.say(position, 0.02 * number)
    return position


def test_a_good_motion_is_not_found(stream):
    position = speed_up(stream)
    for rate in (0.15, 0.1, 0.05, 0.0):
        position += rate * DT
        stream.say(position, rate)
    assert stream.found() == (0, 0, 0)


def test_after_a_pause_the_joints_are_slower_than_they_were_told(stream):
    position = speed_up(stream)
    stream.say(position + 0.05 * DT, 0.05, periods=4.0)
    assert stream.found() == (0, 0, 0)


@pytest.mark.parametrize(
    ('position', 'rate'),
    [
        (0.00021, 0.021),  # speeds up too quickly
        (0.006, 0.6),  # too fast, and speeds up too quickly
        (0.3, 0.0),  # jumps
        (1.1, 0.0),  # outside
    ],
)
def test_a_command_that_breaks_a_limit_is_found(stream, position, rate):
    stream.say(position, rate)
    assert stream.found()[0] > 0


def test_a_stop_that_is_too_sudden_is_found(stream):
    stream.say(speed_up(stream), 0.0)
    assert stream.found() == (1, 0, 0)


def test_a_jump_is_none_where_the_joints_say_that_they_rest_there(stream):
    stream.judge.hear_joints(JointState(name=['psi'], position=[0.4]))
    stream.say(0.4, 0.0, periods=20.0)
    assert stream.found() == (0, 0, 0)
    stream.say(0.7, 0.0, periods=20.0)
    assert stream.found()[0] == 1


@pytest.mark.parametrize('bad', [math.nan, math.inf])
def test_numbers_that_are_none_are_found(stream, bad):
    stream.say(bad, 0.0)
    stream.say(0.0, bad)
    assert stream.found() == (0, 2, 0)


def test_other_names_are_found(stream):
    stream.say(0.0, 0.0, name='theta')
    assert stream.found()[0] == 1


def test_motion_without_a_command_and_after_a_stop_is_found():
    stream = Stream()
    stream.judge.grace = 0.0
    stream.say(0.0, 0.0)
    stream.say(0.0001, 0.01)
    assert stream.found() == (0, 0, 1)
    stream.judge.allow(60.0)
    stream.say(0.0002, 0.01)
    assert stream.found() == (0, 0, 1)
    stream.judge.forbid(stopped=True)
    stream.judge.allow(60.0)
    stream.say(0.0003, 0.01)
    assert stream.found() == (0, 0, 2)
    stream.judge.go_on()
    stream.judge.allow(60.0)
    stream.say(0.0004, 0.01)
    assert stream.found() == (0, 0, 2)


def test_floats_are_found_however_deep():
    message = JointState(position=[1.0, math.nan], effort=[3.0])
    assert sum(map(math.isnan, floats_of(message))) == 1


@pytest.mark.parametrize(
    ('position', 'before', 'rate', 'found'),
    [
        (0.0, 0.0, 0.02, 0),
        (0.0, 0.0, 0.0201, 1),
        (0.0, 0.05, 0.0, 0),
        (0.0, 0.051, 0.0, 1),
        (0.0, 0.025, -0.01, 0),
        (0.0, 0.025, -0.011, 1),
        (0.0, 0.5, 0.5001, 1),
        (1.0 + 1e-9, 0.0, 0.0, 0),
        (1.0 + 1e-8, 0.0, 0.0, 1),
        (math.nan, 0.0, 0.0, 1),
    ],
)
def test_the_rules_of_joints(position, before, rate, found):
    broken = [*broken_limits([JOINT], [0.0], [position], [before], [rate], DT)]
    assert len(broken) == found


def test_who_starts_outside_may_be_no_further_outside():
    assert not [*broken_limits([JOINT], [1.01], [1.01], [0.0], [0.0], DT)]
    assert [*broken_limits([JOINT], [1.01], [1.011], [0.0], [0.0], DT)]


def test_the_rule_of_clearances():
    inside, outside = Clearance('cone', 0.1), Clearance('cone', -1e-8)
    assert not [*broken_clearances([inside], [Clearance('cone', -1e-9)])]
    assert [*broken_clearances([inside], [outside])]
    assert not [*broken_clearances([outside], [outside])]
    assert [*broken_clearances([inside], [Clearance('cone', math.nan)])]


def test_the_rule_of_coming_to_rest():
    assert not speeds_up([0.2, -0.1], [0.1, -0.1], DT)
    assert speeds_up([0.2, -0.1], [0.1, -0.11], DT)
    assert speeds_up([0.2], [-0.1], DT)
    assert speeds_up([0.0], [1e-9], DT)


@pytest.fixture
def flight():
    wrist = make_wrist('three_gimbal').with_limits(rates=0.5, accelerations=2.0, decelerations=5.0)
    return steps.Flight(wrist, (0.1, 0.2, 0.3), DT, Verdict('test'))


def test_a_good_flight_is_not_found(flight):
    for _ in range(20):
        flight.fly([0.3, 0.1, 0.0])
    flight.stop()
    flight.refuse([math.nan, 0.0, 0.0])
    assert flight.state.joint_rates == ()
    assert flight._verdict.good


def tampered(flight, twist=(0.1, 0.0, 0.0), **changes):
    taken = step(flight.wrist, flight.state, twist, DT)
    flight.judge(flight.state, taken._replace(**changes), twist)
    return flight._verdict


def test_every_finding_about_a_step_is_counted_and_told(flight):
    state = State((math.nan, 0.0, 0.0), flight.state.pose)
    assert tampered(flight, state=state).nonfinite == 1
    assert tampered(flight, joint_rates=(0.6, 0.0, 0.0)).limits == 2
    assert tampered(flight, scale_factor=1.5).limits == 3
    assert tampered(flight, (0.0, 0.0, 0.0), joint_rates=(0.01, 0.0, 0.0)).uncommanded == 1
    assert 'ThreeGimbal, dt 0.01, command [0.1, 0.0, 0.0]' in flight._verdict.examples[0]


def test_a_command_that_is_not_refused_is_found(flight, monkeypatch):
    monkeypatch.setattr(steps, 'step', lambda *_: None)
    flight.refuse([math.nan, 0.0, 0.0])
    assert flight._verdict.nonfinite == 1


def test_an_error_that_nobody_expected_is_found(monkeypatch):
    def broken(*_):
        raise ValueError('math domain error')

    monkeypatch.setattr(steps, 'step', broken)
    verdict, _ = steps.attack('three_gimbal', steps.KINDS[0], 1, (1,))
    assert verdict.dead > 0
    assert 'math domain error' in verdict.examples[0]


def test_a_supervisor_that_does_not_stop_is_found(monkeypatch):
    stop = Supervisor.stop
    monkeypatch.setattr(
        Supervisor,
        'stop',
        lambda self, message, then: None if then is Mode.DISABLED else stop(self, message, then),
    )
    (verdict,) = supervised.attack('three_gimbal', 3000, (1,))
    assert verdict.uncommanded > 0


def test_a_supervisor_that_stops_at_once_is_found(monkeypatch):
    monkeypatch.setattr(
        Supervisor, 'stop', lambda self, message, then: self._settle(then, message)
    )
    (verdict,) = supervised.attack('three_gimbal', 3000, (1,))
    assert verdict.limits > 0


def test_what_must_be_refused_is_refused_in_the_library():
    random, names = np.random.default_rng(1), ['psi', 'theta', 'phi']
    policy = CommandPolicy(0.25)
    for _ in range(500):
        now = time.time()
        message = refused_stamped(random)
        twist = convert.twist_values(message.twist)
        received = ReceivedTwist(
            twist, message.header.frame_id, convert.seconds(message.header.stamp)
        )
        with pytest.raises(RefusedError):
            policy.accept(received, stamp_time=now, receipt_time=now)
        received = ReceivedTwist(convert.twist_values(refused_twist(random)))
        with pytest.raises(RefusedError):
            policy.accept(received, stamp_time=now, receipt_time=now)
        joints = refused_joints(names, random)
        try:
            values = in_joint_order(names, joints.name, joints.position)
        except RefusedError:
            continue
        assert not all(map(math.isfinite, values))


def test_the_parts_make_at_least_as_many_steps_as_are_asked_for_each_with_its_own_seed():
    parts = library.parts(100_000, 1)
    assert sum(part.length for part in parts) >= 100_000
    assert len({part.seed for part in parts}) == len(parts)
    assert {part.wrist for part in parts} == set(library.WRISTS)
    assert library.parts(100_000, 1) == parts


@pytest.mark.parametrize('kind', ['', 'limits', 'nonfinite', 'dead', 'uncommanded'])
def test_the_exit_code_says_whether_anything_was_found(monkeypatch, capsys, kind):
    verdict = Verdict('an attack', 7)
    if kind:
        verdict.find(kind, 'somewhere')
    monkeypatch.setattr(library, 'verdicts', lambda *_: [verdict])
    monkeypatch.setattr(live, 'verdicts', lambda *_: iter([Verdict('another', 8)]))
    monkeypatch.setattr('sys.argv', ['campaign.py'])
    assert campaign.main() == (1 if kind else 0)
    assert 'another' in capsys.readouterr().out


def test_a_table_shows_every_count_and_rows_add_up():
    one, other = Verdict('an attack', 1), Verdict('an attack', 2)
    for number, kind in enumerate(('limits', 'nonfinite', 'dead', 'uncommanded')):
        for _ in range(3 + number):
            other.find(kind, 'somewhere')
    one.add(other)
    console = Console(record=True, width=120)
    assert not campaign.show([one], console)
    row = next(line for line in console.export_text().splitlines() if 'an attack' in line)
    assert [int(word) for word in row.split() if word.isdigit()] == [3, 3, 4, 5, 6]
    assert len(one.examples) == 5
