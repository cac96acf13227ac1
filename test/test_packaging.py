"""The packages as others get them: copied, built, released and installed without ROS."""

import ast
import importlib.util
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import venv
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from catkin_pkg.changelog import get_changelog_from_path

import setup_workspace
import wrist_control

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = {name: ROOT / 'src' / name for name in ('wrist_control', 'wrist_interfaces')}
CONTROL = PACKAGES['wrist_control']
# What an import is called in the lists of ROS's dependencies.
KEYS = {
    name: f'python3-{key}'
    for name, key in {
        'matplotlib': 'matplotlib',
        'numpy': 'numpy',
        'PIL': 'pil',
        'rich': 'rich',
        'yaml': 'yaml',
    }.items()
}
ROOMS = ('wrist_control', 'launch')
# What the launch file starts of other packages, but where it is installed.
OPTIONAL = {'rviz2'}
BUILD = "from setuptools import build_meta as b; b.build_sdist('dist'); b.build_wheel('dist')"
# What only an extra brings: ROS's lists have no package of it.
EXTRA = {'fastapi', 'mcap', 'mujoco', 'nicegui', 'rosbags', 'starlette', 'uvicorn'}
# What tools leave in the package's folder.
MADE = ('__pycache__', '.hypothesis', '.pytest_cache', 'build', 'wrist_control.egg-info')
WITHOUT_ROS = {name: value for name, value in os.environ.items() if name != 'AMENT_PREFIX_PATH'}


def manifest(package):
    return ElementTree.parse(package / 'package.xml').getroot()


def imports():
    """Return the first part of every absolute import in what is installed, but Python's own."""
    found = set()
    for file in (file for room in ROOMS for file in (CONTROL / room).rglob('*.py')):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Import):
                found |= {name.name.partition('.')[0] for name in node.names}
            elif isinstance(node, ast.ImportFrom) and not node.level:
                found.add(node.module.partition('.')[0])
    return found - sys.stdlib_module_names - {'wrist_control'}


def started():
    """Return every package that the launch file starts a node of."""
    launched = (CONTROL / 'launch' / 'wrist.launch.py').read_text()
    return set(re.findall(r"package='(\w+)'", launched))


