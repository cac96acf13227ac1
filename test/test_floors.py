"""The floors of the house: every import runs down the plan in docs/architecture.md."""

import ast
import json
import os
import pkgutil
import re
import subprocess
import sys
from pathlib import Path

import pytest

import wrist_control

PACKAGE = Path(wrist_control.__file__).parent
PLAN = (Path(__file__).resolve().parents[1] / 'docs' / 'architecture.md').read_text()
ROW = re.compile(r'^\| (\d+) \| `(\w+)/?` \| (.*?) \|', re.MULTILINE)
FLOORS = {room: int(floor) for floor, room, _ in ROW.findall(PLAN)}
FACE = 'wrist_control'

# Packages of ROS 2, and what belongs to them, by the beginning and the end of their names.
ROS = ('rclpy', 'rcl_interfaces', 'wrist_interfaces', 'builtin_interfaces', 'ament_', 'rosidl_')
ROS_ENDINGS = ('_msgs', '_srvs')
LOWEST_WITH_ROS = FLOORS['ros']
LOWEST_WITH_PICTURES = FLOORS['studies']
PHYSICS = 'mujoco'
NOT_IN_CORE = ('matplotlib', 'PIL', 'rich', 'scipy')
NO_CLOCK_NO_FILE = ('time', 'datetime', 'pathlib', 'os', 'io', 'threading', 'asyncio')

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

MODULES = [
    FACE,
    *(one.name for one in pkgutil.walk_packages([str(PACKAGE)], f'{FACE}.')),
]


def room_of(module):
    """Return the room that a module of ours stands in: a folder, a file, or the face."""
    parts = module.split('.')
    return parts[1] if len(parts) > 1 else FACE


def below(floor):
    return [name for name in MODULES if FLOORS[room_of(name)] < floor]


def is_core(module):
    """Return whether a module knows numpy alone."""
    return FLOORS[room_of(module)] < LOWEST_WITH_PICTURES


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


def source_of(module):
    file = PACKAGE.parent.joinpath(*module.split('.'))
    return file.with_suffix('.py') if file.with_suffix('.py').exists() else file / '__init__.py'


def imported(module):
    """Return the modules that a module names in its imports, those inside functions too."""
    names = set()
    for node in ast.walk(ast.parse(source_of(module).read_text(encoding='utf-8'))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f'{module}: imports are written out from {FACE} on'
            names.update(_named_by(node))
    return names


def roots(module):
    """Return the packages that a module names in its imports."""
    return {name.partition('.')[0] for name in imported(module)}


def _named_by(node):
    """Return the modules of ours that `from a import b` names: a.b where that is one, else a."""
    whole = {f'{node.module}.{alias.name}' for alias in node.names}
    inside = whole & set(MODULES)
    return inside if inside == whole else inside | {node.module}


def arrows():
    """Return every import of one of our rooms by another, as (from, to) by module."""
    return [
        (module, target)
        for module in MODULES
        for target in imported(module)
        if target in MODULES and room_of(target) != room_of(module)
    ]


def test_the_plan_shows_every_module_where_it_is():
    planned = {
        f'{FACE}.{room}.{module}'
        for _, room, modules in ROW.findall(PLAN)
        for module in re.findall(r'`(\w+)`', modules)
    }
    planned |= {f'{FACE}.wrists.{name}' for name in wrist_control.WRISTS}
    planned |= {FACE, *(f'{FACE}.{room}' for room in FLOORS if room != FACE)}
    assert planned == set(MODULES)


def test_every_import_runs_down():
    up = [
        (module, target)
        for module, target in arrows()
        if FLOORS[room_of(target)] >= FLOORS[room_of(module)]
    ]
    assert up == []


def test_an_arrow_that_runs_up_would_be_seen():
    """The rooms that are there are connected, and one turned round breaks the law."""
    found = {(room_of(a), room_of(b)) for a, b in arrows()}
    assert len(found) > 30
    assert ('resolving', 'wrists') in found
    assert FLOORS['wrists'] < FLOORS['resolving'] < FLOORS['nodes']


def test_below_ros_everything_can_be_imported_without_it():
    assert len(below(LOWEST_WITH_ROS)) > 40
    assert imports_without(below(LOWEST_WITH_ROS), ROS, ROS_ENDINGS) == {}


def test_the_nodes_cannot():
    refused = imports_without(['wrist_control.nodes.resolver'], ROS, ROS_ENDINGS)
    assert 'is not for this floor' in refused['wrist_control.nodes.resolver']


@pytest.mark.parametrize('name', below(LOWEST_WITH_ROS))
def test_no_module_below_names_ros_even_inside_a_function(name):
    for package in imported(name):
        top = package.partition('.')[0]
        assert not top.startswith(ROS), package
        assert not top.endswith(ROS_ENDINGS), package


def test_the_core_can_be_imported_without_matplotlib_rich_and_scipy():
    core = [name for name in MODULES if is_core(name)]
    assert len(core) > 25
    assert imports_without(core, NOT_IN_CORE) == {}


@pytest.mark.parametrize('name', [name for name in MODULES if is_core(name)])
def test_the_core_names_no_clock_no_file_and_no_picture_even_inside_a_function(name):
    above = {*NOT_IN_CORE, *NO_CLOCK_NO_FILE}
    assert roots(name).isdisjoint(above)


def test_only_the_room_of_physics_names_mujoco():
    assert {room_of(name) for name in MODULES if PHYSICS in roots(name)} == {'physics'}


def test_whoever_does_not_ask_for_physics_needs_no_mujoco():
    without = [name for name in below(LOWEST_WITH_ROS) if room_of(name) != 'physics']
    found = imports_without(without, [PHYSICS])
    assert {name.rpartition('.')[2] for name in found} == {'following', 'judge', 'judgement'}


def test_the_package_takes_only_numpy():
    code = """
import json, sys
before = set(sys.modules)
import wrist_control
tops = {name.partition('.')[0] for name in set(sys.modules) - before}
print(json.dumps(sorted(tops - set(sys.stdlib_module_names))))
"""
    assert run(code) == ['numpy', 'wrist_control']
