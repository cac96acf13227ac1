"""Packaging of wrist_control: which executables and which data files are installed."""

import runpy
from glob import glob
from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = 'wrist_control'

# Executables that do not depend on the kind of wrist: the name, and the module under nodes/.
NODES = [
    'joint_simulator',
    'operator',
    'stewart_forward_kinematics',
]


def wrist_names():
    """Return the names of all wrists, without importing the package.

    The registry is a plain dictionary, and is run on its own, so that a build needs no numpy.
    """
    registry = Path(__file__).resolve().parent / PACKAGE / 'wrists' / 'registry.py'
    return sorted(runpy.run_path(str(registry))['WRISTS'])


def console_scripts():
    """Return one executable per node, and one resolver per wrist."""
    names = NODES + [f'{wrist}_resolver' for wrist in wrist_names()]
    return [f'{name} = {PACKAGE}_start:{name}' for name in names]


setup(
    name=PACKAGE,
    version='0.1.0',
    description="Turns an operator's hand rates into joint rates for robot wrists.",
    license='Apache-2.0',
    maintainer='wrist_control maintainers',
    maintainer_email='maintainers@example.org',
    packages=find_packages(include=[PACKAGE, f'{PACKAGE}.*']),
    py_modules=[f'{PACKAGE}_start'],
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml']),
        # config is a link to the folder of the same name at the root of the repository.
        (f'share/{PACKAGE}/config', sorted(glob('config/*.yaml'))),
    ],
    install_requires=['setuptools'],
    extras_require={'test': ['pytest']},  # without this, `colcon test` finds no tests
    zip_safe=True,
    entry_points={'console_scripts': console_scripts()},
)
