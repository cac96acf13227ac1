"""Say what a wrist says of itself, whenever that changes. Ctrl-C ends it."""

from contextlib import suppress

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.qos import qos_profile_sensor_data

from wrist_interfaces.msg import WristStatus

STATES = [
    'DISABLED',
    'IDLE',
    'TRACKING',
    'SCALED',
    'SINGULAR',
    'LIMITED',
    'STALE',
    'FAULT',
    'WAITING',
]


class Watcher:
    """Prints the state and the sentence of `wrist_status`."""

    def __init__(self) -> None:
        self.said = ''

    def hear(self, status: WristStatus) -> None:
        """Print a status that is another than before."""
        says = f'{STATES[status.state]}: {status.message}'
        if says != self.said:
            print(says, flush=True)
        self.said = says


rclpy.init()
node = rclpy.create_node('watch_wrist')
node.create_subscription(WristStatus, 'wrist_status', Watcher().hear, qos_profile_sensor_data)
with suppress(KeyboardInterrupt, ExternalShutdownException):
    rclpy.spin(node)
