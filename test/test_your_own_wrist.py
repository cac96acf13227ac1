"""docs/your-own-wrist.md, to the letter: a wrist is added to a copy, and everything holds."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from wrist_control import WRISTS

ROOT = Path(__file__).resolve().parents[1]
GUIDE = (ROOT / 'docs' / 'your-own-wrist.md').read_text()
NAME = 'pitch_roll_yaw'
NOT_COPIED = shutil.ignore_patterns('.*', 'build', 'install', 'log', 'out', '__pycache__')
# Run in the copy: what the packaging would install, without installing it.
ENTRY_POINTS = """
import setuptools
setuptools.setup = lambda **told: print(*told['entry_points']['console_scripts'], sep='\\n')
exec(open('setup.py').read(), {'__file__': 'setup.py'})
"""


def block(language, number=0):
    return re.findall(rf'```{language}\n(.*?)```', GUIDE, re.DOTALL)[number]


@pytest.fixture(scope='module')
def copy(tmp_path_factory):
    """A copy of the repository with the four steps made."""
    copy = tmp_path_factory.mktemp('copy') / 'wrist_control'
    shutil.copytree(ROOT, copy, ignore=NOT_COPIED, symlinks=True)
    package = copy / 'src' / 'wrist_control' / 'wrist_control'
    (package / 'wrists' / f'{NAME}.py').write_text(block('python'))
    registry = package / 'wrists' / 'registry.py'
    listed = registry.read_text()
    assert listed.rstrip().endswith('}')
    registry.write_text(listed.rstrip()[:-1] + block('text') + '}\n')
    (copy / 'config' / f'{NAME}.yaml').write_text(block('yaml'))
    return copy


def run(copy, *command, **options):
    """Run a command with the copy's package in front of the installed one."""
    path = [str(copy / 'src' / 'wrist_control'), *filter(None, sys.path)]
    environment = {**os.environ, 'PYTHONPATH': os.pathsep.join(path)}
    environment.pop('PYTEST_ADDOPTS', None)
    return subprocess.run(
        [sys.executable, *command],
        cwd=copy,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        **options,
    )


def test_the_paths_of_the_guide_are_those_of_the_repository():
    for path in re.findall(r'`(src/[^`]*/)[\w.]+`', GUIDE):
        assert (ROOT / path).is_dir(), path
    assert (ROOT / 'config').is_dir()
    wrists = ROOT / 'src' / 'wrist_control' / 'wrist_control' / 'wrists'
    files = {name: len((wrists / f'{name}.py').read_text()) for name in WRISTS}
    (shortest,) = re.findall(r'`(\w+\.py)` is the shortest file', GUIDE)
    assert shortest == f'{min(files, key=files.get)}.py'


def test_the_new_wrist_gets_its_executable(copy):
    done = run(copy / 'src' / 'wrist_control', '-c', ENTRY_POINTS)
    assert f'{NAME}_resolver = wrist_control_start:{NAME}_resolver' in done.stdout, done.stderr


def test_the_new_wrist_flies(copy):
    code = f'from wrist_control import fly; print(fly({NAME!r}, "pitch_then_roll").completed)'
    done = run(copy, '-c', code)
    assert done.stdout.strip() in ('True', 'False'), done.stderr


@pytest.mark.timeout(300)
def test_every_test_that_finds_the_new_wrist_passes(copy):
    """The documents are written first, as the guide says."""
    written = run(copy, 'scripts/wrist_table.py')
    assert written.returncode == 0, written.stderr
    tests = ['src/wrist_control/test', *(f'test/test_{name}.py' for name in ('docs', 'edges'))]
    tests += [f'test/test_{name}.py' for name in ('resolvers', 'parameters', 'floors')]
    done = run(copy, '-m', 'pytest', '-q', '-p', 'no:cacheprovider', '-k', NAME, *tests)
    assert done.returncode == 0, done.stdout + done.stderr
    assert int(re.findall(r'(\d+) passed', done.stdout)[0]) > 25


def test_the_plan_of_the_house_holds_with_the_new_wrist(copy):
    done = run(copy, '-m', 'pytest', '-q', '-p', 'no:cacheprovider', 'test/test_floors.py')
    assert done.returncode == 0, done.stdout + done.stderr