@pytest.fixture(scope='module')
def dist(tmp_path_factory):
    """The package, copied from the repository and built where there is no ROS."""
    copy = tmp_path_factory.mktemp('release') / 'wrist_control'
    shutil.copytree(CONTROL, copy, ignore=shutil.ignore_patterns(*MADE))
    done = subprocess.run(
        [sys.executable, '-W', 'error', '-c', BUILD],
        cwd=copy,
        env={**WITHOUT_ROS, 'PYTHONWARNINGS': ''},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return copy / 'dist'


@pytest.fixture(scope='module')
def installed(dist, tmp_path_factory):
    """The wheel in an environment that has numpy, and nothing else."""
    folder = tmp_path_factory.mktemp('environment')
    venv.create(folder, symlinks=True)
    python = folder / 'bin' / 'python'
    # An environment that was made without pip has it beside the Python that made it.
    pip = sys.executable if importlib.util.find_spec('pip') else sys._base_executable
    (wheel,) = dist.glob('*.whl')
    options = ['--quiet', '--no-index', '--no-deps', '--disable-pip-version-check']
    subprocess.run(
        [pip, '-m', 'pip', '--python', python, 'install', *options, wheel],
        check=True,
        env=WITHOUT_ROS,
    )
    (packages,) = (folder / 'lib').glob('python*/site-packages')
    for found in Path(np.__file__).parents[1].glob('numpy*'):
        (packages / found.name).symlink_to(found)
    return folder


def run(folder, *arguments):
    done = subprocess.run(
        [folder / 'bin' / 'python', *arguments],
        cwd=folder,
        env={'PATH': os.environ['PATH']},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_library_flies_where_there_is_numpy_and_nothing_else(installed):
    flown = 'from wrist_control import fly; print(fly("three_gimbal", "basic_test").scale_factor)'
    assert run(installed, '-c', flown)
    told = run(installed, '-m', 'wrist_control')
    assert told.startswith(f'wrist_control {manifest(CONTROL).findtext("version")}: ')
    assert all(wrist in told for wrist in wrist_control.WRISTS)
    assert 'without matplotlib, PIL, rich' in told
    assert 'without mujoco' in told
    assert 'without rclpy, wrist_interfaces' in ' '.join(told.split())


def test_what_is_said_with_everything_installed_needs_nothing_more():
    told = subprocess.run(
        [sys.executable, '-m', 'wrist_control'], capture_output=True, text=True, check=True
    ).stdout
    assert 'ros2 run wrist_control' in told
    assert 'without' not in told
    example = re.findall(r'^  ((?:from|flight|print).*)$', told, re.MULTILINE)
    done = subprocess.run([sys.executable, '-c', '\n'.join(example)], capture_output=True)
    assert done.stdout.endswith(b's lost in gimbal lock\n'), done.stderr


def test_without_its_extra_the_physics_says_what_brings_it(installed):
    found = 'try:\n  import wrist_control.physics\nexcept ImportError as error:\n  print(error)'
    assert "pip install 'wrist_control[physics]'" in run(installed, '-c', found)


def test_where_there_is_no_ros_there_are_no_executables(installed, dist):
    (wheel,) = dist.glob('*.whl')
    assert not [name for name in zipfile.ZipFile(wheel).namelist() if 'entry_points' in name]
    assert not [file for file in (installed / 'bin').iterdir() if 'resolver' in file.name]


def test_the_wheel_says_what_it_needs(dist):
    (wheel,) = dist.glob('*.whl')
    (metadata,) = (
        zipfile.ZipFile(wheel).read(name).decode()
        for name in zipfile.ZipFile(wheel).namelist()
        if name.endswith('METADATA')
    )
    needed = re.findall(r'^Requires-Dist: (\S+?)[>=;\s].*$', metadata, re.MULTILINE)
    assert needed[0] == 'numpy'
    always = [
        line for line in metadata.splitlines() if 'Requires-Dist' in line and ';' not in line
    ]
    assert always == ['Requires-Dist: numpy>=1.26']
    assert {'figures', 'physics', 'ros', 'test'} <= set(
        re.findall(r'Provides-Extra: (\w+)', metadata)
    )
    assert 'Requires-Python: >=3.10' in metadata


def test_the_source_release_is_whole(dist):
    """The wheel that is built from it has the same files; tests, configuration and all are in."""
    (source,) = dist.glob('*.tar.gz')
    with tarfile.open(source) as archive:
        names = {name.partition('/')[2] for name in archive.getnames()}
    wanted = {
        str(file.relative_to(CONTROL))
        for file in CONTROL.rglob('*')
        if file.is_file() and not set(file.relative_to(CONTROL).parts) & set(MADE)
    }
    assert wanted <= names, wanted - names


@pytest.mark.parametrize('folder', setup_workspace.SHIPPED)
def test_what_comes_with_the_package_is_installed(installed, folder):
    here = sorted(file.name for file in (CONTROL / folder).glob('*.*'))
    share = installed / 'share' / 'wrist_control' / folder
    assert here == sorted(file.name for file in share.iterdir() if file.is_file())
    assert here


def test_set_up_knows_every_folder_that_is_installed():
    assert f'SHIPPED = {setup_workspace.SHIPPED}\n' in (CONTROL / 'setup.py').read_text()


def test_no_package_has_a_link_that_leaves_it():
    for package in PACKAGES.values():
        links = [file for file in package.rglob('*') if file.is_symlink()]
        assert links == []
        assert (package / 'LICENSE').read_text() == (ROOT / 'LICENSE').read_text()


def test_the_version_is_one():
    versions = {name: manifest(package).findtext('version') for name, package in PACKAGES.items()}
    assert len(set(versions.values())) == 1
    (version,) = set(versions.values())
    for package in PACKAGES.values():
        said = get_changelog_from_path(package).foreach_version()
        newest, _, content = next(one for one in said if one[0].lower() != 'forthcoming')
        assert newest == version
        assert content
    assert f'(tag `{version}`)' in (ROOT / 'CHANGELOG.md').read_text()


def test_the_manifest_names_everything_that_is_imported():
    named = {
        one.text for kind in ('depend', 'exec_depend') for one in manifest(CONTROL).iter(kind)
    }
    needed = {KEYS.get(name, name) for name in imports() - EXTRA | started() - OPTIONAL}
    assert needed <= named, needed - named


def test_the_manifest_names_nothing_that_is_not_imported():
    named = {
        one.text for kind in ('depend', 'exec_depend') for one in manifest(CONTROL).iter(kind)
    }
    assert named - {KEYS.get(name, name) for name in imports() | started() - OPTIONAL} == set()
    assert started() >= OPTIONAL
    assert imports() >= EXTRA


def test_the_tests_of_the_package_alone_are_found_and_pass(tmp_path):
    """As `colcon test` runs them: in the package's own folder, wherever it was copied to."""
    copy = tmp_path / 'wrist_control'
    shutil.copytree(CONTROL, copy, ignore=shutil.ignore_patterns('__pycache__'))
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join([str(copy), *sys.path])}
    environment.pop('PYTEST_ADDOPTS', None)
    pytest_alone = [sys.executable, '-m', 'pytest', '-q', '-p', 'no:cacheprovider']

    def tested(*arguments):
        done = subprocess.run(
            [*pytest_alone, *arguments],
            cwd=copy,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    (collected,) = re.findall(r'(\d+) tests collected', tested('--collect-only'))
    assert int(collected) > 1000
    assert ' passed' in tested('test/stewart/test_certificate.py', 'test/test_rotations.py')


def test_this_python_is_one_that_the_package_is_for():
    lowest = re.findall(r"python_requires='>=3\.(\d+)'", (CONTROL / 'setup.py').read_text())
    assert int(sysconfig.get_python_version().partition('.')[2]) >= int(lowest[0])
