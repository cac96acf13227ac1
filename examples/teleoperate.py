"""Your own node as the operator: it turns the hand, hears what the wrist says, and lets go.

Resolver and joints run as processes of their own, as they would beside a robot.
"""

import math
from contextlib import suppress

import rclpy
from geometry_msgs.msg import PoseStamped, Twist
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions

from wrist_control.graph.processes import NodeProcesses, config_file
from wrist_interfaces.msg import WristStatus

RATE = 1.0  # rad/s, more than the joints may turn: the hand goes slower, as it was told to
BEND = 0.7  # rad, where the operator lets go


class Teleoperator(Node):
    """Bends the hand down, and lets go of the stick."""

    def __init__(self, namespace):
        super().__init__('teleoperator', namespace=namespace)
        self.bent, self.fastest = 0.0, 0.0
        self.status = WristStatus(state=WristStatus.WAITING)
        self.stick = self.create_publisher(Twist, 'cmd_vel_unstamped', 10)
        self.create_subscription(WristStatus, 'wrist_status', self.hear, qos_profile_sensor_data)
        self.create_subscription(PoseStamped, 'hand_pose', self.see, qos_profile_sensor_data)
        self.create_timer(0.02, self.send)

    def send(self):
        """Say 50 times a second where the stick is: a hand that hears nothing stops."""
        command = Twist()
        if self.status.state != WristStatus.WAITING and self.bent < BEND:
            command.angular.y = RATE
        self.stick.publish(command)

    def hear(self, status):
        """Pass on what the wrist says, and note how fast the hand really turns."""
        if status.message != self.status.message:
            print(status.message)
        self.fastest = max(self.fastest, status.achieved.angular.y)
        self.status = status

    def see(self, hand):
        """Note how far the hand is bent."""
        self.bent = 2.0 * math.atan2(hand.pose.orientation.y, hand.pose.orientation.w)


rclpy.init(signal_handler_options=SignalHandlerOptions.NO)  # Ctrl-C ends the block below, in order
with NodeProcesses('teleoperate', [config_file('three_gimbal.yaml')]) as processes:
    me = Teleoperator(processes.namespace)
    with suppress(KeyboardInterrupt):
        processes.start('three_gimbal_resolver', {})
        processes.start('joint_simulator', {})
        while me.bent < BEND or me.status.state != WristStatus.IDLE:
            processes.check()
            rclpy.spin_once(me, timeout_sec=0.1)
print(f'bent by {math.degrees(me.bent):.1f} deg')
print(f'fastest: {math.degrees(me.fastest):.1f} deg/s')
me.destroy_node()
rclpy.shutdown()
