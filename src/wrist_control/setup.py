"""Packaging of wrist_control; who it is and its version are said in package.xml alone."""

import os
import runpy
from glob import glob
from pathlib import Path
from xml.etree import ElementTree

from setuptools import find_packages, setup

HERE = Path(__file__).resolve().parent
MANIFEST = ElementTree.parse(HERE / 'package.xml').getroot()
PACKAGE = MANIFEST.findtext('name')

# Executables that do not depend on the kind of wrist: the name, and the module under nodes/.
NODES = [
    'console',
    'joint_simulator',
    'keyboard',
    'operator',
    'physics_simulator',
    'rotary_stewart_forward_kinematics',
    'recorder',
    'stewart_forward_kinematics',
    'wrist_resolver',
]

# Commands that are no nodes: the name, and the module of the package.
COMMANDS = ['replay', 'report']

# The folders of files that come with the package.
SHIPPED = ('config', 'foxglove', 'launch', 'rviz', 'urdf')


def wrist_names():
    """Return the names of all wrists, without importing the package.

    The registry is a plain dictionary, and is run on its own, so that a build needs no numpy.
    """
    registry = runpy.run_path(str(HERE / PACKAGE / 'wrists' / 'registry.py'))
    return sorted([*registry['WRISTS'], *registry['DESCRIBED']])


def console_scripts():
    """Return one executable per node, and one resolver per wrist; none where there is no ROS."""
    if not os.environ.get('AMENT_PREFIX_PATH'):
        return []
    names = NODES + COMMANDS + [f'{wrist}_resolver' for wrist in wrist_names()]
    return [f'{name} = {PACKAGE}_start:{name}' for name in names]


setup(
    name=PACKAGE,
    version=MANIFEST.findtext('version'),
    description=MANIFEST.findtext('description'),
    license=MANIFEST.findtext('license'),
    license_files=['LICENSE'],
    maintainer=MANIFEST.findtext('maintainer'),
    maintainer_email=MANIFEST.find('maintainer').get('email'),
    package_data={f'{PACKAGE}.web': ['*.js', '*.css']},
    packages=find_packages(include=[PACKAGE, f'{PACKAGE}.*']),
    py_modules=[f'{PACKAGE}_start'],
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml', 'CHANGELOG.rst', 'LICENSE']),
        *((f'share/{PACKAGE}/{name}', sorted(glob(f'{name}/*.*'))) for name in SHIPPED),
    ],
    python_requires='>=3.10',
    install_requires=['numpy>=1.26'],
    extras_require={
        'console': ['nicegui>=3.18'],
        'figures': ['matplotlib', 'pillow', 'rich'],
        'physics': ['mujoco>=3.3', 'rich'],
        'record': ['mcap>=1.2', 'rosbags>=0.10'],
        # ROS 2 Jazzy from its wheels; wrist_interfaces and tf2_msgs are built beside it.
        'ros': ['ros-jazzy-common-interfaces==5.3.6', 'ros-jazzy-rclpy[fastrtps]==7.1.6'],
        # By this name `colcon test` knows which tool runs the tests.
        # Reading a robot's description needs nothing else; whoever asks for it gets just that.
        'urdf': [],
        'test': ['hypothesis', 'pytest', 'pytest-timeout', 'scipy'],
    },
    zip_safe=False,
    entry_points={'console_scripts': console_scripts()},
)
