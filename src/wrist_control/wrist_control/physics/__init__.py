"""Each wrist as a mechanism of MuJoCo's: links, hinges, loops and servos, without our kinematics.

Needs the extra `physics`; nothing else of the package imports it.
"""
