"""Fly a maneuver with the resolver step alone, as fast as it goes: no ROS, no clock."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from wrist_control.errors import InvalidValueError
from wrist_control.operating.maneuvers import ZERO_RATES, Maneuver, make_maneuver
from wrist_control.operating.pilot import ManeuverClock
from wrist_control.resolving import State, Step, start, step
from wrist_control.resolving.state import ZERO_TWIST
from wrist_control.rotations import Pose, Vector, to_forearm
from wrist_control.wrists import Wrist, make_wrist
from wrist_control.wrists.body import ALONG_X


class Row(NamedTuple):
    """One step of a flight: where it starts, and what it does.

    Attributes:
        positions: Joint positions at its start, rad or m.
        pose: The hand's pose at its start.
        command: Commanded p, q, r, rad/s.
        achieved: The twist really made, (vx, vy, vz, p, q, r) in hand axes.
        joint_rates: The real increments over the step, rad/s or m/s.
        scale_factor: F.
        time_lost: Integral of 1 − F up to its start, s.
        margin: How far from singular at its start.
        limited: Names of the joints and limits at work.
    """

    positions: Sequence[float]
    pose: Pose
    command: Sequence[float]
    achieved: Sequence[float]
    joint_rates: Sequence[float]
    scale_factor: float
    time_lost: float
    margin: float
    limited: tuple[str, ...]


@dataclass(frozen=True)
class Flight:
    """A flight as arrays over time; n rows, one at each step's start and one at the end.

    What a row says of rates, scale factor and limits holds from its time to the next row's.

    Attributes:
        wrist: The mechanism that flew.
        maneuver: What it was asked to do.
        time: s, shape (n,).
        command: Commanded p, q, r, rad/s, shape (n, 3).
        achieved: The twist really made, (vx, vy, vz, p, q, r) in hand axes, shape (n, 6).
        joint_positions: rad or m, shape (n, joints).
        joint_rates: The real increments over each step, rad/s or m/s, shape (n, joints).
        hand_rotation: C, forearm axes to hand axes, shape (n, 3, 3).
        hand_position: Origin of the hand in forearm axes, m, shape (n, 3).
        tip: End of the probe in forearm axes, m, shape (n, 3).
        scale_factor: F, shape (n,).
        time_lost: Integral of 1 − F up to each row, s, shape (n,).
        margin: How far from singular, shape (n,).
        limited: Names of the joints and limits at work, n tuples.
        completed: False when the hand could not finish what the maneuver asked for.
    """

    wrist: Wrist
    maneuver: Maneuver
    time: np.ndarray
    command: np.ndarray
    achieved: np.ndarray
    joint_positions: np.ndarray
    joint_rates: np.ndarray
    hand_rotation: np.ndarray
    hand_position: np.ndarray
    tip: np.ndarray
    scale_factor: np.ndarray
    time_lost: np.ndarray
    margin: np.ndarray
    limited: tuple[tuple[str, ...], ...]
    completed: bool

    @classmethod
    def from_rows(
        cls,
        wrist: Wrist,
        maneuver: Maneuver,
        dt: float,
        rows: Sequence[Row],
        *,
        probe: Vector = ALONG_X,
        completed: bool = True,
    ) -> Flight:
        """Return a flight of equal steps.

        Args:
            wrist: The mechanism that flew.
            maneuver: What it was asked to do.
            dt: Duration of each step, s.
            rows: The steps, in order.
            probe: End of the probe in hand axes, m.
            completed: False when the hand could not finish.
        """
        poses = [row.pose for row in rows]
        where = np.array([pose.position for pose in poses])
        return cls(
            wrist=wrist,
            maneuver=maneuver,
            time=dt * np.arange(len(rows)),
            command=np.array([row.command for row in rows]),
            achieved=np.array([row.achieved for row in rows]),
            joint_positions=np.array([tuple(row.positions) for row in rows]),
            joint_rates=np.array([row.joint_rates for row in rows]),
            hand_rotation=np.array([pose.rotation for pose in poses]),
            hand_position=where,
            tip=where + np.array([to_forearm(pose.quaternion, probe) for pose in poses]),
            scale_factor=np.array([row.scale_factor for row in rows]),
            time_lost=np.array([row.time_lost for row in rows]),
            margin=np.array([row.margin for row in rows]),
            limited=tuple(row.limited for row in rows),
            completed=completed,
        )


def fly(
    wrist: Wrist | str,
    maneuver: Maneuver | str = 'basic_test',
    rate: float = 32.0,
    joint_rate_limits: float | Sequence[float] | None = None,
    *,
    joint_acceleration_limits: float | Sequence[float] | None = None,
    joint_deceleration_limits: float | Sequence[float] | None = None,
    initial_positions: Sequence[float] | None = None,
    probe: Vector = ALONG_X,
    patience: float = 30.0,
    progress: Callable[[float], object] | None = None,
    **dimensions: Any,
) -> Flight:
    """Fly a maneuver and return what happened.

    Args:
        wrist: A wrist, or the name of one.
        maneuver: A maneuver, or the name of one at Barker's 32 deg/s.
        rate: Steps per second.
        joint_rate_limits: rad/s or m/s, one for all joints or one for each; the wrist's own
            when not given, which are none unless it was made with some.
        joint_acceleration_limits: rad/s² or m/s², how quickly joints may become faster; as the
            wrist's own when not given, which are none unless it was made with some. With limits
            the flight goes on after the maneuver until the joints are at rest.
        joint_deceleration_limits: How quickly they may become slower; as quickly as faster when
            not given.
        initial_positions: Where the joints start, rad or m; the wrist's home when not given.
        probe: End of the probe in hand axes, m.
        patience: Seconds the hand may lose in all before the flight is given up.
        progress: Called after each step with the share of the maneuver that is done.
        dimensions: Parameters of the wrist, when it is given by name.

    Raises:
        InvalidValueError: A value that cannot be used.
    """
    if isinstance(wrist, str):
        wrist = make_wrist(wrist, **dimensions)
    elif dimensions:
        raise InvalidValueError(
            f'{", ".join(dimensions)} can only be given with the name of a wrist.'
        )
    if isinstance(maneuver, str):
        maneuver = make_maneuver(maneuver)
    if not (math.isfinite(rate) and rate > 0.0):
        raise InvalidValueError(f'rate is {rate}; it must be finite and above 0 steps/s.')
    if joint_deceleration_limits is None:
        joint_deceleration_limits = joint_acceleration_limits
    wrist = wrist.with_limits(
        rates=joint_rate_limits,
        accelerations=joint_acceleration_limits,
        decelerations=joint_deceleration_limits,
    )
    rows, completed = _rows(
        wrist, maneuver, start(wrist, initial_positions), 1.0 / rate, patience, progress
    )
    return Flight.from_rows(
        wrist,
        maneuver,
        1.0 / rate,
        [_row(*sample) for sample in rows],
        probe=probe,
        completed=completed,
    )


Sample = tuple[State, Vector, Step]


def _rows(
    wrist: Wrist,
    maneuver: Maneuver,
    state: State,
    dt: float,
    patience: float,
    progress: Callable[[float], object] | None,
) -> tuple[list[Sample], bool]:
    rows: list[Sample] = []
    linear = (0.0,) * (wrist.twist_size - 3)
    clock = ManeuverClock(maneuver, dt)
    while state.time_lost <= patience:
        order = clock.order(len(rows) * dt, state.time_lost)
        if clock.done:
            return rows + _coming_to_rest(wrist, state, dt), True
        taken = step(wrist, state, (*linear, *order.rates), dt)
        rows.append((state, order.rates, taken))
        lost = taken.state.time_lost - state.time_lost
        clock.follow(order, dt - lost)
        state = taken.state
        if progress is not None:
            progress(min(1.0, clock.time / maneuver.duration))
    return rows + _coming_to_rest(wrist, state, dt), False


def _coming_to_rest(wrist: Wrist, state: State, dt: float) -> list[Sample]:
    rows = []
    while True:
        taken = step(wrist, state, ZERO_TWIST, dt)
        rows.append((state, ZERO_RATES, taken))
        if not any(taken.joint_rates):
            return rows
        state = taken.state


def _row(state: State, command: Vector, taken: Step) -> Row:
    return Row(
        positions=state.positions,
        pose=state.pose,
        command=command,
        achieved=taken.achieved,
        joint_rates=taken.joint_rates,
        scale_factor=taken.scale_factor,
        time_lost=state.time_lost,
        margin=taken.margin,
        limited=tuple(limit.joint for limit in taken.limits),
    )
