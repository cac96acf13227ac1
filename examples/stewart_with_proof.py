"""Where is a Stewart platform whose legs have these lengths, and how sure is that?"""

import math

from wrist_control import make_wrist
from wrist_control.rotations import IDENTITY, Pose, turned

wrist = make_wrist('stewart')

# Six readings, m; here those of a platform 20 mm aside and 50 mm above home, yawed by 10°.
x, y, z = 0.02, 0.0, wrist.home_height + 0.05
true = Pose(turned(IDENTITY, (0.0, 0.0, math.radians(10.0)), 1.0), (x, y, z))
lengths = tuple(wrist.inverse(true, wrist.home))

answer = wrist.forward_kinematics.solve(lengths)

print('leg lengths:', ' '.join(f'{length:.4f}' for length in lengths), 'm')
print(f'status: {answer.status.name}, after {answer.iterations} Newton steps')
if answer.pose is not None:
    print('position:', ' '.join(f'{part:.6f}' for part in answer.pose.position), 'm')
    print('quaternion x, y, z, w:', ' '.join(f'{part:.6f}' for part in answer.pose.xyzw))
print(f'proved: the true pose is within {answer.error_bound:.1e} m of this one,')
print(f'and no other pose within {1000.0 * answer.unique_radius:.1f} mm has these lengths')
print(f'(a turn counts as metres: rad times {wrist.size:.3f} m)')

# Lengths alone can fit several poses: what a cold start says of them.
print(wrist.forward_kinematics.cold_start(lengths).message)

# Lengths that no pose has are told as such, never answered with a pose.
misread = (lengths[0] + 1.0, *lengths[1:])
print(f'leg 1 read a metre too long: {wrist.forward_kinematics.solve(misread).status.name}')
