"""The wrist of your robot, from its URDF: which joints, where they lock, what lock costs."""

import math
import sys
from pathlib import Path

from wrist_control import fly, make_wrist

# your_urdf.py [FILE TIP [JOINT ...]]
PANDA = Path(__file__).resolve().parents[1] / 'src' / 'wrist_control' / 'urdf' / 'panda.urdf'
file, tip, *joints = sys.argv[1:] or [str(PANDA), 'panda_link8']

wrist = make_wrist('urdf', description=file, tip=tip, joints=joints)
print('joints           from       to   at most')
for joint in wrist.joints:
    lower, upper, rate = (math.degrees(x) for x in (joint.lower, joint.upper, joint.rate_limit))
    print(f'{joint.name:<14} {lower:6.0f}°  {upper:6.0f}°  {rate:5.0f}°/s')

print('turns the hand on command about', ', '.join('xyz'[axis] for axis in wrist.followed_axes))
for region in wrist.clearances(wrist.home):
    print('is stopped before its', region.name)

for share in (1.0, 0.2):
    limits = [share * joint.rate_limit for joint in wrist.joints]
    flight = fly(wrist, 'basic_test', joint_rate_limits=limits)
    print(
        f'at {share:.0%} of its speed: closest to lock {flight.margin.min():.3f}, '
        f'{flight.time_lost[-1]:.2f} s late'
    )
