"""A forward-kinematics node that is sent leg readings, and all that it says."""

import numpy as np
import pytest
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseWithCovarianceStamped, TwistStamped
from sensor_msgs.msg import JointState

from wrist_control import make_wrist
from wrist_control.nodes.stewart_forward_kinematics import StewartForwardKinematics
from wrist_interfaces.msg import ForwardKinematicsStatus

WRIST = make_wrist('stewart')
LEGS = [f'leg_{leg}' for leg in range(1, 7)]
HOME = tuple(WRIST.home)


class Watched:
    """A forward-kinematics node, and everything that it says."""

    kind, names, home = StewartForwardKinematics, LEGS, HOME

    def __init__(self, graph, **parameters):
        self.graph = graph
        self.node = graph.start(self.kind, **parameters)
        self.poses = graph.listen(PoseWithCovarianceStamped, 'platform_pose')
        self.twists = graph.listen(TwistStamped, 'platform_twist')
        self.statuses = graph.listen(ForwardKinematicsStatus, 'forward_kinematics_status')
        self.diagnostics = graph.listen(DiagnosticArray, '/diagnostics')
        self.publisher = graph.publisher(JointState, 'joint_states')
        graph.until(lambda: graph.outside.count_publishers('forward_kinematics_status'))
        self.stamp = 10.0

    def send(self, positions, names=None, velocities=(), after=0.1):
        self.stamp += after
        message = JointState(
            name=list(self.names if names is None else names),
            position=[float(x) for x in positions],
            velocity=[float(x) for x in velocities],
        )
        nanoseconds = round(self.stamp * 1e9)
        message.header.stamp = Time(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)
        self.publisher.publish(message)
        return message

    def status_of(self, *arguments, **named):
        """Send a reading, and return the status that belongs to it."""
        stamp = self.send(*arguments, **named).header.stamp
        self.graph.until(lambda: self.statuses and self.statuses[-1].header.stamp == stamp)
        self.graph.spin(0.05)
        return self.statuses[-1]

    def begin(self):
        self.graph.until(
            lambda: self.status_of(self.home).status == ForwardKinematicsStatus.CONVERGED
        )
        return len(self.poses), len(self.twists)

    def part(self, ending):
        """Wait for the diagnostics, and return the newest of their parts with such a name."""
        self.graph.until(lambda: self.diagnostics)
        return next(
            status for status in self.diagnostics[-1].status if status.name.endswith(ending)
        )

    def values(self, ending):
        return {value.key: value.value for value in self.part(ending).values}

    def refused(self, reason):
        """Wait until something is refused for a reason; return the last such sentence."""
        key = f'refused joint_states: {reason}'
        self.graph.until(lambda: int(self.values(': input').get(key, 0)) > 0)
        return self.values(': state')['last refused']


def assert_same_pose(found, expected, tolerance=1e-12):
    assert found.position == pytest.approx(expected.position, abs=tolerance)
    np.testing.assert_allclose(found.rotation, expected.rotation, atol=tolerance)


def ambiguous():
    """Return lengths that fit several poses, though home leads to one of them."""
    rng = np.random.default_rng(0)
    while True:
        lengths = HOME[0] + rng.choice([-0.1, 0.1], 6)
        if WRIST.forward_kinematics.cold_start(tuple(lengths)).others:
            return lengths
