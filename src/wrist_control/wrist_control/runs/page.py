"""The page that tells of a run: one file that loads nothing from anywhere."""

from __future__ import annotations

import datetime
from collections.abc import Callable, Iterator
from html import escape
from pathlib import Path
from string import Template

import numpy as np

from wrist_control.resolving.report import WristState
from wrist_control.runs import panels
from wrist_control.runs.look import STYLE
from wrist_control.runs.series import Series, Told, duration

# So many sentences are shown at once; all others behind a click.
AT_ONCE = 40
# A sentence that stood for a shorter time could not be read, s.
READABLE = 0.15
PAGE = Template("""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>$title</title>
<style>
$style</style>
</head>
<body>
<header>
<h1>$title</h1>
<p class="where">$where</p>
</header>
<main>
$parts
</main>
<footer>$footer</footer>
</body>
</html>
""")


def page(series: Series, path: Path, cut: str, tell: Callable[[float], None]) -> str:
    """Return the page of a run.

    Args:
        series: The run.
        path: Where its recording is.
        cut: What is wrong with the recording's end; empty where nothing is.
        tell: Called now and then with the share that is drawn, 0 to 1.
    """
    parts = [_notice(cut), _figures(series)]
    drawers: list[tuple[str, str, Callable[[Series], str]]] = [
        (
            'Rates of the hand',
            'What was asked for, dashed, and what the hand did, about and along its own axes.',
            panels.hand_rates,
        ),
        (
            'How much was followed',
            'The share F of the command; the margin, 0 at lock, its smallest marked; and the time '
            'lost so far.',
            panels.factor_and_margin,
        ),
        ('Limits at work', 'Those that were at work longest come first.', panels.limits),
        (
            'Rates of the joints',
            'Against what each may do, which the dotted lines are.',
            panels.joint_rates,
        ),
        ('Joints', 'Where they were told to be.', panels.positions),
        ("Way of the probe's tip", "In the forearm's axes.", panels.tip),
    ]
    drawn = [_closest(series)]
    for count, (title, caption, draw) in enumerate(drawers, 1):
        tell(count / (len(drawers) + 1))
        drawn.append(_figure(title, caption, draw(series)))
    parts += ['<div class="figures">', *drawn, '</div>', _told(series), _parameters(series)]
    tell(1.0)
    began = datetime.datetime.fromtimestamp(1e-9 * series.began).astimezone()
    name = series.resolver.name
    return PAGE.substitute(
        title=escape(f'{name}: {series.time[-1] + series.period:.1f} s'),
        where=f'{began:%Y-%m-%d %H:%M:%S}, <code>{escape(str(path))}</code>',
        style=STYLE,
        parts='\n'.join(filter(None, parts)),
        footer='Times are since the first step of the recording; SI units but where said.',
    )


def _notice(cut: str) -> str:
    return f'<p class="notice">{escape(cut)}</p>' if cut else ''


def _figures(series: Series) -> str:
    """Return what there is to say in numbers."""
    moving = float(np.count_nonzero(series.moving)) * series.period
    at = series.time[series.closest]
    rows = [
        (f'{moving:.1f} s', 'the hand was asked to move'),
        (f'{series.lost:.2f} s', 'lost by slowing down'),
        (f'{100.0 * series.followed:.0f} %', 'of the commanded rates was followed'),
        (f'{series.margin.min():.3f}', f'smallest margin, at {_clock(at)}'),
    ]
    worst = next(iter(series.limits_at_work().items()), None)
    if worst is not None:
        (joint, kind), spells = worst
        rows.append((f'{duration(spells):.1f} s', f'{joint} at its limit: {panels.WORDS[kind]}'))
    shown = ''.join(
        f'<div><dt>{escape(what)}</dt><dd>{escape(value)}</dd></div>' for value, what in rows
    )
    return f'<dl class="numbers">{shown}</dl>'


def _figure(title: str, caption: str, picture: str) -> str:
    if not picture:
        picture = '<p class="none">There was none.</p>'
    return (
        f'<figure><h2>{escape(title)}</h2>{picture}'
        f'<figcaption>{escape(caption)}</figcaption></figure>'
    )


def _closest(series: Series) -> str:
    row = series.closest
    picture = (
        '<img alt="The mechanism, drawn as it was closest to lock" '
        f'src="data:image/png;base64,{panels.mechanism(series)}">'
    )
    caption = (
        f'At {_clock(series.time[row])}, with a margin of {series.margin[row]:.3f}; the line is '
        "the way of the probe's tip."
    )
    return _figure('Closest to lock', caption, picture)


def _told(series: Series) -> str:
    """Return what the operator was told when."""
    told = list(_readable(series))
    rows = [''.join(_sentence(one) for one in told[:AT_ONCE])]
    if more := told[AT_ONCE:]:
        rest = ''.join(_sentence(one) for one in more)
        rows.append(
            f'</ol><details><summary>{len(more)} more</summary><ol class="told">{rest}</ol>'
            '</details><ol>'
        )
    return (
        '<section><h2>What the operator was told</h2>'
        f'<ol class="told">{"".join(rows)}</ol></section>'.replace('<ol></ol>', '')
    )


def _readable(series: Series) -> Iterator[Told]:
    """Yield what could be read; what stood before and after something shorter stood all along."""
    last: Told | None = None
    for one in series.told():
        if one.spell.end - one.spell.begin < READABLE:
            continue
        if last is not None and one[1:] == last[1:]:
            last = last._replace(spell=last.spell._replace(end=one.spell.end))
            continue
        if last is not None:
            yield last
        last = one
    if last is not None:
        yield last


def _sentence(told: Told) -> str:
    spell, state, sentence = told
    return (
        f'<li><time>{_clock(spell.begin)}</time> '
        f'<b class="state {_tone(state)}">{state.name}</b> '
        f'<span>{escape(sentence)} <i>{spell.end - spell.begin:.1f} s</i></span></li>'
    )


def _tone(state: WristState) -> str:
    if state in (WristState.FAULT, WristState.LIMITED, WristState.SINGULAR):
        return 'held'
    if state in (WristState.SCALED, WristState.STALE, WristState.WAITING):
        return 'slow'
    return 'free'


def _parameters(series: Series) -> str:
    rows = ''.join(f'<tr><th>{name}</th><td>{value}</td></tr>' for name, value in _values(series))
    return (
        '<section><details><summary>Parameters of the resolver</summary>'
        f'<table>{rows}</table></details></section>'
    )


def _values(series: Series) -> Iterator[tuple[str, str]]:
    for name, value in sorted(series.resolver.values.items()):
        values = value if isinstance(value, list) else [value]
        shown = ', '.join(f'{x:.6g}' if isinstance(x, float) else str(x) for x in values)
        yield escape(name), escape(shown)


def _clock(seconds: float) -> str:
    """Return a time as people read it: 75.3 s is 1:15.3."""
    minutes, rest = divmod(round(10.0 * seconds), 600)
    return f'{minutes}:{rest // 10:02d}.{rest % 10}'
