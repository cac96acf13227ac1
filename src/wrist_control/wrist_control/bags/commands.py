"""The commands of a recorded run, to be given again."""

from __future__ import annotations

import json
from pathlib import Path

from wrist_control.bags.run import Run, numbers
from wrist_control.errors import InvalidValueError
from wrist_control.operating.recorded import Given, RecordedCommands
from wrist_control.resolving.witness import Kind

# For how long a command was held where the recording does not say, s.
HELD = 0.25


class Flown:
    """What an operator needs to know of a run.

    Attributes:
        commands: Those that counted, at their times.
        in_forearm: Whether they are in the forearm's axes.
        cut: What is wrong with the recording's end; empty where nothing is.
    """

    def __init__(self, path: Path) -> None:
        """Read them.

        Raises:
            InvalidValueError: There is none, or they cannot be given again.
        """
        run = Run(path)
        heard = [one for _, inputs in run.messages('step_inputs') for one in inputs.heard]
        given = [one for one in heard if one.kind == Kind.COMMAND]
        if not given:
            raise InvalidValueError(
                f'{path} has no command that a resolver has followed; record one with `recorder`.'
            )
        frames = {bool(one.flag) for one in given}
        if len(frames) > 1:
            raise InvalidValueError(
                f'{path} has commands in the axes of the hand and of the forearm; valid is one '
                'with those of either.'
            )
        held = [
            json.loads(one.text)['command_timeout'] for one in heard if one.kind == Kind.PARAMETERS
        ]
        self.cut = run.cut
        self.in_forearm = frames.pop()
        self.commands = RecordedCommands(
            [Given(float(one.receipt_time), numbers(one.values)) for one in given],
            held[0] if held else HELD,
        )
