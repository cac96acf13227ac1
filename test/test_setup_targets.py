"""What each target of the Makefile sets up, what ./env needs, and what is pinned for them."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from packaging.markers import default_environment
from packaging.requirements import Requirement

import machine

ROOT = Path(__file__).resolve().parents[1]
MAKEFILE = (ROOT / 'Makefile').read_text()
NEEDS = dict(re.findall(r'^([a-z]+):([^#\n]*)##', MAKEFILE, re.MULTILINE))
PINNED = sorted(ROOT.glob('requirements*.txt'))
EXTRAS = {file.stem.removeprefix('requirements-') for file in PINNED if '-' in file.stem}
EXTRAS -= {'build'}
PYTHONS = ('3.10.13', '3.11.7', '3.12.1', '3.13.0')

# Those who only look at the wrists shall not wait for what checks the code.
LIGHT = ('demo', 'compare', 'dexterity', 'hour', 'campaign')
EVERYTHING = {f'setup-{extra}' for extra in EXTRAS}
HEAVY = {
    'test': EVERYTHING,
    'coverage': EVERYTHING,
    'console': {'setup-console'},
    'judge': {'setup-physics'},
    'lint': {'setup-test'},
    'format': {'setup-test'},
    'bench': {'setup-test', 'setup-physics', 'setup-console'},
    'mutants': {'setup-test'},
    'docs': {'setup-docs'},
}


@pytest.mark.parametrize('target', LIGHT)
def test_a_light_target_needs_no_extra(target):
    assert NEEDS[target].split() == ['setup']


@pytest.mark.parametrize('target', HEAVY)
def test_a_heavy_target_needs_its_own_extras_alone(target):
    assert set(NEEDS[target].split()) == HEAVY[target]


def test_every_extra_that_a_target_asks_for_is_there_and_the_other_way_round():
    assert set(re.findall(r'setup-(\w+)', ' '.join(NEEDS.values()))) == EXTRAS


def test_every_extra_is_looked_for_where_ros_is_sourced():
    assert set(machine.APT_OF_EXTRA) == EXTRAS


def test_all_that_a_sourced_ros_lacks_is_said_with_what_brings_it(tmp_path, monkeypatch):
    monkeypatch.setenv('AMENT_PREFIX_PATH', str(tmp_path))
    monkeypatch.setattr(machine, 'has_module', lambda name: name in machine.APT_OF_MODULE)
    sentence = machine.ros_problem(['docs'])
    assert 'sphinx' in sentence
    assert 'python3-sphinx' in sentence
    assert 'hypothesis' not in sentence
    assert sentence.endswith(', and install latex2mathml with its pip.')


def pins(file):
    """Return every pinned requirement of a file, with its hashes."""
    text = re.sub(r'^#.*\n', '', file.read_text(), flags=re.MULTILINE)
    lines = text.replace('\\\n', '').splitlines()
    return [(Requirement(line.split('--hash=')[0]), line.split('--hash=')[1:]) for line in lines]


@pytest.mark.parametrize('file', PINNED, ids=lambda file: file.stem)
def test_every_distribution_is_pinned_and_has_hashes(file):
    assert pins(file)
    for requirement, hashes in pins(file):
        assert re.fullmatch(r'==[\w.]+', str(requirement.specifier)), requirement
        assert hashes, requirement
        assert all(re.fullmatch(r'sha256:[0-9a-f]{64} *', one) for one in hashes), requirement


@pytest.mark.parametrize('file', sorted(ROOT.glob('requirements*')), ids=lambda file: file.name)
def test_no_requirements_file_says_where_to_download_from(file):
    assert not re.search(r'://|index-url|find-links', file.read_text())


@pytest.mark.parametrize('python', PYTHONS)
def test_all_extras_fit_into_one_environment(python):
    environment = default_environment()
    environment |= {'python_full_version': python, 'python_version': python.rpartition('.')[0]}
    versions = {}
    for requirement, _ in (pin for file in PINNED for pin in pins(file)):
        if requirement.marker is None or requirement.marker.evaluate(environment):
            versions.setdefault(requirement.name, set()).add(str(requirement.specifier))
    assert {name: found for name, found in versions.items() if len(found) > 1} == {}
    wanted = {
        re.split(r'[\W]*[=<>;\s\[]', line)[0]
        for file in ROOT.glob('requirements*.in')
        for line in re.sub(r'#.*', '', file.read_text()).splitlines()
        if line.strip()
    }
    assert wanted - set(versions) == set()


def test_every_pinned_distribution_is_in_the_document_of_the_licences():
    document = (ROOT / 'docs' / 'licences.md').read_text()
    rows = [row.split(' | ') for row in document.splitlines() if row.startswith('| ')]
    listed = {row[0].lstrip('| '): set(row[1].split(', ')) for row in rows}
    pinned = {}
    for requirement, _ in (pin for file in PINNED for pin in pins(file)):
        version = str(requirement.specifier).removeprefix('==')
        pinned.setdefault(requirement.name, set()).add(version)
    assert {name: listed.get(name) for name in pinned} == pinned, 'run scripts/licences.py'
    assert all(row[2].strip(' |') for row in rows)


@pytest.fixture
def checkout(tmp_path):
    """A folder in which ./env finds what it asks for."""
    (tmp_path / 'install').mkdir()
    (tmp_path / 'install' / 'local_setup.sh').touch()
    shutil.copy(ROOT / 'env', tmp_path)
    return tmp_path


def run(checkout, **variables):
    kept = {name: value for name, value in os.environ.items() if not name.startswith('ROS_')}
    return subprocess.run(
        ['./env', 'sh', '-c', 'echo "$ROS_LOG_DIR"'],
        cwd=checkout,
        env={**kept, 'ROS_DISTRO': 'jazzy', 'TMPDIR': str(checkout), **variables},
        capture_output=True,
        text=True,
    )


def test_a_home_that_can_be_written_takes_the_log(checkout):
    done = run(checkout, HOME=str(checkout / 'home'))
    assert (done.returncode, done.stdout, done.stderr) == (0, '\n', '')


@pytest.mark.parametrize(
    'variables', [{'HOME': '/dev/null'}, {'HOME': ''}, {'ROS_HOME': '/dev/null'}]
)
def test_where_the_log_cannot_be_written_another_place_takes_it(checkout, variables):
    done = run(checkout, **variables)
    folder = Path(done.stdout.strip())
    assert done.returncode == 0
    assert folder.parent == checkout
    assert folder.is_dir()
    assert 'env: ROS cannot keep its log in /dev/null/' in done.stderr
    assert str(folder) in done.stderr


def test_ros_starts_where_home_cannot_be_written(process_environment, tmp_path):
    begin = 'import rclpy; rclpy.init(); rclpy.shutdown()'
    kept = {name: value for name, value in process_environment.items() if 'ROS_LOG' not in name}
    done = subprocess.run(
        ['./env', 'python3', '-c', begin],
        cwd=ROOT,
        env={**kept, 'HOME': '/dev/null', 'TMPDIR': str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60.0,
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr.startswith('env: ROS cannot keep its log in /dev/null/.ros/log')
    assert len(done.stderr.splitlines()) == 1
