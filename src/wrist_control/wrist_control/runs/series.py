"""A run as arrays, one row for each step."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from wrist_control.bags.run import Run, numbers, stamp_of, twist_of
from wrist_control.errors import InvalidValueError
from wrist_control.resolving.limits import LimitKind
from wrist_control.resolving.report import WristState
from wrist_control.resolving.witness import positions_of
from wrist_control.rotations import Pose
from wrist_control.runs.resolver import Resolver, first_resolver
from wrist_control.wrists.wrist import Configuration, Positions

# Steps further apart than this many periods are two runs with a gap between them.
GAP = 5.0


class Spell(NamedTuple):
    """A time during which the same was so.

    Attributes:
        begin: s from the beginning.
        end: s.
    """

    begin: float
    end: float


class Told(NamedTuple):
    """One sentence that the operator was told, and for how long."""

    spell: Spell
    state: WristState
    sentence: str


@dataclass(frozen=True)
class Series:
    """What a resolver said at each step, n of them.

    Attributes:
        resolver: What it was.
        began: When the first step was, ns.
        time: s since then, shape (n,).
        commanded: (vx, vy, vz, p, q, r) that were asked for, hand axes, shape (n, 6).
        achieved: The same that were made, shape (n, 6).
        scale_factor: F, shape (n,).
        time_lost: s, shape (n,).
        margin: Shape (n,).
        states: One `WristState` for each step.
        sentences: What the operator was told, one for each step.
        limits: The limits at work in each step, by joint and kind.
        positions: Joint positions, rad or m, shape (n, joints).
        joint_rates: rad/s or m/s, shape (n, joints).
        poses: Where the hand was before each step.
        tip: The probe's tip in forearm axes, m, shape (n, 3).
    """

    resolver: Resolver
    began: int
    time: np.ndarray
    commanded: np.ndarray
    achieved: np.ndarray
    scale_factor: np.ndarray
    time_lost: np.ndarray
    margin: np.ndarray
    states: list[WristState]
    sentences: list[str]
    limits: list[list[tuple[str, LimitKind]]]
    positions: np.ndarray
    joint_rates: np.ndarray
    poses: list[Pose]
    tip: np.ndarray

    @property
    def period(self) -> float:
        """Time between two steps, s."""
        return self.resolver.settings.dt

    @property
    def lost(self) -> float:
        """The time that was lost in all, s; a reset begins anew from zero."""
        return float(np.clip(np.diff(self.time_lost, prepend=self.time_lost[0]), 0.0, None).sum())

    @property
    def moving(self) -> np.ndarray:
        """Whether the hand was asked to move, or moved, shape (n,)."""
        return np.asarray(np.any(self.commanded, axis=1) | np.any(self.achieved, axis=1))

    @property
    def followed(self) -> float:
        """The mean of F while something was asked for."""
        asked = np.any(self.commanded, axis=1)
        return float(self.scale_factor[asked].mean()) if asked.any() else 1.0

    @property
    def closest(self) -> int:
        """The step that was closest to lock."""
        return int(self.margin.argmin())

    def configuration(self, row: int) -> Positions:
        """Return the joint positions of a step with the pose that they hold, where that counts."""
        wrist, positions = self.resolver.wrist, tuple(self.positions[row].tolist())
        several = isinstance(wrist.home, Configuration)
        return positions_of(wrist, positions, self.poses[row], several)

    def told(self) -> Iterator[Told]:
        """Yield what the operator was told, each sentence once for as long as it stood."""
        begin = 0
        for row in range(1, len(self.time) + 1):
            if row == len(self.time) or self._said(row) != self._said(begin):
                end = self.time[row] if row < len(self.time) else self.time[-1] + self.period
                yield Told(Spell(float(self.time[begin]), float(end)), *self._said(begin))
                begin = row

    def _said(self, row: int) -> tuple[WristState, str]:
        return self.states[row], self.sentences[row]

    def limits_at_work(self) -> dict[tuple[str, LimitKind], list[Spell]]:
        """Return when each limit was at work, the one that was longest first."""
        found: dict[tuple[str, LimitKind], list[Spell]] = {}
        for when, limits in zip(self.time.tolist(), self.limits, strict=True):
            for limit in limits:
                spells = found.setdefault(limit, [])
                end = when + self.period
                if spells and when - spells[-1].end < GAP * self.period:
                    spells[-1] = spells[-1]._replace(end=end)
                else:
                    spells.append(Spell(when, end))
        return dict(sorted(found.items(), key=lambda item: -duration(item[1])))


def duration(spells: list[Spell]) -> float:
    """Return how long spells are together, s."""
    return sum(spell.end - spell.begin for spell in spells)


def series(run: Run) -> Series:
    """Return a run as arrays.

    Raises:
        InvalidValueError: It has no step, or its wrist is not known here.
    """
    resolver = first_resolver(run)
    inputs = {stamp_of(one): one for _, one in run.messages('step_inputs')}
    told = {stamp_of(one): one for _, one in run.messages('joint_command')}
    statuses = [one for _, one in run.messages('wrist_status') if stamp_of(one) in inputs]
    joints = len(resolver.wrist.joints)
    if not statuses or any(len(one.positions) != joints for one in inputs.values()):
        raise InvalidValueError(
            f'{run.path} has no step of a {resolver.name}; record it while its resolver runs.'
        )
    stamps = [stamp_of(one) for one in statuses]
    steps = [inputs[stamp] for stamp in stamps]
    poses = [pose_of(one) for one in steps]
    still = (0.0,) * joints
    return Series(
        resolver=resolver,
        began=stamps[0],
        time=1e-9 * np.array([stamp - stamps[0] for stamp in stamps], dtype=float),
        commanded=np.array([twist_of(one.commanded) for one in statuses]),
        achieved=np.array([twist_of(one.achieved) for one in statuses]),
        scale_factor=np.array([one.scale_factor for one in statuses], dtype=float),
        time_lost=np.array([one.time_lost for one in statuses], dtype=float),
        margin=np.array([one.margin for one in statuses], dtype=float),
        states=[WristState(int(one.state)) for one in statuses],
        sentences=[str(one.message) for one in statuses],
        limits=[[(str(x.joint), LimitKind(int(x.kind))) for x in s.limits] for s in statuses],
        positions=np.array([numbers(one.positions) for one in steps]),
        joint_rates=np.array(
            [numbers(told[stamp].velocity) if stamp in told else still for stamp in stamps]
        ),
        poses=poses,
        tip=np.array([pose.point(resolver.wrist.probe) for pose in poses]),
    )


def pose_of(inputs: Any) -> Pose:
    """Return where the hand was before a step."""
    x, y, z, a1, a2, a3, a4 = numbers(inputs.pose)
    return Pose((a1, a2, a3, a4), (x, y, z))
