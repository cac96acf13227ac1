"""A wrist that is flown over its physics, by topic only, under a clock that ticks in lockstep."""

import numpy as np
from geometry_msgs.msg import PoseStamped, TwistStamped
from sensor_msgs.msg import JointState

from wrist_control.nodes.operator import Operator
from wrist_control.nodes.physics_simulator import PhysicsSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_control.ros import convert
from wrist_interfaces.msg import WristStatus

RATE = 32.0
SILENCE = 0.5  # after it another operator may lead, s
COMMON = {'use_sim_time': True, 'rate': RATE}
OF_PHYSICS = {'joint_states': JointState, 'true_hand_pose': PoseStamped}
OF_RESOLVER = {'wrist_status': WristStatus, 'hand_pose': PoseStamped}


class PhysicsFlown:
    """The physics of a wrist, its resolver and an operator, and what they say at each tick."""

    def __init__(self, graph, wrist, **physics):
        self.graph, self.wrist = graph, wrist
        self.clock = graph.lockstep(1.0 / RATE)
        self.heard = self.clock.heard
        self.physics = graph.start(PhysicsSimulator, **COMMON, wrist=wrist, **physics)
        self.clock.listen(OF_PHYSICS)
        self.clock.begin()

    def resolve(self, **resolver):
        """Start the resolver, and wait until it has taken over the joints."""
        self.commands = self.graph.listen(JointState, 'joint_command')
        self.graph.start(Resolver, self.wrist, **COMMON, require_joint_states=True, **resolver)
        self.clock.listen(OF_RESOLVER)
        self.clock.begin()
        self.until(lambda: self.status.state == WristStatus.IDLE, 200)

    def start(self, maneuver):
        """Start an operator, and wait until it is followed."""
        operator = self.graph.start(Operator, **COMMON, maneuver=maneuver, listeners=2.0)
        self.clock.listen({'cmd_vel': TwistStamped})
        self.clock.begin()
        self.until(lambda: any(self.commanded))
        return operator

    def stop(self, operator):
        """End an operator, and wait until another one may lead."""
        del self.heard['cmd_vel']
        self.graph.end(operator)
        self.pass_time(SILENCE)

    def fly(self, maneuver, ticks):
        """Fly a maneuver to its end, or for so many ticks."""
        operator = self.start(maneuver)
        self.until(lambda: not any(self.commanded), ticks, strict=False)
        self.stop(operator)

    def pass_time(self, seconds):
        for _ in range(round(seconds * RATE)):
            self.clock.tick()

    def until(self, condition, ticks=50, strict=True):
        """Tick until something is true; or, where that is not necessary, for so many ticks."""
        for _ in range(ticks):
            if condition():
                return
            self.clock.tick()
        assert not strict, f'not within {ticks} ticks; {self.status.message}'

    @property
    def status(self):
        return self.heard['wrist_status'][-1]

    @property
    def commanded(self):
        return convert.twist_values(self.status.commanded)

    def errors(self):
        """Return how far the hand is from where it was told to be: stamp, rad, m, margin.

        What is told at a tick is where to be at the next.
        """
        really = by_stamp(self.heard['true_hand_pose'])
        margins = {
            key: status.margin for key, status in by_stamp(self.heard['wrist_status']).items()
        }
        told = by_stamp(self.heard['hand_pose'])
        return np.array(
            [
                (late, *between(told[soon].pose, really[late].pose), margins[soon])
                for soon, late in zip(sorted(told), sorted(told)[1:], strict=False)
            ]
        )


def by_stamp(messages):
    """Return messages by their stamps, s."""
    return {convert.seconds(message.header.stamp): message for message in messages}


def between(one, other):
    """Return the angle, rad, and the distance, m, between two poses of ROS."""
    a, b = (
        np.array([pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w])
        for pose in (one, other)
    )
    apart = [
        getattr(one.position, axis) - getattr(other.position, axis) for axis in ('x', 'y', 'z')
    ]
    # Twice the angle between quaternions, by its sine: its cosine could not tell small ones.
    half = np.linalg.norm(a - b if a @ b > 0.0 else a + b) / 2.0
    return 4.0 * np.arcsin(half), float(np.linalg.norm(apart))
