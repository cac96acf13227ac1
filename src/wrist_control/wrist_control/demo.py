"""Fly Barker's basic test maneuver through a real ROS 2 graph, twice, and show the figures.

Operator, resolver and joint simulator run as processes of their own on the real middleware, in a
namespace of their own, on a simulated clock that ticks when all of them have answered: the
numbers are the same in every run, on any machine.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import rclpy
from geometry_msgs.msg import TwistStamped
from rclpy.signals import SignalHandlerOptions
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn
from rich.table import Table
from sensor_msgs.msg import JointState

from wrist_control import Flight, fly, make_maneuver, make_wrist
from wrist_control.errors import WristError
from wrist_control.graph.lockstep import Lockstep
from wrist_control.graph.processes import NodeProcesses, config_file
from wrist_control.graph.recording import in_step, recorded_flight
from wrist_control.operating.maneuvers import BARKER_SPEED
from wrist_control.studies.barker import Line, three_gimbal_table
from wrist_control.studies.flight_figures import draw_flight, draw_tip
from wrist_control.studies.pictures import save
from wrist_interfaces.msg import WristStatus

RATE = 32.0
FILES = ('three_gimbal.yaml', 'demo.yaml')
# How often a flight is repeated when the machine is too busy to fly it exactly.
ATTEMPTS = 3
# Longer than the maneuver can take, s of simulated time.
LONGEST = 60.0


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the demo; the exit code is 0 when both flights were flown."""
    parser = argparse.ArgumentParser(prog='demo', description=__doc__.splitlines()[0])
    parser.add_argument('--out', type=Path, default=Path('out'), help='folder for the pictures')
    parser.add_argument(
        '--speed', type=float, default=2.0, help='times real time; 0 is as fast as it goes'
    )
    chosen = parser.parse_args(arguments)
    console = Console()
    try:
        with Progress(
            TextColumn('{task.description:<34}'),
            BarColumn(),
            TextColumn('{task.fields[saying]:<44}'),
            TimeElapsedColumn(),
            console=console,
        ) as progress:
            unscaled = fly_through_ros(progress, 'without scaling', math.inf, chosen.speed)
            scaled = fly_through_ros(progress, 'scaled to 32 deg/s', BARKER_SPEED, chosen.speed)
    except KeyboardInterrupt:
        console.print('Stopped; nothing is left running.')
        return 130
    except WristError as error:
        console.print(f'The demo could not be flown: {error}', style='red')
        return 1
    rows = [*three_gimbal_table(unscaled, scaled), *against_library(unscaled, scaled)]
    console.print(table(rows))
    for path in draw(unscaled, scaled, chosen.out):
        console.print(f'drawn: {path}')
    return 0


def fly_through_ros(progress: Progress, label: str, limit: float, speed: float) -> Flight:
    """Fly the basic test maneuver through processes of their own.

    Args:
        progress: Where the live line is shown.
        label: What the flight is called there.
        limit: Largest rate of every gimbal, rad/s; inf for none.
        speed: Times real time, 0 for as fast as it goes.

    Raises:
        WristError: A node did not start, or stopped answering.
    """
    task = progress.add_task(label, total=1.0, saying='')
    for _ in range(ATTEMPTS):
        heard = _hear_flight(progress, task, limit, speed)
        if in_step(heard):
            break
        progress.update(task, saying='this machine is busy: once more, slower')
        speed = 0.5 * speed if speed > 0.0 else 1.0
    wrist = make_wrist('three_gimbal').with_limits(rates=limit)
    return recorded_flight(wrist, make_maneuver('basic_test'), 1.0 / RATE, heard)


def _hear_flight(
    progress: Progress, task: TaskID, limit: float, speed: float
) -> dict[str, list[Any]]:
    """Start the nodes, tick them through the maneuver, and return all that they published."""
    progress.update(task, saying='starting three ROS 2 nodes', completed=0.0)
    context = rclpy.Context()
    rclpy.init(context=context, signal_handler_options=SignalHandlerOptions.NO)
    try:
        with NodeProcesses('wrist_demo', [config_file(name) for name in FILES]) as nodes:
            node = rclpy.create_node('demo', namespace=nodes.namespace, context=context)
            clock = Lockstep(node, 1.0 / RATE, alive=nodes.check)
            nodes.start('three_gimbal_resolver', {'joint_rate_limits': limit})
            nodes.start('joint_simulator', {'joint_rate_limits': limit})
            clock.listen(
                {
                    'wrist_status': WristStatus,
                    'joint_command': JointState,
                    'joint_states': JointState,
                }
            )
            clock.begin()
            nodes.start('operator', {})
            clock.listen({'cmd_vel': TwistStamped})
            clock.begin()
            _tick_through(clock, progress, task, speed)
            node.destroy_node()
        return clock.heard
    finally:
        rclpy.shutdown(context=context)


def _tick_through(clock: Lockstep, progress: Progress, task: TaskID, speed: float) -> None:
    began = time.monotonic()
    duration = make_maneuver('basic_test').duration
    moved = False
    for tick in range(round(LONGEST * RATE)):
        clock.tick()
        status: WristStatus = clock.heard['wrist_status'][-1]
        asked = status.commanded.angular
        if any((asked.x, asked.y, asked.z)):
            moved = True
        elif moved:
            break
        done = tick / RATE - status.time_lost
        progress.update(task, completed=max(0.0, done / duration), saying=status.message[:44])
        if speed > 0.0:
            time.sleep(max(0.0, began + tick / (RATE * speed) - time.monotonic()))
    progress.update(task, completed=1.0, saying=f'flown, {status.time_lost:.4f} s lost')


def against_library(unscaled: Flight, scaled: Flight) -> list[Line]:
    """Return how far the ROS graph is from the same flights of the library alone."""
    rows = []
    for name, flight in (('unscaled', unscaled), ('scaled', scaled)):
        alone = fly(flight.wrist, flight.maneuver, RATE)
        n = min(len(alone.time), len(flight.time))
        gap = np.abs(alone.joint_positions[:n] - flight.joint_positions[:n]).max()
        rows.append(Line(f'graph from fly(), {name}', 'no graph', f'{gap:.1e} rad apart'))
    return rows


def table(rows: Sequence[Line]) -> Table:
    """Return the table "paper | measured"."""
    shown = Table(title='Barker (1986), figures 6 to 8, flown through ROS 2')
    for heading in ('figure', 'paper', 'measured'):
        shown.add_column(heading)
    for row in rows:
        shown.add_row(*row)
    return shown


def draw(unscaled: Flight, scaled: Flight, folder: Path) -> list[Path]:
    """Draw figures 6, 7 and 8 into a folder."""
    return [
        save(draw_tip(unscaled, 'Figure 6: probe tip, basic test maneuver'), folder / 'fig6.png'),
        save(
            draw_flight(unscaled, 'Figure 7: three-gimbal wrist without scaling'),
            folder / 'fig7.png',
        ),
        save(
            draw_flight(scaled, 'Figure 8: three-gimbal wrist scaled to 32 deg/s'),
            folder / 'fig8.png',
        ),
    ]


if __name__ == '__main__':
    sys.exit(main())
