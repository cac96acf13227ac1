"""Robots to try the wrist of a URDF on: those that come with the package, and any axes."""

from pathlib import Path

import numpy as np

from wrist_control import make_wrist

FOLDER = Path(__file__).resolve().parents[2] / 'urdf'
# The tip of each, and its joints where they are not the last three.
SHIPPED = {
    'panda': {'tip': 'panda_link8'},
    'ur5e': {'tip': 'tool0'},
    'jaco': {'tip': 'end_effector'},
    'pan_tilt': {'tip': 'camera_optical'},
    'four_joints': {'tip': 'tool', 'joints': ['first', 'second', 'third', 'fourth']},
}

LIMIT = '<limit lower="-1" upper="2" velocity="3"/>'
ABOUT_Y, ABOUT_Z = '<axis xyz="0 1 0"/>', '<axis xyz="0 0 1"/>'


def shipped(name):
    """Return the wrist of a robot that comes with the package."""
    return make_wrist('urdf', description=str(FOLDER / f'{name}.urdf'), **SHIPPED[name])


def joint(name, parent, child, kind='continuous', inside=''):
    """Return a joint as XML."""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'{inside}</joint>'
    )


def row(values):
    """Return numbers as an attribute, to the last digit."""
    return ' '.join(repr(float(value)) for value in values)


def robot(axes, tip_rpy=(0.0, 0.0, 0.0), origins=None, rpys=None):
    """Return a robot with joints j0, j1 … on links l0, l1 … and the link tip, as XML."""
    origins = np.zeros((len(axes) + 1, 3)) if origins is None else origins
    rpys = np.zeros((len(axes), 3)) if rpys is None else rpys
    links = [f'l{number}' for number in range(len(axes) + 1)]
    parts = [f'<link name="{link}"/>' for link in [*links, 'tip']]
    for number, (axis, xyz, rpy) in enumerate(zip(axes, origins, rpys, strict=False)):
        inside = f'<origin xyz="{row(xyz)}" rpy="{row(rpy)}"/><axis xyz="{row(axis)}"/>'
        parts.append(joint(f'j{number}', links[number], links[number + 1], inside=inside))
    inside = f'<origin xyz="{row(origins[-1])}" rpy="{row(tip_rpy)}"/>'
    parts.append(joint('end', links[-1], 'tip', 'fixed', inside))
    return f'<robot name="any">{"".join(parts)}</robot>'


def wrist_of(axes, **geometry):
    """Return the wrist of a robot with axes, all of its joints."""
    names = [f'j{number}' for number in range(len(axes))]
    return make_wrist('urdf', description=robot(axes, **geometry), tip='tip', joints=names)


def random_robot(random, count, least=0.35):
    """Return a wrist with random axes of which none in a row are closer than an angle, rad."""
    while True:
        axes = random.normal(size=(count, 3))
        axes /= np.linalg.norm(axes, axis=1)[:, None]
        apart = np.linalg.norm(np.cross(axes[:-1], axes[1:]), axis=1)
        if apart.min() > np.sin(least):
            return wrist_of(
                axes,
                tip_rpy=random.uniform(-3.0, 3.0, 3),
                origins=random.uniform(-0.1, 0.1, (count + 1, 3)),
            )


def described(*joints):
    """Return a robot with the links a to f and joints."""
    links = ''.join(f'<link name="{name}"/>' for name in 'abcdef')
    return f'<robot name="r">{links}{"".join(joints)}</robot>'


def three(**changes):
    """Return a robot with the joints one, two and three before the link d, some changed."""
    joints = {
        'one': joint('one', 'a', 'b', inside=ABOUT_Z),
        'two': joint('two', 'b', 'c', inside=ABOUT_Y),
        'three': joint('three', 'c', 'd', inside=ABOUT_Z),
    }
    return described(*(joints | changes).values())
