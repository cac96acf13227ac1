"""How much time gimbal lock costs, at several joint speeds."""

import math

from wrist_control import fly

for limit in (16.0, 32.0, 64.0):
    flight = fly('three_gimbal', 'basic_test', joint_rate_limits=math.radians(limit))
    print(f'joints at {limit:2.0f} deg/s: {flight.time_lost[-1]:5.2f} s lost')
