"""What one resolver step costs, beside publishing one message: both measured in this run."""

import statistics
import time

import rclpy
from rich.console import Console
from rich.table import Table
from sensor_msgs.msg import JointState

from wrist_control import WRISTS, make_wrist
from wrist_control.resolving import start, step

REPEATS = 9
CALLS = 400
GOAL = 40.0  # µs, a step of the three-gimbal wrist in plain Python


def microseconds(call):
    """Return the processor time of one call, µs: the median of several runs."""
    runs = []
    for _ in range(REPEATS):
        began = time.process_time()
        for _ in range(CALLS):
            call()
        runs.append((time.process_time() - began) / CALLS * 1e6)
    return statistics.median(runs)


def publishing():
    """Return the cost of publishing one JointState of three joints, nobody listening."""
    rclpy.init()
    node = rclpy.create_node('bench')
    publisher = node.create_publisher(JointState, 'joint_command', 10)
    message = JointState(name=['psi', 'theta', 'phi'], position=[0.1, 0.2, 0.3])
    cost = microseconds(lambda: publisher.publish(message))
    node.destroy_node()
    rclpy.shutdown()
    return cost


def main():
    """Print the table."""
    message = publishing()
    table = Table(title=f'One resolver step; publishing one JointState takes {message:.1f} µs')
    headings = ['wrist']
    for what in ('following', 'scaled', 'gathering speed'):
        headings += [what, '÷ publishing']
    for heading in headings:
        table.add_column(heading, justify='right')
    for name in WRISTS:
        wrist = make_wrist(name)
        slow = wrist.with_limits(rates=0.05 if wrist.twist_size == 3 else 0.005)
        size = (0.0,) * (wrist.twist_size - 3)
        state, twist = start(wrist), (*size, 0.02, 0.1, 0.05)
        # Two steps on, the wrist is nowhere special.
        state = step(wrist, state, twist, 0.01).state
        free = microseconds(lambda: step(wrist, state, twist, 0.01))  # noqa: B023
        scaled = microseconds(lambda: step(slow, state, twist, 0.01))  # noqa: B023
        rest = state._replace(joint_rates=())
        sluggish = wrist.with_limits(accelerations=1.0, decelerations=1.0)
        gathering = microseconds(lambda: step(sluggish, rest, twist, 0.01))  # noqa: B023
        cells = [name]
        for cost in (free, scaled, gathering):
            cells += [f'{cost:.1f} µs', f'{cost / message:.2f}']
        table.add_row(*cells)
    console = Console()
    console.print(table)
    console.print(f'Goal: at most {GOAL:g} µs for a step.')


if __name__ == '__main__':
    main()
