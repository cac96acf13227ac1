"""Nguyen's platform on a clock that a test ticks, by topic only."""

from geometry_msgs.msg import PoseStamped, TwistStamped
from sensor_msgs.msg import JointState

from wrist_control import make_wrist
from wrist_control.nodes.resolver import Resolver
from wrist_control.rotations import Pose, from_xyzw
from wrist_interfaces.msg import WristStatus

WRIST = make_wrist('stewart')
LEGS = [joint.name for joint in WRIST.joints]
HOME = list(WRIST.home)
RATE = 50.0


class Flown:
    """A resolver on a clock that the test ticks, and everything that it says."""

    def __init__(self, graph, **parameters):
        self.graph = graph
        self.clock = graph.lockstep(1.0 / RATE)
        common = {'use_sim_time': True, 'rate': RATE, 'command_timeout': 10.0, 'free_joints': True}
        self.node = graph.start(Resolver, 'stewart', **{**common, **parameters})
        self.clock.listen({'wrist_status': WristStatus, 'hand_pose': PoseStamped})
        self.clock.listen({'joint_command': JointState})
        self.publisher = graph.publisher(TwistStamped, 'cmd_vel')

    def command(self, twist, frame=''):
        """Command a twist (vx, vy, vz, p, q, r) from the next tick on."""
        message = TwistStamped()
        message.header.frame_id = frame
        message.header.stamp = self.clock.heard['wrist_status'][-1].header.stamp
        linear, angular = message.twist.linear, message.twist.angular
        linear.x, linear.y, linear.z, angular.x, angular.y, angular.z = map(float, twist)
        self.publisher.publish(message)
        self.graph.spin(0.05)

    def ticks(self, count):
        for _ in range(count):
            self.clock.tick()

    @property
    def status(self):
        return self.clock.heard['wrist_status'][-1]

    @property
    def pose(self):
        return pose_of(self.clock.heard['hand_pose'][-1].pose)


def pose_of(pose):
    turn, where = pose.orientation, pose.position
    orientation = from_xyzw((turn.x, turn.y, turn.z, turn.w))
    return Pose(orientation, (where.x, where.y, where.z))


def values(twist):
    linear, angular = twist.linear, twist.angular
    return [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
