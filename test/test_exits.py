"""How a node ends while it moves the hand: a ramp, a zero, silence; who outlives it hears it."""

import itertools
import os
import random
import signal
import subprocess
import time
from typing import ClassVar

import pytest
from geometry_msgs.msg import Twist
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from .broken_middleware import broken
from .test_processes import EXECUTABLES

RATE = 0.5
RAMP = 0.3
NEVER_SAID = ('Traceback', 'FATAL', 'ERROR', 'terminate')


@pytest.fixture(autouse=True)
def nothing_stays():
    """End the processes of a test that has failed before it could end them."""
    yield
    while Moving.processes:
        Moving.processes.pop().kill()


class Moving:
    """A resolver in a process of its own that turns the hand, and what it sends to the joints."""

    processes: ClassVar[list[subprocess.Popen]] = []

    def __init__(self, graph, command, **parameters):
        self.graph = graph
        self.velocities = []
        self.positions = graph.listen(JointState, 'joint_command')
        best_effort = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)
        graph.outside.create_subscription(
            Float64MultiArray, 'joint_velocity_command', self._hear, best_effort
        )
        given = {'stop_time': RAMP, 'require_joint_states': False, **parameters}
        self.process = subprocess.Popen(
            [*command, '--ros-args']
            + [part for name, value in given.items() for part in ('-p', f'{name}:={value}')],
            env={**os.environ, 'ROS_DOMAIN_ID': str(graph.domain)},
            stderr=subprocess.PIPE,
            text=True,
        )
        self.processes.append(self.process)
        self._commands = graph.publisher(Twist, 'cmd_vel_unstamped')
        twist = Twist()
        twist.angular.x = RATE
        self._command = lambda: self._commands.publish(twist)

    def _hear(self, message):
        self.velocities.append(round(message.data[2], 9))

    def until_fast(self):
        self.graph.until(self._is_fast)

    def _is_fast(self):
        self._command()
        return self.velocities and self.velocities[-1] == RATE

    def until_ended(self):
        """Go on commanding until the process is gone; return what it said."""

        def ended():
            self._command()
            return self.process.poll() is not None

        self.graph.until(ended)
        self.graph.spin(0.2)
        return self.process.communicate(timeout=10.0)[1]

    def ramp(self):
        """Return what was sent from the last full velocity on."""
        after = self.velocities[::-1].index(RATE)
        return self.velocities[len(self.velocities) - after - 1 :]


def assert_ramped(ramp):
    """Down without a jump, zero at the end, and no zero but there."""
    assert ramp[-1] == 0.0
    assert all(later <= sooner for sooner, later in itertools.pairwise(ramp))
    assert max(a - b for a, b in itertools.pairwise(ramp)) <= 3.0 * RATE / (RAMP * 100.0)
    assert len([value for value in ramp if 0.0 < value < RATE]) > 0.8 * RAMP * 100.0


RESOLVER = [str(EXECUTABLES / 'three_gimbal_resolver')]


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ramps_a_moving_hand_to_a_zero_and_then_nothing_is_said(graph, number):
    moving = Moving(graph, RESOLVER)
    moving.until_fast()
    moving.process.send_signal(number)
    began = time.monotonic()
    said = moving.until_ended()
    assert moving.process.returncode == 0, said
    assert not any(word in said for word in NEVER_SAID), said
    assert time.monotonic() - began < RAMP + 1.2
    assert_ramped(moving.ramp())
    assert list(moving.positions[-1].velocity) == [0.0, 0.0, 0.0]
    heard = len(moving.velocities)
    graph.spin(0.3)
    assert len(moving.velocities) == heard


def test_a_hand_at_rest_does_not_make_a_signal_wait(graph):
    moving = Moving(graph, RESOLVER, stop_time=10.0)
    graph.until(lambda: moving.velocities)
    moving.process.send_signal(signal.SIGTERM)
    began = time.monotonic()
    moving.process.wait(10.0)
    assert time.monotonic() - began < 1.5


BROKEN = broken(6.0, "from wrist_control.nodes import resolver\nresolver.main('three_gimbal')")


def test_an_error_of_the_middleware_itself_ramps_a_moving_hand_to_a_zero(graph):
    moving = Moving(graph, ['python3', '-c', BROKEN])
    moving.until_fast()
    said = moving.until_ended()
    assert moving.process.returncode == 1, said
    assert 'the middleware is broken' in said
    assert_ramped(moving.ramp())


@pytest.mark.parametrize('clock', ['false', 'true'])
@pytest.mark.parametrize(
    'executable',
    [
        'operator',
        'stewart_resolver',
        'joint_simulator',
        'physics_simulator',
        'stewart_forward_kinematics',
        'rotary_stewart_forward_kinematics',
    ],
)
def test_every_node_ends_well_whenever_it_is_stopped(process_environment, executable, clock):
    for _ in range(4):
        process = subprocess.Popen(
            [str(EXECUTABLES / executable), '--ros-args', '-p', f'use_sim_time:={clock}'],
            env=process_environment,
            stderr=subprocess.PIPE,
            text=True,
        )
        delay = random.uniform(0.7, 2.5)  # while it imports, and while it runs
        time.sleep(delay)
        process.send_signal(random.choice([signal.SIGINT, signal.SIGTERM]))
        began = time.monotonic()
        _, said = process.communicate(timeout=10.0)
        assert process.returncode == 0, (delay, said)
        assert not any(word in said for word in NEVER_SAID), (delay, said)
        assert time.monotonic() - began < 1.5
