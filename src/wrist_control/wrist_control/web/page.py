"""The page: what a person sees and holds."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nicegui import Client, ui

from wrist_control.operating.lease import Renewal
from wrist_control.operating.maneuvers import MANEUVERS
from wrist_control.resolving.report import WristState
from wrist_control.web.driver import Asked
from wrist_control.web.elements import Stick, Strips
from wrist_control.web.samples import Sample
from wrist_control.web.scene import WristScene
from wrist_control.web.strips import row, strips
from wrist_control.web.watched import WatchedWrist
from wrist_control.wrists import Wrist

if TYPE_CHECKING:
    from wrist_control.web.console import Console

# Updates of a page a second, a few more than are promised, for a timer is late; what its strips
# show, s.
UPDATES, SHOWN = 36.0, 10.0
# How long a page says why it does not drive, s.
TOLD = 3.0
FLOWN = [name for name in MANEUVERS if name != 'hold']
ABSENT = 'NOBODY'
# With this in its address, after a question mark, a page has no pictures: for slow devices.
PLAIN = 'plain'
WAITS = 'No wrist is here yet: start a resolver, or wait for it.'
STYLE = (Path(__file__).parent / 'page.css').read_text()
# A stop is a request of its own, which needs nothing of the page but the network.
SCRIPT = """
<script>
  window.stopEverything = () => fetch("/stop", {method: "POST", keepalive: true});
  // A scene looks at its size when the window says that it has another one.
  window.addEventListener("load", () => {
    const told = new ResizeObserver(() => window.dispatchEvent(new Event("resize")));
    const watch = setInterval(() => {
      const cards = document.querySelectorAll(".card");
      if (cards.length) clearInterval(watch);
      cards.forEach((card) => told.observe(card));
    }, 50);
  });
