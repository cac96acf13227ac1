"""What the resolver of a run was, by the parameters that it has told."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, NamedTuple

from wrist_control.bags.run import Run
from wrist_control.errors import InvalidValueError
from wrist_control.nodes.resolver_settings import limited, mechanism, settings
from wrist_control.resolving.period import SupervisorSettings
from wrist_control.resolving.witness import Kind
from wrist_control.wrists import Wrist, wrist_names


class Resolver(NamedTuple):
    """What a resolver was, by its parameters.

    Attributes:
        name: Which wrist it had.
        wrist: The mechanism, with the limits it kept.
        settings: What its supervisor was told once.
        values: All parameters, by name.
    """

    name: str
    wrist: Wrist
    settings: SupervisorSettings
    values: Mapping[str, Any]


def first_resolver(run: Run) -> Resolver:
    """Return what the resolver was when the recording began.

    Raises:
        InvalidValueError: It does not say, or its wrist is not known here.
    """
    for _, inputs in run.messages('step_inputs'):
        for heard in inputs.heard:
            if heard.kind == Kind.PARAMETERS:
                return resolver_of(run, heard.text)
    raise InvalidValueError(
        f'{run.path} does not say which wrist it is of: nothing was recorded on '
        f'{run.space}step_inputs for a second; record it with `recorder`.'
    )


def resolver_of(run: Run, text: str) -> Resolver:
    """Return what a resolver was, of the parameters that it has told in a run.

    Raises:
        InvalidValueError: Its wrist is not known here, or is another here.
    """
    try:
        values = json.loads(text)
        name = values['wrist']
    except (ValueError, KeyError, TypeError):
        raise InvalidValueError(
            f'{run.path} has parameters of a resolver that cannot be read; record it anew.'
        ) from None
    if name not in wrist_names():
        raise InvalidValueError(
            f'{run.path} is of the wrist {name!r}, which is not known here; the wrists are '
            f'{", ".join(wrist_names())}.'
        )
    try:
        wrist = limited(mechanism(name, values), values)
        return Resolver(name, wrist, settings(wrist, values), values)
    except (KeyError, TypeError, AttributeError) as error:
        raise InvalidValueError(
            f'{run.path} is of another version: its {name} has no parameter {error}.'
        ) from error
