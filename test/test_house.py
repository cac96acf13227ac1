"""The house rules that tools do not check: no file too long, every test where its module is."""

from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / 'src' / 'wrist_control' / 'wrist_control'
TESTS = ROOT / 'src' / 'wrist_control' / 'test'
# What setup makes, and what is drawn.
MADE = ('build', 'install', 'log', 'out')
MOST_LINES = 300

# Rooms whose modules each have a test file of their own; the others are tested by what they do.
MIRRORED = ('operating', 'resolving', 'stewart', 'wrists')
# Steps of one computation: a test of each would only tell how it is divided. What they make is
# tested in test_forward_kinematics, and where they are certain in test_certificate.
PARTS = {
    'resolving': {'period'},
    'stewart': {
        'assembly',
        'batch',
        'general',
        'geometry',
        'quadratics',
        'solution',
        'stages',
        'tracking',
    },
}


def python_files():
    rooms = [one for one in ROOT.iterdir() if one.is_dir() and one.name not in MADE]
    ours = [room for room in rooms if not room.name.startswith('.')]
    return [*ROOT.glob('*.py'), *(file for room in ours for file in room.rglob('*.py'))]


def modules(room):
    return {file.stem for file in (PACKAGE / room).glob('*.py')} - {'__init__'}


def test_no_python_file_has_more_than_300_lines():
    lengths = {
        str(file.relative_to(ROOT)): len(file.read_text(encoding='utf-8').splitlines())
        for file in python_files()
    }
    assert len(lengths) > 100
    assert {file: n for file, n in lengths.items() if n > MOST_LINES} == {}


def test_every_folder_of_tests_is_a_room_of_the_package():
    folders = {file.parent for file in TESTS.rglob('test_*.py')} - {TESTS}
    assert {str(folder.relative_to(TESTS)) for folder in folders} >= set(MIRRORED)
    assert [
        folder for folder in folders if not (PACKAGE / folder.relative_to(TESTS)).is_dir()
    ] == []


@pytest.mark.parametrize('room', MIRRORED)
def test_every_module_has_a_test_file_that_begins_with_its_name(room):
    tests = [file.stem for file in (TESTS / room).glob('test_*.py')]
    parts = PARTS.get(room, set())
    assert parts <= modules(room)
    untested = {
        module
        for module in modules(room) - parts
        if not any(
            name == f'test_{module}' or name.startswith(f'test_{module}_') for name in tests
        )
    }
    assert untested == set()


@pytest.mark.parametrize('room', ['.', *MIRRORED, 'studies'])
def test_no_test_file_named_after_a_module_stands_in_another_folder(room):
    own = modules(room)
    elsewhere = {
        other: modules(other) for other in (*MIRRORED, 'studies', 'graph', 'ros', 'nodes')
    }
    misplaced = [
        file.name
        for file in (TESTS / room).glob('test_*.py')
        for other, names in elsewhere.items()
        if other != room and file.stem.removeprefix('test_') in names - own
    ]
    assert misplaced == []
