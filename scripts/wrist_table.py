"""Write docs/wrists.md: what there is to know of every registered wrist, asked of the code.

python3 scripts/wrist_table.py [FILE]
"""

from __future__ import annotations

import inspect
import math
import sys
from collections.abc import Iterator
from pathlib import Path

from wrist_control.wrists import WRISTS, Wrist, make_wrist, wrist_class
from wrist_control.wrists.registry import DESCRIBED

DOCS = Path(__file__).resolve().parent.parent / 'docs'
TARGET, GALLERY = DOCS / 'wrists.md', DOCS / 'gallery'
HEAD = """# The wrists

Written by `make docs` from the code itself; nothing here is kept by hand.
Angles are in rad and lengths in m; joints are named outermost first.

The animations show the basic test maneuver in real time, every joint held to 32 deg/s: pitch by
90°, then yaw by 90°. `make gallery` draws them again.

| wrist | resolver | joints | home | follows | edges of its workspace |
| --- | --- | --- | --- | --- | --- |
"""
PARAMETERS = """
| parameter | default | valid | meaning |
| --- | --- | --- | --- |
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
    """Yield a row for each text, dimension and list of points of one wrist."""
    kind = wrist_class(name)
    for text in kind.texts().values():
        valid = 'a list of names' if text.names else 'a text'
        yield f'| `{text.parameter}` | empty | {valid} | {text.description} |'
    for parameter, facts in kind.dimensions().items():
        most = '' if math.isinf(facts.maximum) else f' to {facts.maximum:.4g}'
        valid = f'{facts.minimum:.4g}{most}{"" if most else " or more"} {facts.unit}'
        yield f'| `{parameter}` | {facts.default:.4g} | {valid} | {facts.description} |'
    for parameter, points in kind.point_lists().items():
        yield f'| `{parameter}` | empty | finite, m | {points.description}; all in a row |'


def section(name: str) -> str:
    """Return the section of one wrist: what it looks like, what it is, and its parameters."""
    told = inspect.getdoc(wrist_class(name)) or ''
    text = f'\n## {name}\n\n'
    if (GALLERY / f'{name}.png').exists():
        text += f'![{name} in motion](gallery/{name}.webp)\n\n'
        text += f'![{name} at home, half bent and at its worst](gallery/{name}.png)\n\n'
    text += told.partition('\nAttributes:')[0].strip() + '\n'
    rows = list(parameter_rows(name))
    return text + (PARAMETERS + '\n'.join(rows) + '\n' if rows else '')


def document() -> str:
    """Return the whole document."""
    rows = [wrist_row(name, make_wrist(name)) for name in WRISTS]
    beside = '\nBeside the parameters below, each has those of '
    beside += '[every resolver](interfaces.md#parameters-of-every-resolver).\n'
    return HEAD + '\n'.join(rows) + '\n' + beside + ''.join(map(section, [*WRISTS, *DESCRIBED]))


if __name__ == '__main__':
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else TARGET
    target.write_text(document(), encoding='utf-8')
    print(f'written: {target}')
