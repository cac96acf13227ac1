"""Write docs/wrists.md: what there is to know of every registered wrist, asked of the code.

python3 scripts/wrist_table.py [FILE]
"""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator
from pathlib import Path

from wrist_control.wrists import WRISTS, Wrist, make_wrist, wrist_class

TARGET = Path(__file__).resolve().parent.parent / 'docs' / 'wrists.md'
HEAD = """# The wrists

Written by `make docs` from the code itself; nothing here is kept by hand.
Angles are in rad and lengths in m; joints are named outermost first.

| wrist | resolver | joints | home | follows | edges of its workspace |
| --- | --- | --- | --- | --- | --- |
"""
PARAMETERS = """
## Their own parameters

Beside those of [every resolver](interfaces.md#parameters-of-every-resolver).

| wrist | parameter | default | valid | meaning |
| --- | --- | --- | --- | --- |
"""


def wrist_row(name: str, wrist: Wrist) -> str:
    """Return the row of one wrist."""
    joints = ' '.join(f'`{joint.name}`' for joint in wrist.joints)
    home = ', '.join(f'{position:.4g}' for position in wrist.home)
    follows = ', '.join('pqr'[axis] for axis in wrist.followed_axes)
    if wrist.twist_size == 6:
        follows = f'vx, vy, vz, {follows}'
    edges = ', '.join(clearance.name for clearance in wrist.clearances(wrist.home)) or 'none'
    return f'| `{name}` | `{name}_resolver` | {joints} | {home} | {follows} | {edges} |'


def parameter_rows(name: str) -> Iterator[str]:
    """Yield a row for each dimension and each list of points of one wrist."""
    kind = wrist_class(name)
    for parameter, facts in kind.dimensions().items():
        most = '' if math.isinf(facts.maximum) else f' to {facts.maximum:.4g}'
        valid = f'{facts.minimum:.4g}{most}{"" if most else " or more"} {facts.unit}'
        yield f'| `{name}` | `{parameter}` | {facts.default:.4g} | {valid} | {facts.description} |'
    for parameter, points in kind.point_lists().items():
        meaning = f'{points.description}; all in a row'
        yield f'| `{name}` | `{parameter}` | empty | finite, m | {meaning} |'


def document() -> str:
    """Return the whole document."""
    rows = [wrist_row(name, make_wrist(name)) for name in WRISTS]
    parameters = [row for name in WRISTS for row in parameter_rows(name)]
    return HEAD + '\n'.join(rows) + '\n' + PARAMETERS + '\n'.join(parameters) + '\n'


if __name__ == '__main__':
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else TARGET
    target.write_text(document(), encoding='utf-8')
    print(f'written: {target}')
