"""Stop every wrist that listens here: one message on `stop`."""

import rclpy
from rclpy.duration import Duration
from std_msgs.msg import Empty

rclpy.init()
node = rclpy.create_node('stop_wrist')
publisher = node.create_publisher(Empty, 'stop', 1)
while publisher.get_subscription_count() == 0:
    rclpy.spin_once(node, timeout_sec=0.05)
publisher.publish(Empty())
heard = publisher.wait_for_all_acked(Duration(seconds=1.0))
print('stopped' if heard else 'not heard by all')
rclpy.shutdown()
