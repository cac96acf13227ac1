"""A wrist that is flown over its physics, by topic only."""

from geometry_msgs.msg import PoseStamped, TwistStamped
from sensor_msgs.msg import JointState

from wrist_control.nodes.operator import Operator
from wrist_control.nodes.physics_simulator import PhysicsSimulator
from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus

RATE = 50.0
HEARD = {
    'wrist_status': WristStatus,
    'joint_command': JointState,
    'joint_states': JointState,
    'hand_pose': PoseStamped,
    'true_hand_pose': PoseStamped,
}


class PhysicsFlown:
    """Resolver and physics under one clock, and what they say at each tick."""

    def __init__(self, graph, wrist, resolver=None, **physics):
        self.graph, self.clock = graph, graph.lockstep(1.0 / RATE)
        self._common = {'use_sim_time': True, 'rate': RATE}
        self.physics = graph.start(PhysicsSimulator, **self._common, wrist=wrist, **physics)
        self.clock.listen({name: HEARD[name] for name in ('joint_states', 'true_hand_pose')})
        self.clock.begin()
        self._wrist, self._resolver = wrist, resolver or {}

    def start_resolver(self):
        settings = {'require_joint_states': True, **self._resolver}
        self.graph.start(Resolver, self._wrist, **self._common, **settings)
        names = ('wrist_status', 'joint_command', 'hand_pose')
        self.clock.listen({name: HEARD[name] for name in names[:1]})
        for name in names[1:]:
            self.clock.heard[name] = self.graph.listen(HEARD[name], name)

    def fly(self, maneuver):
        self.graph.start(Operator, **self._common, maneuver=maneuver, listeners=2.0)
        self.clock.listen({'cmd_vel': TwistStamped})
        self.clock.begin()
