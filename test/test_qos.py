"""Quality of service as docs/interfaces.md says: who is heard, and what is left of a burst."""

import math
import time

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState, Joy

from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.physics_simulator import PhysicsSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.rotary_stewart_forward_kinematics import (
    RotaryStewartForwardKinematics,
)
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_interfaces.msg import WristStatus

NODES = (
    (Resolver, 'three_gimbal'),
    (Operator,),
    (JointSimulator,),
    (PhysicsSimulator,),
    (StewartForwardKinematics,),
    (RotaryStewartForwardKinematics,),
)
OUR_TOPICS = {
    '/cmd_vel',
    '/joint_command',
    '/joint_velocity_command',
    '/joint_states',
    '/true_hand_pose',
    '/hand_pose',
    '/wrist_status',
    '/markers',
    '/platform_pose',
    '/platform_twist',
    '/forward_kinematics_status',
    '/diagnostics',
}


def test_every_publisher_is_reliable_and_every_subscriber_hears_both_kinds(graph):
    for kind, *arguments in NODES:
        graph.start(kind, *arguments)
    outside = graph.outside
    graph.until(lambda: all(outside.count_publishers(topic) for topic in OUR_TOPICS))
    for topic in OUR_TOPICS:
        for one in outside.get_publishers_info_by_topic(topic):
            assert one.qos_profile.reliability == ReliabilityPolicy.RELIABLE, topic
        for one in outside.get_subscriptions_info_by_topic(topic):
            assert one.qos_profile.reliability == ReliabilityPolicy.BEST_EFFORT, topic


def refused_of_a_burst(graph, message, topic):
    """Return how many of five bad messages, sent while the node is busy, it has looked at."""
    heard = graph.listen(DiagnosticArray, '/diagnostics')
    publisher = graph.publisher(type(message), topic)
    for _ in range(5):
        publisher.publish(message)
    time.sleep(0.5)  # the executor does not spin: the node is busy
    said = 'messages refused so far'

    def counts():
        messages = [s.message for array in heard for s in array.status if said in s.message]
        return [int(message.split()[0]) for message in messages]

    graph.until(lambda: len([count for count in counts() if count]) > 1)
    return counts()[-1]


def test_of_a_burst_of_commands_only_the_newest_is_looked_at(graph):
    graph.start(Resolver, 'three_gimbal')
    bad = Twist()
    bad.angular.x = math.nan
    assert refused_of_a_burst(graph, bad, 'cmd_vel_unstamped') == 1


def test_of_a_burst_of_positions_the_joint_simulator_looks_at_each(graph):
    graph.start(JointSimulator, joints=['psi', 'theta'])
    bad = JointState(name=['psi', 'theta'], position=[math.nan, 0.0])
    assert refused_of_a_burst(graph, bad, 'joint_command') == 5


@pytest.mark.parametrize(
    'reliability', [ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT]
)
def test_commands_of_both_kinds_of_publisher_are_followed(graph, reliability):
    graph.start(Resolver, 'three_gimbal')
    statuses = graph.listen(WristStatus, 'wrist_status')
    publisher = graph.outside.create_publisher(
        Twist, 'cmd_vel_unstamped', QoSProfile(depth=1, reliability=reliability)
    )
    twist = Twist()
    twist.angular.x = 0.1

    def followed():
        publisher.publish(twist)
        return statuses and statuses[-1].state == WristStatus.TRACKING

    graph.until(followed, limit=5.0)


def test_a_joystick_that_is_published_best_effort_is_heard(graph):
    graph.start(Operator, maneuver='joystick', enable_button=-1, joy_axes=[0, 1, 2])
    commands = graph.listen(TwistStamped, 'cmd_vel')
    publisher = graph.outside.create_publisher(
        Joy, 'joy', QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    )

    graph.until(lambda: publisher.get_subscription_count())
    publisher.publish(Joy(axes=[0.0, 0.0, 0.0]))
    graph.spin(0.2)

    def asked():
        publisher.publish(Joy(axes=[1.0, 1.0, 1.0]))
        return commands and commands[-1].twist.angular.x

    graph.until(asked, limit=5.0)
