"""The keyboard in a terminal of its own, and a resolver with simulated joints that it turns."""

import os
import signal
import subprocess
import time

import pytest
from geometry_msgs.msg import TwistStamped

from wrist_control.graph.processes import executable_file
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus

from .broken_middleware import broken
from .typing_hand import Typist

KEYBOARD = [str(executable_file('keyboard'))]
SPEED = 0.28
# What is promised of a hand whose key was let go, s.
AT_REST_WITHIN = 0.6
P, Q, R = 'x', 'y', 'z'


class Desk:
    """A hand that is turned, and the terminal that turns it."""

    def __init__(self, graph):
        self.graph = graph
        self.typists = []
        self.commands = graph.listen(TwistStamped, 'cmd_vel')
        self.statuses = []

    def sit_down(self, *arguments, program=KEYBOARD, **options):
        environment = {**os.environ, 'ROS_DOMAIN_ID': str(self.graph.domain)}
        typist = Typist(environment, [*program, '--ros-args', *arguments], **options)
        self.typists.append(typist)
        self.graph.until(lambda: 'Ctrl-C ends' in typist.written)
        return typist

    def start_hand(self):
        self.statuses = self.graph.listen(WristStatus, 'wrist_status')
        self.graph.start(Resolver, 'three_gimbal', require_joint_states=True)
        self.graph.start(JointSimulator)
        self.until_state(WristStatus.IDLE)

    def until_state(self, state):
        self.graph.until(lambda: self.statuses and self.statuses[-1].state == state)

    def stop(self, typist):
        """Type a space once somebody hears it."""
        self.graph.until(lambda: self.graph.outside.count_publishers('stop'))
        self.graph.spin(0.3)
        typist.type(' ')
        self.until_state(WristStatus.DISABLED)

    def asks_for_zero(self):
        return self.commands[-1].twist == TwistStamped().twist

    def turns(self):
        """Return p, q, r that the hand makes now."""
        return self.statuses[-1].achieved.angular

    def moves_after(self, moment):
        """Return for how long the hand went on after a moment, s; it is at rest now."""
        moved = [
            status.header.stamp.sec + 1e-9 * status.header.stamp.nanosec
            for status in self.statuses
            if any(getattr(status.achieved.angular, axis) for axis in (P, Q, R))
        ]
        return moved[-1] - moment


@pytest.fixture
def desk(graph):
    made = Desk(graph)
    yield made
    for typist in made.typists:
        typist.close()


@pytest.fixture
def hand(desk):
    desk.start_hand()
    return desk


@pytest.mark.parametrize(
    ('key', 'axis', 'sign'),
    [('w', Q, 1), ('s', Q, -1), ('d', P, 1), ('a', P, -1), ('q', R, 1), ('e', R, -1)],
)
def test_a_held_key_turns_the_hand_about_its_axis(hand, key, axis, sign):
    typist = hand.sit_down()
    typist.hold(key)
    hand.graph.until(lambda: getattr(hand.turns(), axis) == pytest.approx(sign * SPEED, abs=1e-6))
    others = {P, Q, R} - {axis}
    assert all(abs(getattr(hand.turns(), other)) < 1e-6 for other in others)


def test_a_key_that_is_let_go_leaves_the_hand_at_rest_and_then_the_keyboard_is_silent(hand):
    typist = hand.sit_down()
    typist.hold('w')
    hand.graph.until(lambda: hand.turns().y > 0.9 * SPEED)
    typist.release()
    hand.until_state(WristStatus.IDLE)
    hand.graph.spin(1.0)
    assert hand.asks_for_zero()
    assert hand.moves_after(typist.last_key) < AT_REST_WITHIN
    silent_since = len(hand.commands)
    hand.graph.spin(0.5)
    assert len(hand.commands) == silent_since


def test_whoever_touches_no_key_publishes_nothing(hand):
    hand.sit_down()
    hand.graph.spin(0.5)
    assert hand.commands == []


def test_space_stops_and_disables_and_g_goes_on_without_a_key_that_was_held(hand):
    typist = hand.sit_down()
    typist.hold('d')
    hand.graph.until(lambda: hand.turns().x > 0.9 * SPEED)
    typist.release()
    hand.stop(typist)
    hand.graph.until(lambda: 'Sent a stop; g goes on.' in typist.page())
    hand.graph.until(lambda: any(line.startswith('DISABLED: ') for line in typist.page()))
    typist.hold('d')
    hand.graph.spin(0.5)
    typist.release()
    assert hand.statuses[-1].state == WristStatus.DISABLED
    assert hand.turns().x == 0.0
    hand.graph.until(hand.asks_for_zero)
    typist.type('g')
    hand.until_state(WristStatus.IDLE)
    hand.graph.spin(0.3)
    assert hand.turns().x == 0.0
    typist.hold('d')
    hand.graph.until(lambda: hand.turns().x > 0.9 * SPEED)


