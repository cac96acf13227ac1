"""The library's part of the campaign: which wrist is attacked how often, on all cores."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from typing import NamedTuple

from hostile import steps, supervised
from hostile.verdict import Verdict
from wrist_control.wrists import WRISTS

# The share of the supervisor; the other kinds of flights have the rest in equal parts.
SUPERVISED = 0.25
# Steps of one wrist against those of the others: a platform that searches its assemblies takes a
# hundred times as long as a chain of gimbals.
SHARES = {'stewart': 0.15, 'rotary_stewart': 0.05}
# Steps of one part: what is done in one go.
PART = 4000


class Part(NamedTuple):
    """What one process does in one go.

    Attributes:
        wrist: One of the registered wrists.
        kind: Number of the kind of flights; None for the supervisor.
        length: How many steps.
        seed: The campaign's, and the numbers of wrist, kind and part.
    """

    wrist: str
    kind: int | None
    length: int
    seed: tuple[int, ...]

    def run(self) -> list[Verdict]:
        """Attack, and return what was found."""
        if self.kind is None:
            return supervised.attack(self.wrist, self.length, self.seed)
        return steps.attack(self.wrist, steps.KINDS[self.kind], self.length, self.seed)


def parts(total: int, seed: int) -> list[Part]:
    """Return the parts of a campaign, the slowest wrist first.

    Args:
        total: How many steps of all wrists together, at least.
        seed: Chooses everything.
    """
    shares = {name: SHARES.get(name, 1.0) for name in WRISTS}
    kinds: list[tuple[int | None, float]] = [(None, SUPERVISED)]
    each = (1.0 - SUPERVISED) / len(steps.KINDS)
    kinds += [(number, each) for number in range(len(steps.KINDS))]
    found = []
    for wrist, name in enumerate(sorted(WRISTS, key=lambda one: shares[one])):
        for kind, share in kinds:
            left = int(total * share * shares[name] / sum(shares.values())) + 1
            number = -1 if kind is None else kind
            for part in range(0, left, PART):
                length = min(PART, left - part)
                found.append(Part(name, kind, length, (seed, wrist, number + 1, part)))
    return found


def verdicts(
    total: int, seed: int, workers: int, progress: Callable[[int], object]
) -> list[Verdict]:
    """Attack every wrist, and return a row for each kind of attack.

    Args:
        total: How many steps of all wrists together, at least.
        seed: Chooses everything.
        workers: How many processes do it.
        progress: Told of every part how many steps were made.
    """
    rows: dict[str, Verdict] = {
        attack: Verdict(attack)
        for attack in (*(kind.attack for kind in steps.KINDS), steps.REFUSED, supervised.ATTACK)
    }
    for found in _made(parts(total, seed), workers):
        for verdict in found:
            rows[verdict.attack].add(verdict)
        progress(sum(verdict.count for verdict in found))
    return [*rows.values()]


def _made(todo: list[Part], workers: int) -> Iterator[list[Verdict]]:
    if workers < 2:
        yield from (part.run() for part in todo)
        return
    with ProcessPoolExecutor(workers) as pool:
        futures = [pool.submit(Part.run, part) for part in todo]
        try:
            for future in as_completed(futures):
                yield future.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
