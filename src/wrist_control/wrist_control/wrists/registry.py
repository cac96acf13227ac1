"""The wrists, by name. Adding one is a new file beside this one and one line here.

Nothing is imported here: setup.py reads this file to name the resolver executables.
"""

WRISTS = {
    'three_gimbal': 'ThreeGimbal',
    'stewart': 'Stewart',
}