def test_the_keyboard_of_another_namespace_enables_nobody_here_and_says_so(hand):
    typist = hand.sit_down('-r', '__ns:=/left', size=(24, 100))
    typist.type('g')
    said = 'Enables nothing: /left/wrist_status comes from nobody, not one resolver.'
    hand.graph.until(lambda: said in ' '.join(typist.page()))


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_puts_the_terminal_back_and_ends_with_zero_asked_for(hand, number):
    typist = hand.sit_down()
    assert typist.attributes() != typist.found
    typist.hold('w')
    hand.graph.until(lambda: hand.turns().y > 0.9 * SPEED)
    typist.process.send_signal(number)
    hand.graph.until(lambda: typist.process.poll() is not None)
    assert typist.process.returncode == 0
    assert typist.attributes() == typist.found
    hand.graph.until(typist.has_left)
    hand.graph.until(hand.asks_for_zero)
    hand.graph.until(lambda: hand.turns().y == 0.0)


@pytest.mark.parametrize('clock', ['false', 'true'])
def test_control_c_is_such_a_signal(desk, clock):
    typist = desk.sit_down('-p', f'use_sim_time:={clock}')
    typist.type('\x03')
    desk.graph.until(lambda: typist.process.poll() is not None)
    assert typist.process.returncode == 0
    assert typist.attributes() == typist.found


def test_control_z_stops_the_hand_and_gives_the_terminal_back_until_it_goes_on(hand):
    typist = hand.sit_down()
    typist.hold('w')
    hand.graph.until(lambda: hand.turns().y > 0.9 * SPEED)
    typist.release()
    typist.type('\x1a')
    hand.graph.until(typist.is_stopped)
    assert typist.attributes() == typist.found
    hand.graph.until(typist.has_left)
    hand.graph.until(lambda: hand.turns().y == 0.0)
    hand.graph.until(hand.asks_for_zero)
    typist.type('wwww')  # held up until it goes on: for whoever had the terminal meanwhile
    before = len(hand.commands)
    typist.process.send_signal(signal.SIGCONT)
    hand.graph.until(lambda: typist.attributes() != typist.found)
    hand.graph.spin(0.5)
    assert not any(command.twist.angular.y for command in hand.commands[before:])
    typist.hold('w')
    hand.graph.until(lambda: hand.turns().y > 0.9 * SPEED)


def test_keys_that_were_held_up_while_the_keyboard_stood_still_move_nothing(hand):
    typist = hand.sit_down()
    typist.process.send_signal(signal.SIGSTOP)
    hand.graph.until(typist.is_stopped)
    typist.type('www')
    typist.process.send_signal(signal.SIGCONT)
    hand.graph.spin(0.7)
    assert not any(command.twist.angular.y for command in hand.commands)


def test_an_error_puts_the_terminal_back_and_is_told_afterwards(desk):
    typist = desk.sit_down(program=['python3', '-c', BROKEN], stderr=None)
    desk.graph.until(lambda: typist.process.poll() is not None)
    assert typist.process.returncode == 1
    assert typist.attributes() == typist.found
    desk.graph.until(lambda: 'the middleware is broken' in typist.written)
    after = typist.written.rpartition('\x1b[?1049l')[2]
    assert 'Traceback' in after


BROKEN = broken(2.0, 'from wrist_control.nodes import keyboard\nkeyboard.main()')


def test_a_terminal_that_closes_ends_it(desk):
    typist = desk.sit_down()
    typist.hang_up()
    desk.graph.until(lambda: typist.process.poll() is not None)
    assert typist.process.returncode == 0


def test_without_a_terminal_it_says_so_and_does_not_start(process_environment):
    done = subprocess.run(
        KEYBOARD,
        env=process_environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=30.0,
        check=False,
    )
    assert done.returncode == 2
    assert '[keyboard]: Cannot start: keyboard needs a terminal' in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert done.stdout == ''


def test_a_page_fits_into_a_narrow_terminal_and_follows_its_size(hand):
    typist = hand.sit_down(size=(24, 40))
    hand.stop(typist)
    hand.graph.until(lambda: any(line.startswith('DISABLED: ') for line in typist.page()))
    assert max(map(len, typist.page())) <= 40
    assert len(typist.page()) <= 24
    typist.resize(5, 20)
    hand.graph.until(lambda: len(typist.page()) == 5)
    assert max(map(len, typist.page())) <= 20
    typist.resize(24, 80)
    hand.graph.until(lambda: '  Ctrl-C ends' in typist.page())


def test_a_page_that_says_the_same_is_not_written_again(desk):
    typist = desk.sit_down()
    desk.graph.spin(0.5)
    before = len(typist.written)
    time.sleep(0.5)
    assert len(typist.written) == before


def test_keys_change_the_speed(hand):
    typist = hand.sit_down('-p', 'max_speed:=0.4')
    typist.type('+')
    hand.graph.until(lambda: 'speed 0.350 rad/s, 20.1 deg/s' in typist.page())
    for _ in range(3):
        typist.type('+')
    hand.graph.until(lambda: any(line.startswith('speed 0.400 rad/s') for line in typist.page()))
    typist.hold('d')
    hand.graph.until(lambda: hand.turns().x == pytest.approx(0.4, abs=1e-6))


def test_a_status_cannot_write_to_the_terminal_and_is_gone_when_it_is_old(desk):
    typist = desk.sit_down()
    publisher = desk.graph.publisher(WristStatus, 'wrist_status')

    def shown():
        publisher.publish(WristStatus(state=1, message='quiet \x1b[31m\x07 red'))
        return 'IDLE: quiet \\x1b[31m\\x07 red' in typist.page()

    desk.graph.until(shown)
    desk.graph.until(lambda: 'No wrist_status: no resolver is heard here.' in typist.page())
