"""How well the tests bite: small faults are put into the package, and the tests shall find them.

Each fault is made in a copy of the package, in a temporary folder that comes first on PYTHONPATH.
The tests that matter for it run until the first fails.  Tests that read a text, and those that
start the demo, are left out.
"""

from __future__ import annotations

import argparse
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Table

from chosen_mutants import CHOSEN
from equivalent_mutants import EQUIVALENT
from mutations import Mutant, points
from tests_that_matter import tests_of

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / 'src' / 'wrist_control' / 'wrist_control'

FOLDERS = ('wrists', 'resolving', 'stewart', 'operating', 'ros', 'nodes')
WORKERS = 2  # as many as the cores of a small machine
GOAL = 0.95  # of the random ones; every chosen one must be found
LONGEST_TEST = 60  # s
LONGEST_RUN = 600  # s, after which a fault counts as found: it has made the program hang


def chosen() -> list[Mutant]:
    """Return the faults of the list.

    Raises:
        ValueError: A text of the list is not in its file, or more than once.
    """
    found = []
    for file, text, replacement, _ in CHOSEN:
        source = (PACKAGE / file).read_text()
        if source.count(text) != 1:
            raise ValueError(
                f'scripts/chosen_mutants.py: {file} has {source.count(text)} times {text!r}; '
                'it must be there once.'
            )
        before = source[: source.index(text)]
        line = before.count('\n') + 1
        found.append(Mutant(file, line, text, replacement, len(before.encode())))
    return found


def sample(folder: str, count: int, seed: int) -> list[Mutant]:
    """Return random faults of a folder, one in a place."""
    chance = random.Random(f'{folder} {seed}')
    places = []
    for path in sorted((PACKAGE / folder).glob('*.py')):
        file = f'{folder}/{path.name}'
        lines = path.read_text().splitlines()
        same = {
            (line, before, after) for where, line, before, after, _ in EQUIVALENT if where == file
        }
        for place in points(file, path.read_bytes()):
            different = [
                one
                for one in place
                if (lines[one.line - 1].strip(), one.before, one.after) not in same
            ]
            places += [different] if different else []
    return [chance.choice(place) for place in chance.sample(places, min(count, len(places)))]


class Worker:
    """A copy of the package of its own."""

    def __init__(self, folder: Path, number: int) -> None:
        self._folder = folder / str(number)
        shutil.copytree(PACKAGE, self._folder / PACKAGE.name)
        path = os.pathsep.join([str(self._folder), os.environ.get('PYTHONPATH', '')])
        self._environment = os.environ | {
            'HYPOTHESIS_STORAGE_DIRECTORY': str(self._folder / 'hypothesis'),
            'PYTHONDONTWRITEBYTECODE': '1',
            'PYTHONPATH': path,
            'ROS_PYTHON_CHECK_FIELDS': '1',
        }
        self._process: subprocess.Popen[bytes] | None = None
        self.output = self._folder / 'output.txt'

    def finds(self, mutant: Mutant) -> bool:
        """Tell whether a test fails with a fault in the package."""
        path = self._folder / PACKAGE.name / mutant.file
        source = path.read_bytes()
        path.write_bytes(mutant.applied(source))
        try:
            return self.fails(tests_of(mutant.file))
        finally:
            path.write_bytes(source)

    def fails(self, tests: Sequence[str]) -> bool:
        """Tell whether a test fails, or takes for ever."""
        command = [sys.executable, '-m', 'pytest', '-x', '-q', '--tb=short', '-k', 'not demo']
        command += ['-p', 'no:cacheprovider', '-p', 'no:xdist', '--hypothesis-seed=0']
        command += [f'--timeout={LONGEST_TEST}', '-c', str(ROOT / 'pyproject.toml'), *tests]
        with self.output.open('w') as output:
            self._process = subprocess.Popen(
                command,
                cwd=self._folder,
                env=self._environment,
                stdin=subprocess.DEVNULL,
                stdout=output,
                stderr=output,
                start_new_session=True,
            )
            try:
                return self._process.wait(LONGEST_RUN) != 0
            except subprocess.TimeoutExpired:
                return True
            finally:
                self.end()

    def end(self) -> None:
        """End the tests, and all that they have started."""
        if self._process:
            with suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()


