"""Wrists of other packages, found by the entry points that those have: docs/your-own-wrist.md."""

from __future__ import annotations

import inspect
from importlib import metadata

from wrist_control.errors import InvalidValueError
from wrist_control.wrists.registry import DESCRIBED, WRISTS
from wrist_control.wrists.wrist import Wrist

GROUP = 'wrist_control.wrists'
# By these another package names the mechanisms, of MuJoCo's, of its wrists.
MECHANISMS = 'wrist_control.physics'


def plugged_in() -> dict[str, metadata.EntryPoint]:
    """Return the entry points of other packages by the names of their wrists.

    A name that this package has itself is not among them.
    """
    found = metadata.entry_points(group=GROUP)
    return {point.name: point for point in found if point.name not in {**WRISTS, **DESCRIBED}}


def plugged_in_mechanisms() -> dict[str, metadata.EntryPoint]:
    """Return the entry points of the mechanisms of other packages, by their wrists' names."""
    found, wrists = metadata.entry_points(group=MECHANISMS), plugged_in()
    return {point.name: point for point in found if point.name in wrists}


def plugged_in_class(point: metadata.EntryPoint) -> type[Wrist]:
    """Return the class that an entry point names.

    Raises:
        InvalidValueError: It cannot be imported, or is no wrist.
    """
    owner = point.dist.name if point.dist else 'an unknown package'
    try:
        kind = point.load()
    except Exception as error:  # whatever a stranger's module does
        raise InvalidValueError(
            f'The wrist {point.name!r} of {owner} cannot be imported '
            f'({type(error).__name__}: {error}); mend that package, or remove it.'
        ) from error
    if not (inspect.isclass(kind) and issubclass(kind, Wrist)):
        raise InvalidValueError(
            f'{point.value} of {owner} is no wrist; its entry point {point.name!r} must name a '
            f'class that is derived from wrist_control.wrists.Wrist.'
        )
    return kind
