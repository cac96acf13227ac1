"""Which wrist for your task? Write the task as a maneuver, and let every wrist fly it."""

import math

from wrist_control.operating.maneuvers import Maneuver, turn
from wrist_control.studies.comparison import compare

SPEED = math.radians(32.0)  # of the hand
ROLL, PITCH, YAW = 0, 1, 2  # about the hand's own axes; x points away from the wrist

# Bend down by 80°, swing aside by 90°, and drive a screw there by half a turn.
task = Maneuver(
    'drive_a_screw',
    (
        turn(PITCH, math.radians(80.0), SPEED),
        turn(YAW, math.radians(90.0), SPEED),
        turn(ROLL, math.radians(180.0), SPEED),
    ),
)

performances = compare(maneuvers=[task])
able = [one for one in performances if one.completed and one.follows_roll]

print('wrist            time lost   path error   closest margin')
for one in sorted(able, key=lambda one: one.time_lost):
    error = math.degrees(one.path_error)
    print(f'{one.wrist:<16} {one.time_lost:7.2f} s {error:8.4f} deg {one.margin:16.3f}')

print('\nnot able:')
for one in performances:
    if not one.follows_roll:
        print(f'{one.wrist:<16} points only, and cannot roll')
    elif not one.completed:
        print(f'{one.wrist:<16} held up for good: {one.stopped_by}')
