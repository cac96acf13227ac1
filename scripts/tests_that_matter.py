"""Which tests can find a fault in a module, the likeliest first.

Tests that read a text are left out: no fault is in what they read.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
UNIT_TESTS = ROOT / 'src' / 'wrist_control' / 'test'
GRAPH_TESTS = ROOT / 'test'

# Unit tests of other folders that see a folder's faults, after the folder's own.
FURTHER = {
    'wrists': ('testing', 'resolving', 'test_flight.py'),
    'resolving': ('testing', 'test_flight.py'),
    'stewart': ('wrists/test_stewart.py', 'wrists/test_stewart_assembly.py', 'resolving'),
    'operating': ('test_flight.py',),
}
# The modules under nodes/ that have no tests by their own name.
PARTS_OF = {
    'nodes/keyboard_enable.py': 'nodes.keyboard',
    'nodes/keyboard_terminal.py': 'nodes.keyboard',
    'nodes/resolver_clock.py': 'nodes.resolver',
    'nodes/resolver_inputs.py': 'nodes.resolver',
    'nodes/resolver_journal.py': 'nodes.resolver',
    'nodes/resolver_outputs.py': 'nodes.resolver',
    'nodes/resolver_pictures.py': 'nodes.resolver',
    'nodes/resolver_settings.py': 'nodes.resolver',
    'resolving/platform_observer.py': 'nodes.stewart_forward_kinematics',
}
LEFT_OUT = ('test_docs.py', 'test_floors.py')
# Slower and slower, and so later and later.
SLOW = (
    'test_bad_input.py',
    'test_parameters.py',
    'test_resolvers.py',
    'test_edges.py',
    'test_stewart_graph.py',
    'test_basic_maneuver.py',
    'test_processes.py',
)


def tests_of(file: str) -> list[str]:
    """Return the test files that matter for a module, the likeliest to find a fault first."""
    folder, name = file.split('/')
    stem = name.removesuffix('.py')
    mirror = sorted((UNIT_TESTS / folder).glob('test_*.py'))
    mirror.sort(key=lambda path: not f'{path.stem}_'.startswith(f'test_{stem}_'))
    for other in FURTHER.get(folder, ()):
        path = UNIT_TESTS / other
        mirror += sorted(path.glob('test_*.py')) if path.is_dir() else [path]
    return [str(path) for path in mirror + list(_graph_tests(file))]


def _graph_tests(file: str) -> Iterator[Path]:
    """Return the tests on a real graph that start a module, quick ones first."""
    module = PARTS_OF.get(file, file.removesuffix('.py').replace('/', '.'))
    if not module.startswith(('nodes.', 'ros.', 'graph.')):
        return
    word = file.removesuffix('.py').rpartition('_')[2].rpartition('/')[2]

    def lateness(path: Path) -> tuple[object, ...]:
        return _slowness(path), word not in path.stem, word not in path.read_text(), path

    paths = [path for path in GRAPH_TESTS.glob('test_*.py') if path.name not in LEFT_OUT]
    for path in sorted(paths, key=lateness):
        # Whatever carries messages is in every node.
        known = module.startswith('ros.') or module in path.read_text()
        if known or path.name == 'test_processes.py':
            yield path


def _slowness(path: Path) -> int:
    return SLOW.index(path.name) + 1 if path.name in SLOW else 0