</script>
"""


def build(console: Console) -> None:
    """Build the page for one browser."""
    _Page(console, ui.context.client)


class _Page:
    """One browser's page."""

    def __init__(self, console: Console, client: Client) -> None:
        self._console = console
        self._holder = client.id
        self._said = [wrist.said[0] for wrist in console.wrists]
        self._shown: list[Wrist | None] = [None, None]
        self._pushed: Sample | None = None
        self._refused = (0.0, '')
        self._speed = math.degrees(console.values['speed'])
        self._draws = PLAIN not in client.request.query_params
        ui.add_head_html(SCRIPT)
        ui.add_css(STYLE)
        ui.query('body').classes('console')
        with ui.element('main').classes('page'):
            self._header()
            with ui.element('section').classes('saying'):
                self._sentence = ui.label(WAITS).classes('sentence').props('role=status')
            with ui.element('section').classes('scenes'):
                self._cards = [self._card(slot) for slot in range(2)]
            with ui.element('section').classes('strips'):
                self._strips = Strips(SHOWN) if self._draws else None
            with ui.element('section').classes('controls'):
                self._controls()
        ui.timer(1.0 / UPDATES, self._update)
        client.on_disconnect(partial(console.driver.release, self._holder))
        client.on_delete(partial(console.driver.forget, self._holder))

    def _header(self) -> None:
        with ui.element('header').classes('top'):
            ui.label('wrist_control').classes('brand')
            if self._console.startable:
                self._choice(0, 'Wrist', self._console.startable)
                self._choice(1, 'Beside it', ('none', *self._console.startable))
            self._state = ui.label(ABSENT).classes('state')
            self._who = ui.label('').classes('who')
            ui.element('span').classes('space')
            with ui.element('button').classes('stop').props('type=button') as stop:
                ui.label('STOP')
            stop.on('pointerdown', js_handler='() => window.stopEverything()')

    def _choice(self, slot: int, label: str, names: Sequence[str]) -> None:
        def chosen(event: Any) -> None:
            if event.value != self._console.names[slot]:
                self._console.choose(slot, event.value)

        select = ui.select(list(names), value=self._console.names[slot], label=label)
        select.props('dense outlined options-dense').classes('choice').on_value_change(chosen)
        ui.timer(0.5, lambda: select.set_value(self._console.names[slot]))

    def _card(self, slot: int) -> tuple[WristScene | None, Any, Any]:
        with ui.element('div').classes('card' if slot == 0 else 'card second') as card:
            scene = WristScene() if self._draws else None
            figures = ui.label('').classes('figures')
        card.set_visibility(slot == 0)
        return scene, figures, card

    def _controls(self) -> None:
        self._stick = Stick(self._hold, partial(self._console.driver.release, self._holder))
        with ui.element('div').classes('settings'):
            with ui.element('div').classes('line'):
                ui.select(FLOWN, value=FLOWN[0], label='Maneuver').props(
                    'dense outlined options-dense'
                ).classes('choice').on_value_change(lambda event: self._stick.fly(event.value))
                ui.button('Enable', on_click=self._enable).props('unelevated dense no-caps')
                ui.button('Reset', on_click=self._reset).props('outline dense no-caps')
            self._slider(
                'Full stick',
                'deg/s',
                1,
                round(math.degrees(self._console.values['fastest'])),
                round(self._speed),
                self._set_speed,
            )
            self._slider('Joint rates', '%', 5, 100, 100, self._limit)
            ui.html(
                'Keys <kbd>W</kbd><kbd>S</kbd> q, <kbd>A</kbd><kbd>D</kbd> p, '
                '<kbd>Q</kbd><kbd>E</kbd> r, <kbd>Space</kbd> stop. '
                'Gamepad: hold the right shoulder button.',
                sanitize=False,
            ).classes('keys')
        self._stick.fly(FLOWN[0])

    @staticmethod
    def _slider(
        label: str, unit: str, low: float, high: float, value: float, on_change: Any
    ) -> None:
        with ui.element('div').classes('slider'):
            ui.label(label).classes('label')
            slider = ui.slider(min=low, max=high, value=value, step=1)
            slider.on_value_change(lambda event: on_change(event.value))
            ui.label().classes('value').bind_text_from(
                slider, 'value', lambda number: f'{number:g} {unit}'
            )

    def _set_speed(self, degrees: float) -> None:
        self._speed = degrees

    def _limit(self, percent: float) -> None:
        for wrist in self._console.wrists:
            self._console.later(partial(wrist.limit_rates, 0.01 * percent))

    def _enable(self) -> None:
        for wrist in self._there():
            self._console.later(wrist.enable)

    def _reset(self) -> None:
        for wrist in self._there():
            self._console.later(wrist.reset)

    def _there(self) -> list[WatchedWrist]:
        return [wrist for wrist in self._console.wrists if wrist.status is not None] or [
            self._console.wrists[0]
        ]

    def _hold(self, told: dict[str, Any]) -> None:
        p, q, r = told['pqr']
        asked = Asked((p, q, r), math.radians(self._speed), told['fly'])
        renewal = Renewal(self._holder, int(told['grip']), float(told['beat']), asked)
        refused = self._console.driver.hold(renewal, time.monotonic())
        if refused:
            self._stick.refuse(renewal.grip)
            self._refused = (time.monotonic() + TOLD, refused)

    def _update(self) -> None:
        """Show what the wrists do now."""
        now = time.monotonic()
        self._stick.beat(now)
        for slot, wrist in enumerate(self._console.wrists):
            self._show(slot, wrist)
            number, success, sentence = wrist.said
            if number != self._said[slot]:
                self._said[slot] = number
                ui.notify(
                    sentence,
                    type='positive' if success else 'negative',
                    position='top',
                    timeout=4000,
                )
        self._say(now)
        self._push()

    def _show(self, slot: int, watched: WatchedWrist) -> None:
        scene, figures, card = self._cards[slot]
        wrist, status = watched.wrist, watched.status
        if slot == 1:
            card.set_visibility(wrist is not None)
        if wrist is None:
            return
        if wrist is not self._shown[slot]:
            self._shown[slot] = wrist
            if scene is not None:
                scene.show(wrist)
            if slot == 0 and self._strips is not None:
                self._strips.show(strips(wrist))
        if watched.positions is None or status is None:
            return
        lost = status.lost_axis
        if scene is not None:
            scene.move(watched.positions, (lost.x, lost.y, lost.z), status.margin)
        figures.set_text(self._figures(watched))

    def _figures(self, watched: WatchedWrist) -> str:
        assert watched.status is not None
        off = math.degrees(watched.off_path.angle) if watched.off_path else 0.0
        first = _rank(watched) == min(map(_rank, self._there())) and len(self._there()) > 1
        return (
            f'{"★ " if first else ""}{watched.name}   {watched.status.time_lost:.2f} s late   '
            f'{off:.2f}° off the path'
        )

    def _say(self, now: float) -> None:
        first = self._console.wrists[0]
        status = first.status
        self._sentence.set_text(status.message if status else WAITS)
        state = WristState(status.state).name if status else ABSENT
        self._state.set_text(state)
        self._state.props(f'data-state={state}')
        self._who.set_text(self._whose(now))

    def _whose(self, now: float) -> str:
        """Return who holds the stick, or why it is not this page."""
        until, refused = self._refused
        if now < until:
            return refused
        holder = self._console.driver.holder(now)
        if not holder:
            return 'Nobody holds the stick'
        return 'You hold the stick' if holder == self._holder else 'Another page holds the stick'

    def _push(self) -> None:
        first = self._console.wrists[0]
        newest = first.newest
        if newest is None or newest is self._pushed or first.wrist is None:
            return
        self._pushed = newest
        if self._strips is not None:
            self._strips.push([row(first.wrist, newest)])


def _rank(watched: WatchedWrist) -> tuple[float, float]:
    """Return what two wrists are compared by: time lost, then how far off the path."""
    assert watched.status is not None
    off = watched.off_path.angle if watched.off_path else 0.0
    return round(watched.status.time_lost, 2), round(off, 3)
