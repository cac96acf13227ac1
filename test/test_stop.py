"""Stop, from anyone; a dead-man's switch; and what a flood of calls may cost."""

import os
import subprocess
import sys
import time

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rcl_interfaces.srv import ListParameters
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Bool, Empty
from std_srvs.srv import SetBool, Trigger
from type_description_interfaces.srv import GetTypeDescription

from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus

NODE = 'three_gimbal_resolver'
RESOLVER = "from wrist_control.nodes.resolver import main; main('three_gimbal')"
FLOOD = f"""
import rclpy, time
from rcl_interfaces.srv import ListParameters
rclpy.init()
node = rclpy.create_node('flood')
client = node.create_client(ListParameters, '{NODE}/list_parameters')
client.wait_for_service()
print('begun', flush=True)
while True:
    for _ in range(20):
        with client.handle:
            client.handle.send_request(ListParameters.Request())
    time.sleep(0.001)
"""


class Led:
    """A resolver whose hand is led."""

    def __init__(self, graph, start=True, **parameters):
        self.graph = graph
        if start:
            graph.start(Resolver, 'three_gimbal', **parameters)
        self.statuses = graph.listen(WristStatus, 'wrist_status')
        self.publisher = graph.publisher(Twist, 'cmd_vel_unstamped')
        self.deadman = None

    def until(self, condition):
        def led():
            twist = Twist()
            twist.angular.y = 0.3
            self.publisher.publish(twist)
            if self.deadman is not None:
                self.deadman.publish(Bool(data=True))
            return self.statuses and condition(self.statuses[-1])

        self.graph.until(led)


def moves(status):
    return status.state == WristStatus.TRACKING and status.commanded.angular.y == 0.3


def stands(status):
    return status.state == WristStatus.STALE and status.commanded.angular.y == 0.0


def is_disabled(status):
    return status.state == WristStatus.DISABLED


@pytest.mark.parametrize(
    'reliability', [ReliabilityPolicy.BEST_EFFORT, ReliabilityPolicy.RELIABLE]
)
def test_one_message_on_stop_from_anyone_stops_until_it_is_enabled(graph, reliability):
    led = Led(graph)
    stranger = graph.add(rclpy.create_node('stranger', context=graph.context))
    stop = stranger.create_publisher(Empty, 'stop', QoSProfile(depth=1, reliability=reliability))
    listeners = 2 if reliability == ReliabilityPolicy.RELIABLE else 1
    graph.until(lambda: stop.get_subscription_count() >= listeners)
    led.until(moves)
    stop.publish(Empty())
    led.until(is_disabled)
    led.until(lambda status: 'on stop. Call ~/enable' in status.message)
    ended = time.monotonic() + 0.3
    led.until(lambda _: time.monotonic() > ended)
    assert is_disabled(led.statuses[-1])
    assert graph.call(SetBool, f'{NODE}/enable', SetBool.Request(data=True)).success
    led.until(moves)


def test_the_hand_moves_only_while_the_switch_is_pressed(graph):
    led = Led(graph, require_deadman=True)
    led.until(lambda status: status.message.startswith('Held: nothing was heard on deadman'))
    assert not any(status.commanded.angular.y for status in led.statuses)
    led.deadman = graph.publisher(Bool, 'deadman')
    led.until(moves)
    released, led.deadman = led.deadman, None
    released.publish(Bool(data=False))
    led.until(stands)
    assert 'is released; press it' in led.statuses[-1].message
    led.deadman = released
    led.until(moves)
    led.deadman = None
    led.until(stands)
    assert 'deadman has been silent for more than 0.25 s' in led.statuses[-1].message


def test_without_require_deadman_nobody_listens_to_it(graph):
    Led(graph)
    assert graph.outside.count_subscribers('deadman') == 0


def test_every_service_is_answered(graph):
    graph.start(Resolver, 'three_gimbal')
    assert graph.call(Trigger, f'{NODE}/reset', Trigger.Request()).success
    names = graph.call(ListParameters, f'{NODE}/list_parameters', ListParameters.Request())
    assert 'require_deadman' in names.result.names
    request = GetTypeDescription.Request(type_name='std_msgs/msg/Empty')
    assert graph.call(GetTypeDescription, f'{NODE}/get_type_description', request).failure_reason


@pytest.fixture
def program(graph):
    """Start Python programs of their own in the test's domain, and end them."""
    environment = {**os.environ, 'ROS_DOMAIN_ID': str(graph.domain)}
    started = []

    def start(text, *arguments):
        command = [sys.executable, '-c', text, *arguments]
        process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()
        process.wait()
        process.stdout.close()


def test_in_a_flood_of_calls_the_hand_is_led_stopped_and_enabled(graph, program):
    """As a process of its own: it has the executor that people use."""
    program(RESOLVER, '--ros-args', '-p', 'require_joint_states:=false')
    led = Led(graph, start=False)
    stop = graph.publisher(Empty, 'stop', listeners=2)
    flood = program(FLOOD)
    assert flood.stdout.readline() == 'begun\n'
    graph.spin(0.5)
    led.until(moves)
    before, began = len(led.statuses), time.monotonic()
    led.until(lambda _: time.monotonic() > began + 1.0)
    assert len(led.statuses) - before > 50
    stop.publish(Empty())
    began = time.monotonic()
    led.until(is_disabled)
    assert time.monotonic() - began < 1.0
    led.until(lambda status: 'Call ~/enable' in status.message)
    assert graph.call(SetBool, f'{NODE}/enable', SetBool.Request(data=True)).success
    led.until(moves)
