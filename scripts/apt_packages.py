"""Print the Ubuntu packages that a sourced ROS 2 Jazzy needs for this workspace, in one line."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import machine

# What the sentences about compilers and headers name.
TO_COMPILE = ('build-essential', 'python3-dev')


def packages(tables: Iterable[object]) -> Iterator[str]:
    """Give every package that some tables of `machine` name, also tables of tables."""
    for entry in tables:
        if isinstance(entry, dict):
            yield from packages(entry.values())
        else:
            yield str(entry)


def needed() -> list[str]:
    """Return every package, each once."""
    tables = [table for name, table in vars(machine).items() if name.startswith('APT_OF_')]
    return sorted({*TO_COMPILE, *packages(tables)})


if __name__ == '__main__':
    print(*needed())
