"""A clock that jumps, stops or is late: the hand stops, is told why, and never seems too fast."""

import itertools
import time

import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Twist
from rcl_interfaces.srv import SetParameters
from rclpy.clock import ClockType
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray

from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.physics_simulator import PhysicsSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_interfaces.msg import WristStatus

NODE = 'three_gimbal_resolver'
RATE = 0.5
PERIOD = 0.01


class Simulated:
    """A resolver that turns the hand by a simulated clock, which is in the test's hands."""

    def __init__(self, graph):
        self.graph = graph
        self.now = 1000.0
        graph.start(Resolver, 'three_gimbal', use_sim_time=True)
        self.statuses = graph.listen(WristStatus, 'wrist_status')
        self.velocities = graph.listen(Float64MultiArray, 'joint_velocity_command')
        self.diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
        self._clock = graph.publisher(Clock, 'clock')
        self._commands = graph.publisher(Twist, 'cmd_vel_unstamped')
        graph.until(lambda: self.run() or self.speed() == RATE)

    def run(self, command=RATE):
        """Let one period pass on the simulated and on the real clock."""
        self.now += PERIOD
        nanoseconds = round(1e9 * self.now)
        self._clock.publish(
            Clock(clock=Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9))
        )
        if command is not None:
            self.command(command)
        self.graph.spin(PERIOD)

    def command(self, rate):
        twist = Twist()
        twist.angular.x = rate
        self._commands.publish(twist)

    def speed(self):
        return round(self.velocities[-1].data[2], 9) if self.velocities else None

    def ramp(self):
        speeds = [round(message.data[2], 9) for message in self.velocities]
        return speeds[len(speeds) - speeds[::-1].index(RATE) - 1 :]

    def warnings(self):
        return [
            value.value
            for array in self.diagnostics[-1:]
            for status in array.status
            if status.level == DiagnosticStatus.WARN
            for value in status.values
            if value.key == 'clock'
        ]


@pytest.fixture
def simulated(graph):
    return Simulated(graph)


def assert_ramped(ramp):
    assert ramp[-1] == 0.0
    assert all(b <= a for a, b in itertools.pairwise(ramp))
    assert len([speed for speed in ramp if 0.0 < speed < RATE]) >= 7


@pytest.mark.parametrize(('jump', 'said'), [(-500.0, 'jumped back by'), (500.0, 'jumped ahead')])
def test_a_clock_that_jumps_ramps_the_hand_to_a_stop_and_is_named(graph, simulated, jump, said):
    simulated.now += jump
    for _ in range(20):
        simulated.run(None)
    assert_ramped(simulated.ramp())
    assert any(said in status.message for status in simulated.statuses)
    graph.until(lambda: simulated.run(None) or simulated.warnings())
    assert said in simulated.warnings()[-1]
    graph.until(lambda: simulated.run() or simulated.speed() == RATE)


def test_after_a_jump_back_a_command_still_runs_out(graph, simulated):
    simulated.now -= 500.0
    graph.until(lambda: simulated.run(None) or simulated.speed() == 0.0)
    graph.until(lambda: simulated.run() or simulated.speed() == RATE)
    for _ in range(45):
        simulated.run(None)
    assert_ramped(simulated.ramp())


def test_a_clock_that_stops_ramps_the_hand_to_a_zero_and_then_silence(graph, simulated):
    began = time.monotonic()
    graph.until(lambda: simulated.speed() == 0.0)
    assert 0.2 < time.monotonic() - began < 1.0
    assert_ramped(simulated.ramp())
    assert 'The clock has stood still for' in simulated.statuses[-1].message
    stamps = [status.header.stamp for status in simulated.statuses]
    seconds = [stamp.sec + 1e-9 * stamp.nanosec for stamp in stamps]
    assert min(b - a for a, b in itertools.pairwise(seconds)) > 0.89 * PERIOD
    count = len(simulated.velocities)
    graph.until(simulated.warnings)
    assert len(simulated.velocities) == count


def test_what_is_commanded_while_the_clock_stands_does_not_count_when_it_goes_on(graph, simulated):
    graph.until(lambda: simulated.speed() == 0.0)
    for _ in range(20):
        simulated.command(RATE)
        graph.spin(0.02)
    graph.spin(0.1)
    for _ in range(20):
        simulated.run(None)
    assert simulated.speed() == 0.0
    graph.until(lambda: simulated.run() or simulated.speed() == RATE)


@pytest.mark.parametrize('simulated_time', [True, False])
def test_use_sim_time_does_not_change_while_a_node_runs(graph, simulated_time):
    node = graph.start(Resolver, 'three_gimbal', use_sim_time=simulated_time)
    wanted = Parameter('use_sim_time', value=not simulated_time)
    request = SetParameters.Request(parameters=[wanted.to_parameter_msg()])
    (result,) = graph.call(SetParameters, f'{NODE}/set_parameters', request).results
    assert not result.successful
    assert result.reason.startswith('use_sim_time cannot change while a node runs')
    assert node.get_clock().ros_time_is_active is simulated_time


@pytest.mark.parametrize(
    ('kind', 'arguments'),
    [
        (Resolver, ['three_gimbal']),
        (Operator, []),
        (JointSimulator, []),
        (PhysicsSimulator, []),
        (StewartForwardKinematics, []),
    ],
)
def test_no_timer_runs_on_a_clock_that_can_be_set(graph, kind, arguments):
    node = graph.start(kind, *arguments)
    timers = list(node.timers)
    assert len(timers) >= 2
    assert {timer.clock.clock_type for timer in timers} == {ClockType.STEADY_TIME}


def test_after_a_late_step_none_is_stamped_sooner_than_a_period(graph):
    graph.start(Resolver, 'three_gimbal')
    commands = graph.listen(JointState, 'joint_command')
    diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
    graph.until(lambda: len(commands) > 20)
    for pause in range(20):
        time.sleep(0.0305 + 0.001 * pause)
        graph.spin(0.05)
    stamps = [c.header.stamp.sec * 10**9 + c.header.stamp.nanosec for c in commands]
    gaps = [1e-9 * (b - a) for a, b in itertools.pairwise(stamps)]
    assert max(gaps) > 0.03
    assert min(gaps) >= 0.9 * PERIOD

    def missed():
        values = [v for a in diagnostics[-1:] for s in a.status for v in s.values]
        return next(int(value.value) for value in values if value.key == 'missed steps') > 20

    graph.until(missed)
