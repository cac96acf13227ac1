"""No joint is told another rate than it can reach in a step: measured by who listens."""

import itertools

import numpy as np
import pytest
from geometry_msgs.msg import Twist
from sensor_msgs.msg import JointState
from std_msgs.msg import Empty
from std_srvs.srv import SetBool, Trigger

from wrist_control import WRISTS, make_wrist
from wrist_control.nodes.resolver import Resolver
from wrist_control.testing.eased import longest_change
from wrist_interfaces.msg import WristStatus

RATE = 100.0
FASTEST = {'revolute': np.radians(32.0), 'prismatic': 0.05}
SPEEDS = {3: (0.3, -0.2, 0.25), 6: (0.02, -0.01, 0.03, 0.1, -0.15, 0.1)}
# What is left of a rate in positions of a message, that are of double precision: rad/s.
TOLERANCE = 1e-6


class Driven:
    """A resolver as it is when nothing is set, on a clock that is ticked."""

    def __init__(self, graph, name):
        self.graph, self.clock = graph, graph.lockstep(1.0 / RATE)
        self.node = f'{name}_resolver'
        fastest = [FASTEST[joint.kind] for joint in make_wrist(name).joints]
        self.wrist = make_wrist(name).with_limits(
            rates=fastest,
            accelerations=[4.0 * rate for rate in fastest],
            decelerations=[10.0 * rate for rate in fastest],
        )
        graph.start(Resolver, name, use_sim_time=True, command_timeout=0.25)
        self.clock.listen({'wrist_status': WristStatus})
        self.told = graph.listen(JointState, 'joint_command')
        self.commands = graph.publisher(Twist, 'cmd_vel_unstamped')
        self.stop = graph.publisher(Empty, 'stop')
        self.clock.begin()

    def command(self, factor):
        values = [factor * x for x in SPEEDS[self.wrist.twist_size]]
        linear, angular = ([0.0] * 3 + values)[-6:-3], values[-3:]
        twist = Twist()
        twist.linear.x, twist.linear.y, twist.linear.z = linear
        twist.angular.x, twist.angular.y, twist.angular.z = angular
        self.commands.publish(twist)
        self.graph.spin(0.05)

    def ticks(self, count):
        for _ in range(count):
            self.clock.tick()


@pytest.mark.parametrize('name', WRISTS)
def test_a_start_a_turn_a_silence_a_stop_and_a_reset_are_gentle_for_every_wrist(graph, name):
    driven = Driven(graph, name)
    driven.command(1.0)
    driven.ticks(24)
    driven.command(-1.0)
    driven.ticks(24)
    driven.command(0.5)
    driven.ticks(55)  # silent for longer than command_timeout
    driven.command(1.0)
    driven.ticks(15)
    driven.stop.publish(Empty())
    graph.spin(0.05)
    driven.ticks(25)
    assert driven.clock.heard['wrist_status'][-1].state == WristStatus.DISABLED
    told = driven.told
    assert not any(told[-1].velocity)
    assert graph.call(SetBool, f'{driven.node}/enable', SetBool.Request(data=True)).success
    assert graph.call(Trigger, f'{driven.node}/reset', Trigger.Request()).success
    driven.ticks(120)
    assert list(told[-1].position) == pytest.approx(list(driven.wrist.home), abs=1e-9)

    rates = np.diff([one.position for one in told], axis=0) * RATE
    assert np.abs(rates).max() > 0.1 * FASTEST[driven.wrist.joints[0].kind]
    for old, new in itertools.pairwise(rates):
        time = longest_change(driven.wrist.joints, tuple(old), tuple(new))
        assert time <= 1.0 / RATE * (1.0 + 1e-4) + TOLERANCE
    np.testing.assert_allclose(rates, [one.velocity for one in told][1:], atol=TOLERANCE)


def test_what_a_joint_may_is_told_in_wrist_status(graph):
    driven = Driven(graph, 'three_gimbal')
    driven.command(1.0)
    driven.ticks(3)
    status = driven.clock.heard['wrist_status'][-1]
    assert status.state == WristStatus.SCALED
    limit = next(one for one in status.limits if one.kind == one.ACCELERATION)
    assert limit.allowed == pytest.approx(np.copysign(4.0 * np.radians(32.0), limit.asked))
    assert 'Changing speed as quickly as' in status.message
