"""The mechanisms: pure kinematics, one file each, behind one interface."""

from __future__ import annotations

from dataclasses import fields
from importlib import import_module
from typing import Any

from wrist_control.errors import InvalidValueError
from wrist_control.wrists.joint import Joint
from wrist_control.wrists.plugins import plugged_in, plugged_in_class
from wrist_control.wrists.registry import DESCRIBED, WRISTS
from wrist_control.wrists.wrist import Clearance, Configuration, Wrist

__all__ = [
    'WRISTS',
    'Clearance',
    'Configuration',
    'Joint',
    'Wrist',
    'make_wrist',
    'wrist_class',
    'wrist_names',
]

OWN = {**WRISTS, **DESCRIBED}


def wrist_class(name: str) -> type[Wrist]:
    """Return the class of a wrist by its name: one of `wrist_names`.

    Raises:
        InvalidValueError: No wrist of that name, or one of another package that is none.
    """
    if name in OWN:
        kind: type[Wrist] = getattr(import_module(f'{__name__}.{name}'), OWN[name])
        return kind
    others = plugged_in()
    if name not in others:
        raise InvalidValueError(
            f'There is no wrist {name!r}; the wrists are {", ".join([*OWN, *others])}.'
        )
    return plugged_in_class(others[name])


def wrist_names() -> tuple[str, ...]:
    """Return the names of all wrists: this package's, and those that other packages plug in."""
    return (*OWN, *plugged_in())


def make_wrist(name: str, **dimensions: Any) -> Wrist:
    """Return a wrist by its name.

    Args:
        name: One of `wrist_names`.
        dimensions: The mechanism's own parameters, SI units.

    Raises:
        InvalidValueError: No wrist of that name, or a dimension it does not have or accept.
    """
    kind = wrist_class(name)
    known = [own.name for own in fields(kind) if own.name != 'joints' or own.metadata]
    strange = [key for key in dimensions if key not in known]
    if strange:
        raise InvalidValueError(
            f'{name} has no parameter {", ".join(strange)}; it has {", ".join(known) or "none"}.'
        )
    return kind(**dimensions)
