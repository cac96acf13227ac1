"""The floors of the house: what stands below knows nothing of what stands above."""

import ast
import json
import os
import pkgutil
import subprocess
import sys
from pathlib import Path

import pytest

import wrist_control

PACKAGE = Path(wrist_control.__file__).parent
UPPER = ('wrist_control.nodes', 'wrist_control.demo')
# Packages of ROS 2, and what belongs to them, by the beginning and the end of their names.
ROS = ('rclpy', 'rcl_interfaces', 'wrist_interfaces', 'builtin_interfaces', 'ament_', 'rosidl_')
ROS_ENDINGS = ('_msgs', '_srvs')
# The core needs numpy; pictures, tables and checks of others stand above it.
CORE = (
    'closure',
    'dexterity',
    'errors',
    'flight',
    'maneuvers',
    'pointing',
    'reproduction',
    'resolving',
    'rotations',
    'simulation',
    'stewart',
    'wrists',
)
NOT_IN_CORE = ('matplotlib', 'PIL', 'rich', 'scipy')

IMPORT_EACH = """
import importlib, json, sys
modules, beginnings, endings = json.loads(sys.argv[1])

class Blocked(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        top = name.partition('.')[0]
        if top.startswith(tuple(beginnings)) or top.endswith(tuple(endings)):
            raise ImportError(f'{name} is not for this floor')

loaded = [name for name in sys.modules if name.startswith(tuple(beginnings))]
for name in loaded:
    del sys.modules[name]
sys.meta_path.insert(0, Blocked())
found = {}
for name in modules:
    try:
        importlib.import_module(name)
    except ImportError as error:
        found[name] = str(error)
print(json.dumps(found))
"""


def run(code, *arguments):
    """Run code in a Python of its own, where this package is found, and return what it prints."""
    path = os.pathsep.join([str(PACKAGE.parent), *filter(None, sys.path)])
    done = subprocess.run(
        [sys.executable, '-c', code, *arguments],
        env={**os.environ, 'PYTHONPATH': path},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def imports_without(modules, beginnings, endings=()):
    """Return what goes wrong when modules are imported where some packages are not there."""
    wanted = json.dumps([modules, list(beginnings), list(endings)])
    return run(f'import importlib.abc\n{IMPORT_EACH}', wanted)


def is_below(name):
    return not any(name == upper or name.startswith(f'{upper}.') for upper in UPPER)


def is_core(name):
    return name == 'wrist_control' or name.split('.')[1] in CORE


MODULES = [
    'wrist_control',
    *(one.name for one in pkgutil.walk_packages([str(PACKAGE)], 'wrist_control.')),
]
BELOW = [name for name in MODULES if is_below(name)]


def imported(name):
    """Return the packages that a module names in its imports, those inside functions too."""
    file = PACKAGE.parent.joinpath(*name.split('.'))
    source = file.with_suffix('.py') if file.with_suffix('.py').exists() else file / '__init__.py'
    names = set()
    for node in ast.walk(ast.parse(source.read_text(encoding='utf-8'))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            names.add(node.module or '')
            names.update(f'{node.module}.{alias.name}' for alias in node.names)
    return names


def test_the_lower_floors_are_all_there():
    assert {'wrist_control.rotations', 'wrist_control.resolving.step'} <= set(BELOW)
    assert len(BELOW) > 40
    assert len(MODULES) - len(BELOW) > 10


def test_the_lower_floors_can_be_imported_without_ros():
    assert imports_without(BELOW, ROS, ROS_ENDINGS) == {}


def test_the_nodes_cannot():
    refused = imports_without(['wrist_control.nodes.resolver'], ROS, ROS_ENDINGS)
    assert 'is not for this floor' in refused['wrist_control.nodes.resolver']


@pytest.mark.parametrize('name', BELOW)
def test_no_module_below_names_ros_or_a_node_even_inside_a_function(name):
    for package in imported(name):
        top = package.partition('.')[0]
        assert not top.startswith(ROS), package
        assert not top.endswith(ROS_ENDINGS), package
        assert is_below(package), package


def test_the_core_can_be_imported_without_matplotlib_rich_and_scipy():
    core = [name for name in BELOW if is_core(name)]
    assert len(core) > 25
    assert imports_without(core, NOT_IN_CORE) == {}


@pytest.mark.parametrize('name', [name for name in BELOW if is_core(name)])
def test_the_core_names_no_clock_no_file_and_no_picture_even_inside_a_function(name):
    above = {*NOT_IN_CORE, 'time', 'datetime', 'pathlib', 'os', 'io', 'threading', 'asyncio'}
    assert {package.partition('.')[0] for package in imported(name)}.isdisjoint(above)


def test_the_package_takes_only_numpy():
    code = """
import json, sys
before = set(sys.modules)
import wrist_control
tops = {name.partition('.')[0] for name in set(sys.modules) - before}
print(json.dumps(sorted(tops - set(sys.stdlib_module_names))))
"""
    assert run(code) == ['numpy', 'wrist_control']
