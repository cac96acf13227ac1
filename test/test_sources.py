"""Two operators at once: one leads the hand, or nobody does, and both are named."""

import numpy as np
import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.duration import Duration

from wrist_control.nodes.operator import Operator
from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus

PERIOD = 0.02
PITCH = 0.3


class Stick:
    """Somebody who sends one rate of pitch, by a node of its own."""

    def __init__(self, graph, name, rate, topic='cmd_vel', node=None):
        self.graph, self.rate, self.count = graph, rate, 0
        self.node = node or graph.add(rclpy.create_node(name, context=graph.context))
        self.kind = Twist if topic == 'cmd_vel_unstamped' else TwistStamped
        self.publisher = self.node.create_publisher(self.kind, topic, 10)
        graph.until(lambda: self.publisher.get_subscription_count() == 1)

    def send(self, age=0.0, rate=None):
        message = self.kind()
        twist = message
        if self.kind is TwistStamped:
            stamp = self.node.get_clock().now() - Duration(seconds=age)
            message.header.stamp, twist = stamp.to_msg(), message.twist
        twist.angular.y = self.rate if rate is None else rate
        self.publisher.publish(message)


class Heard:
    """A resolver, and what it says."""

    def __init__(self, graph, **parameters):
        self.graph = graph
        graph.start(Resolver, 'three_gimbal', joint_rate_limits=[10.0], **parameters)
        self.statuses = graph.listen(WristStatus, 'wrist_status')
        self.diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
        graph.until(lambda: self.statuses)

    @property
    def followed(self):
        return np.array([status.commanded.angular.y for status in self.statuses])

    @property
    def message(self):
        return self.statuses[-1].message

    def counted(self):
        values = [v for a in self.diagnostics[-1:] for s in a.status for v in s.values]
        return {value.key: value.value for value in values}

    def run(self, seconds, *senders):
        """Let every sender send in turn, half a period apart, and return what was followed."""
        before = len(self.statuses)
        for _ in range(round(seconds / PERIOD)):
            for sender in senders:
                sender()
                self.graph.spin(PERIOD / len(senders))
        return self.followed[before:]


def swings(followed):
    """Return how often the hand was told to turn back."""
    signs = np.sign(followed[followed != 0.0])
    return np.count_nonzero(np.diff(signs))


def test_a_late_command_does_not_undo_a_stop(graph):
    heard = Heard(graph, command_timeout=5.0)
    stick = Stick(graph, 'alpha', PITCH)
    heard.run(0.2, stick.send)
    stick.send(rate=0.0)
    graph.until(lambda: heard.statuses[-1].state == WristStatus.IDLE)
    before = len(heard.statuses)
    for _ in range(5):
        stick.send(age=2.0)
        graph.spin(0.02)
    assert not heard.followed[before:].any()
    graph.until(lambda: heard.counted().get('refused cmd_vel: out of order') == '5')


def test_of_two_topics_one_leads_and_the_other_is_refused_counted_and_named(graph):
    heard = Heard(graph)
    one = Stick(graph, 'alpha', PITCH)
    other = Stick(graph, 'beta', -PITCH, 'cmd_vel_unstamped')
    heard.run(0.2, one.send)
    followed = heard.run(0.8, one.send, other.send)
    np.testing.assert_allclose(followed, PITCH)
    expected = 'commands of beta on cmd_vel_unstamped are refused while alpha on cmd_vel leads'
    assert expected in heard.message
    graph.until(lambda: 'refused cmd_vel_unstamped: another source leads' in heard.counted())
    graph.until(lambda: any(expected in s.message for a in heard.diagnostics for s in a.status))
    graph.spin(0.4)  # the first one is silent
    followed = heard.run(0.4, other.send)
    assert followed[-1] == -PITCH
    heard.run(0.8, other.send)
    assert heard.message == 'Following the command.'


@pytest.mark.parametrize('ahead', [0, 1, 5])
def test_two_that_cannot_be_told_apart_stop_the_hand_and_both_are_named(graph, ahead):
    heard = Heard(graph)
    one, other = Stick(graph, 'alpha', PITCH), Stick(graph, 'beta', -PITCH)
    for _ in range(ahead):
        other.send()
    graph.spin(1.5)
    followed = heard.run(1.0, one.send, other.send)
    assert swings(followed) == 0
    assert np.count_nonzero(followed) <= 12
    assert not followed[-50:].any()
    assert heard.statuses[-1].state == WristStatus.STALE
    assert heard.message == (
        'Stopped: alpha and beta send on cmd_vel and cannot be told apart; end all but one of '
        'them.'
    )
    heard.run(1.5, one.send)  # the other one falls silent
    assert heard.followed[-1] == PITCH


def test_the_one_who_leads_keeps_leading_when_another_begins_on_its_topic(graph):
    heard = Heard(graph)
    one = Stick(graph, 'alpha', PITCH)
    for _ in range(200):
        one.send()
    heard.run(0.3, one.send)
    other = Stick(graph, 'beta', -PITCH)
    followed = heard.run(0.8, one.send, other.send)
    np.testing.assert_allclose(followed, PITCH)
    assert 'one of alpha and beta on cmd_vel leads' in heard.message


def test_one_who_sends_on_both_topics_moves_the_hand_smoothly(graph):
    heard = Heard(graph)
    one = Stick(graph, 'alpha', PITCH)
    same = Stick(graph, 'alpha', PITCH, 'cmd_vel_unstamped', node=one.node)
    heard.run(0.2, one.send)
    np.testing.assert_allclose(heard.run(0.6, one.send, same.send), PITCH)


def test_an_operator_that_starts_again_is_followed(graph):
    heard = Heard(graph)
    one = Stick(graph, 'alpha', PITCH)
    heard.run(0.6, one.send)
    one.node.destroy_publisher(one.publisher)
    graph.spin(0.4)
    again = Stick(graph, 'alpha', -PITCH, node=one.node)
    assert heard.run(0.4, again.send)[-1] == -PITCH


@pytest.mark.parametrize('idle', [False, True])
def test_with_a_third_of_the_messages_lost_the_hand_is_led_without_a_break(graph, idle):
    heard = Heard(graph)
    one = Stick(graph, 'alpha', PITCH)
    if idle:
        Stick(graph, 'beta', -PITCH)
    chance = np.random.default_rng(2)

    def lossy():
        one.send()
        if chance.random() < 0.3:
            one.send()  # at once: the first of the two is never taken

    heard.run(0.3, one.send)
    np.testing.assert_allclose(heard.run(1.5, lossy), PITCH)


def test_an_operator_that_holds_says_nothing_and_leaves_the_lead_to_others(graph):
    heard = Heard(graph)
    graph.start(Operator, maneuver='hold')
    commands = graph.listen(TwistStamped, 'cmd_vel')
    one = Stick(graph, 'alpha', PITCH, 'cmd_vel_unstamped')
    assert heard.run(0.5, one.send)[-1] == PITCH
    assert not commands
