"""Record the joints of live nodes into a table, out/recording.csv, and read what the hand did.

Whoever recorded `joint_states` of a wrist can read them as below, without ROS.
"""

import csv
import math
from pathlib import Path

import numpy as np
import rclpy
from geometry_msgs.msg import TwistStamped
from rclpy.signals import SignalHandlerOptions
from sensor_msgs.msg import JointState

from wrist_control import make_wrist
from wrist_control.graph.lockstep import Lockstep
from wrist_control.graph.processes import NodeProcesses, config_file
from wrist_control.ros.convert import seconds
from wrist_interfaces.msg import WristStatus

TABLE = Path('out/recording.csv')
CONFIGS = [config_file(name) for name in ('three_gimbal.yaml', 'demo.yaml')]
WRIST = make_wrist('three_gimbal')
JOINTS = [joint.name for joint in WRIST.joints]


def record():
    """Fly the basic test maneuver through processes, and return every joint state."""
    with NodeProcesses('record', CONFIGS) as processes:
        node = rclpy.create_node('recorder', namespace=processes.namespace)
        # A simulated clock that waits for every node: each run gives the same numbers.
        clock = Lockstep(node, 1.0 / 32.0, alive=processes.check)
        processes.start('three_gimbal_resolver', {})
        processes.start('joint_simulator', {})
        clock.listen({'joint_states': JointState, 'wrist_status': WristStatus})
        clock.begin()
        processes.start('operator', {})
        clock.listen({'cmd_vel': TwistStamped})
        clock.begin()
        moved = False
        while not moved or clock.heard['wrist_status'][-1].state != WristStatus.IDLE:
            clock.tick()
            moved = moved or clock.heard['wrist_status'][-1].state == WristStatus.TRACKING
        node.destroy_node()
    return clock.heard['joint_states']


rclpy.init(signal_handler_options=SignalHandlerOptions.NO)  # Ctrl-C ends the processes in order
states = record()
rclpy.shutdown()
TABLE.parent.mkdir(exist_ok=True)
with TABLE.open('w', newline='') as file:
    table = csv.writer(file)
    table.writerow(['time', *JOINTS])
    for state in states:
        where = dict(zip(state.name, state.position, strict=True))
        table.writerow([seconds(state.header.stamp), *(where[name] for name in JOINTS)])

# From here on it is a table of numbers, whoever recorded it.
recording = np.genfromtxt(TABLE, delimiter=',', names=True)
positions = np.column_stack([recording[name] for name in JOINTS])
rates = np.diff(positions, axis=0) / np.diff(recording['time'])[:, None]
margins = [WRIST.margin(row) for row in positions]
x, y, z = WRIST.forward(positions[-1]).rotation[0]

print(f'{TABLE}: {len(recording)} rows')
print(f'fastest joint: {math.degrees(np.abs(rates).max()):.1f} deg/s')
print(f'closest to lock: margin {min(margins):.4f}')
print(f'the hand ends with its x axis along ({x:.3f}, {y:.3f}, {z:.3f})')
