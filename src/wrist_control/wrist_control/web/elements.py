"""The parts of the page that are made for it: the stick, and the strips."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from nicegui.element import Element
from nicegui.elements import echart
from nicegui.events import GenericEventArguments

ECHARTS = str(Path(echart.__file__).parent / 'dist')


class Stick(Element, component='stick.js'):
    """Pad, slide, keys, gamepad, and a button that flies: what a person holds."""

    def __init__(
        self, on_hold: Callable[[dict[str, Any]], object], on_drop: Callable[[], object]
    ) -> None:
        """Make one.

        Args:
            on_hold: Told again and again, while it is held, of `grip`, `beat`, `pqr` and `fly`.
            on_drop: Told when it is let go.
        """
        super().__init__()

        def hold(event: GenericEventArguments) -> None:
            on_hold(event.args)

        self.on('hold', hold)
        self.on('drop', lambda _: on_drop())

    def fly(self, maneuver: str) -> None:
        """Say what its button flies."""
        self.props['maneuver'] = maneuver
        self.update()

    def beat(self, time: float) -> None:
        """Tell the page the server's time, s."""
        self.run_method('beat', time)

    def refuse(self, grip: int) -> None:
        """Tell the page that a grip is not followed."""
        self.run_method('refuse', grip)


class Strips(Element, component='strips.js', esm={'nicegui-echart': ECHARTS}):
    """Charts of the last seconds, one above the other."""

    def __init__(self, seconds: float) -> None:
        """Make them, without any strip.

        Args:
            seconds: How much they show.
        """
        super().__init__()
        self.props['strips'] = []
        self.props['seconds'] = seconds

    def show(self, strips: Sequence[dict[str, Any]]) -> None:
        """Show other strips."""
        self.props['strips'] = list(strips)
        self.update()

    def push(self, rows: Sequence[Sequence[float]]) -> None:
        """Add samples: a time, s, and one value for each line."""
        self.run_method('push', rows)
