"""What setup shows while it waits for others: how far they are, on a terminal and elsewhere."""

import os
import shutil
import sys

import pytest

import progress

PINS = """# made
one==1.0 \\
    --hash=sha256:0
two==2.0 ; python_full_version < '3.11' \\
    --hash=sha256:0
three==3.0 \\
    --hash=sha256:0
"""
COMMAND = ['sh', '-c', 'echo "[ 50%] Building C object"; sleep 0.5']


@pytest.mark.parametrize(
    ('output', 'state'),
    [
        ('', '0 of 3 packages'),
        ("Ignoring two: markers don't match\n", '0 of 2 packages'),
        ('Collecting one==1.0 (from -r r.txt)\n  Downloading one\n', '1 of 3 packages'),
        ('Requirement already satisfied: one==1.0\nProcessing /three.whl\n', '2 of 3 packages'),
        ('Collecting one\nInstalling collected packages: one\n', 'unpacking 3 packages'),
    ],
)
def test_packages_are_counted_as_pip_gets_them(output, state):
    assert progress.packages(PINS)(output) == state


@pytest.mark.parametrize(
    ('output', 'state'),
    [
        ('-- Found Python3\n', 'getting ready'),
        ('[  3%] Building\n[ 24%] Building\nwarning: 99%\n', '24%'),
        ('[100%] Built target\n', '100%'),
    ],
)
def test_a_build_is_as_far_as_cmake_says(output, state):
    assert progress.percent(output) == state


def test_elsewhere_than_on_a_terminal_a_line_comes_now_and_then(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(progress, 'TOLD_EVERY', 0.1)
    assert progress.run('building', COMMAND, tmp_path / 'log', progress.percent)
    first, *later = capsys.readouterr().out.splitlines()
    assert first == 'setup: building'
    assert set(later) <= {'setup:   50%, 0 s', 'setup:   50%, 1 s'}
    assert later


def test_no_line_comes_while_there_is_no_time_for_one(tmp_path, capsys):
    progress.run('building', COMMAND, tmp_path / 'log', progress.percent)
    assert capsys.readouterr().out == 'setup: building\n'


def test_on_a_terminal_one_line_is_drawn_over_itself(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(sys.stdout, 'isatty', lambda: True)
    progress.run('building', COMMAND, tmp_path / 'log', progress.percent)
    output = capsys.readouterr().out
    assert output.startswith('\rsetup: building, 0 s\033[K\rsetup: building, 50%, 0 s\033[K')
    assert output.count('\n') == 1
    assert output.endswith('\n')


@pytest.mark.parametrize(
    ('columns', 'line'), [(19, 'setup: building, 5'), (0, 'setup: building, 50%, 0 s')]
)
def test_the_line_stays_within_the_terminal(tmp_path, capsys, monkeypatch, columns, line):
    monkeypatch.setattr(sys.stdout, 'isatty', lambda: True)
    monkeypatch.setattr(shutil, 'get_terminal_size', lambda: os.terminal_size((columns, 0)))
    progress.run('building', COMMAND, tmp_path / 'log', progress.percent)
    lines = capsys.readouterr().out.strip().split('\r')
    assert f'{line}\033[K' in lines


def test_what_a_command_says_is_kept_and_its_failure_told(tmp_path):
    log = tmp_path / 'log'
    assert not progress.run('failing', ['sh', '-c', 'echo out; echo err >&2; exit 3'], log)
    assert log.read_text() == 'out\nerr\n'
