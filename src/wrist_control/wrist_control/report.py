"""Make one page of a recorded run: rates, limits, time lost, the mechanism, what was said."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from wrist_control.bags import check_installed
from wrist_control.errors import InvalidValueError, WristError
from wrist_control.runs.terminal import add_run, progress


def main(arguments: Sequence[str] | None = None) -> int:
    """Make a report of a recording; the exit code is 2 when there is nothing to tell."""
    parser = argparse.ArgumentParser(prog='report', description=__doc__)
    add_run(parser)
    parser.add_argument('--out', type=Path, help='the page; RUN.html beside the recording if none')
    chosen = parser.parse_args(arguments)
    console = Console(soft_wrap=True)
    try:
        check_installed()
        made = _report(chosen.run, chosen.namespace, chosen.out, console)
    except KeyboardInterrupt:
        return 130
    except WristError as error:
        print(f'Cannot report: {error}', file=sys.stderr)
        return 2
    console.print(f'written: {made}', highlight=False, markup=False)
    return 0


def _report(path: Path, space: str, out: Path | None, console: Console) -> Path:
    from wrist_control.bags.run import Run
    from wrist_control.runs.page import page
    from wrist_control.runs.series import series

    with progress(console) as shown:
        reading = shown.add_task('reading', total=1.0)
        run = Run(path, space, lambda share: shown.update(reading, completed=share))
        drawing = shown.add_task('drawing', total=1.0)
        text = page(
            series(run), path, run.cut, lambda share: shown.update(drawing, completed=share)
        )
    target = out or path.absolute().with_suffix('.html')
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding='utf-8')
    except OSError as error:
        raise InvalidValueError(
            f'{target} cannot be written ({error.strerror}); say another place with --out.'
        ) from error
    return target


if __name__ == '__main__':
    sys.exit(main())
