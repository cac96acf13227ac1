"""The wrists, by name. Adding one is a new file beside this one and one line here.

Nothing is imported here: setup.py reads this file to name the resolver executables.
"""

# Those that nobody can make without a description of the robot that has them.
DESCRIBED = {'urdf': 'Urdf'}

WRISTS = {
    'three_gimbal': 'ThreeGimbal',
    'four_gimbal': 'FourGimbal',
    'roll_pitch_roll': 'RollPitchRoll',
    'single_hooke': 'SingleHooke',
    'double_hooke': 'DoubleHooke',
    'omni_wrist': 'OmniWrist',
    'carpal': 'Carpal',
    'pitch_yaw': 'PitchYaw',
    'five_bar': 'FiveBar',
    'stewart': 'Stewart',
    'rotary_stewart': 'RotaryStewart',
}
