"""How many times real time the physics of each wrist runs: ratios within one run."""

import math
import time

from rich.console import Console
from rich.table import Table

from wrist_control import WRISTS, make_wrist
from wrist_control.physics.driven import DrivenMechanism, Drives
from wrist_control.physics.mechanism import Settings
from wrist_control.physics.models import build
from wrist_control.studies.following import RATE, flown

SECONDS = 10.0
SETTINGS = Settings(payload=0.5, gravity=(0.0, 0.0, -9.80665))
GOAL = 10.0  # times real time


def mechanism_of(flight):
    wrist, count = flight.wrist, len(flight.wrist.joints)
    drives = Drives(1.0 / RATE, 0.013, [math.inf] * count, [0.1] * count)
    start = flight.joint_positions[0]
    return DrivenMechanism(build(wrist, SETTINGS), wrist.joints, drives, start)


def times_real_time(flight):
    """Return the simulated time for each second of the processor, flying the stick."""
    mechanism = mechanism_of(flight)
    began = time.process_time()
    for positions in flight.joint_positions:
        mechanism.advance(positions)
    return len(flight.joint_positions) / RATE / (time.process_time() - began)


def main():
    """Print the table."""
    found = {name: times_real_time(flown(make_wrist(name), SECONDS)) for name in WRISTS}
    fastest = max(found.values())
    table = Table(title=f'Physics, steps of {1e3 * SETTINGS.step:g} ms')
    for heading in ('wrist', 'times real time', 'of the fastest'):
        table.add_column(heading, justify='right')
    for name, ratio in found.items():
        table.add_row(name, f'{ratio:.0f}', f'{ratio / fastest:.2f}')
    console = Console()
    console.print(table)
    console.print(f'Goal: at least {GOAL:g} times real time.')


if __name__ == '__main__':
    main()