def survivors(mutants: Sequence[Mutant], folder: Path, console: Console) -> list[Mutant]:
    """Return the faults that no test finds.

    Raises:
        RuntimeError: The tests fail without any fault, and so say nothing.
    """
    workers = [Worker(folder, number) for number in range(WORKERS)]
    tests = list(dict.fromkeys(test for one in mutants for test in tests_of(one.file)))
    console.print(f'First {len(tests)} test files without any fault.')
    free: SimpleQueue[Worker] = SimpleQueue()
    for worker in workers:
        free.put(worker)
    with ThreadPoolExecutor(WORKERS) as pool:
        parts = [tests[number::WORKERS] for number in range(WORKERS)]
        for worker, failed in zip(workers, pool.map(Worker.fails, workers, parts), strict=True):
            if failed:
                raise RuntimeError(f'Without any fault:\n{worker.output.read_text()[-3000:]}')

    left: list[Mutant] = []
    columns = (TextColumn('{task.description}'), BarColumn(), MofNCompleteColumn())
    with Progress(*columns, TimeRemainingColumn(), console=console) as progress:
        task = progress.add_task('0 survive', total=len(mutants))

        def judge(mutant: Mutant) -> None:
            worker = free.get()
            try:
                if not worker.finds(mutant):
                    left.append(mutant)
                    progress.console.print(f'survives: {mutant}', markup=False, highlight=False)
            finally:
                free.put(worker)
            progress.update(task, advance=1, description=f'{len(left)} survive')

        with ThreadPoolExecutor(WORKERS) as pool:
            try:
                list(pool.map(judge, mutants))
            except KeyboardInterrupt:
                pool.shutdown(wait=False, cancel_futures=True)
                for worker in workers:
                    worker.end()
                raise
    return left


def report(kinds: dict[str, list[Mutant]], left: Sequence[Mutant], console: Console) -> bool:
    """Show the table and the survivors, and tell whether the goal is met."""
    table = Table('faults', 'made', 'found', 'share')
    good = True
    for kind, mutants in kinds.items():
        found = sum(mutant not in left for mutant in mutants)
        share = found / len(mutants) if mutants else 1.0
        good = good and share >= (1.0 if kind == 'chosen' else GOAL)
        table.add_row(kind, str(len(mutants)), str(found), f'{share:.0%}')
    console.print(table)
    for mutant in sorted(left):
        console.print(str(mutant), markup=False, highlight=False, soft_wrap=True)
    return good


def main() -> int:
    """Make the faults, run the tests, and show what they find."""
    parser = argparse.ArgumentParser(description=(__doc__ or '').splitlines()[0])
    parser.add_argument('--count', type=int, default=40, help='random faults for each folder')
    parser.add_argument('--seed', type=int, default=1, help='another seed makes other faults')
    parser.add_argument('--folder', choices=FOLDERS, help='this folder alone')
    either = parser.add_mutually_exclusive_group()
    either.add_argument('--chosen', action='store_true', help='the chosen faults alone')
    either.add_argument('--random', action='store_true', help='the random faults alone')
    options = parser.parse_args()
    folders = [options.folder] if options.folder else FOLDERS
    mine = options.folder or ''
    kinds: dict[str, list[Mutant]] = {}
    if not options.random:
        kinds['chosen'] = [one for one in chosen() if one.file.startswith(mine)]
    if not options.chosen:
        kinds |= {name: sample(name, options.count, options.seed) for name in folders}
    console = Console()
    with tempfile.TemporaryDirectory() as folder:
        made = [mutant for mutants in kinds.values() for mutant in mutants]
        left = survivors(made, Path(folder), console)
    return 0 if report(kinds, left, console) else 1


if __name__ == '__main__':
    sys.exit(main())
