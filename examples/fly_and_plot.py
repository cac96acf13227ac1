"""Fly a maneuver and draw what the joints and the probe tip do: out/fly_and_plot.png."""

import math
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from wrist_control import fly

LIMIT = 32.0  # deg/s, for every gimbal
PICTURE = Path('out/fly_and_plot.png')

flight = fly('three_gimbal', 'basic_test', joint_rate_limits=math.radians(LIMIT))

figure = Figure(figsize=(7.0, 6.0), layout='constrained')
rates, tip, lost = figure.subplots(3, sharex=True)

lines = rates.step(flight.time, np.degrees(flight.joint_rates), where='post')
rates.legend(lines, [joint.name for joint in flight.wrist.joints])
rates.set_ylabel('joint rates, deg/s')

tip.legend(tip.plot(flight.time, flight.tip), ('x', 'y', 'z'))
tip.set_ylabel('probe tip, m')

lost.plot(flight.time, flight.time_lost)
lost.set_ylabel('time lost, s')
lost.set_xlabel('time, s')

PICTURE.parent.mkdir(exist_ok=True)
figure.savefig(PICTURE, dpi=100)
print(f'{PICTURE}: {flight.time[-1]:.2f} s long, {flight.time_lost[-1]:.2f} s of it lost at lock')
