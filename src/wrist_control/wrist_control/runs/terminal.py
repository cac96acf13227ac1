"""What a person types of a command about a run, and sees of it while it works."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn


def add_run(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that say which run is meant."""
    parser.add_argument('run', type=Path, help='folder of a recording, or its .mcap file')
    parser.add_argument(
        '--namespace', default='', help='whose run, where a recording has several wrists'
    )


def progress(console: Console) -> Progress:
    """Return how far long work is, shown until it is done."""
    return Progress(
        TextColumn('{task.description:<24}'),
        BarColumn(),
        TimeElapsedColumn(),
        console=console,
        transient=True,
    )
