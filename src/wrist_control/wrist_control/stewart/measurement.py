"""What is asked of measured leg lengths, and what their noise and rates mean for the platform."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import combinations

import numpy as np

from wrist_control.errors import InvalidValueError
from wrist_control.rotations import Pose
from wrist_control.stewart.geometry import Anchors, Line

# Lengths may miss the triangle inequality by this share: readings in whole nanometres of a metre
# are not refused for their last digit, and what is further off is named and not searched for.
SLACK = 1e-9


def check_lengths(lengths: Sequence[float]) -> None:
    """Refuse what cannot be six leg lengths, m.

    Raises:
        InvalidValueError: The text names the leg and says what is valid.
    """
    if len(lengths) != 6:
        raise InvalidValueError(f'There are {len(lengths)} leg lengths; give 6, m.')
    for leg, value in enumerate(lengths, start=1):
        if not (math.isfinite(value) and value > 0.0):
            raise InvalidValueError(
                f'The length of leg_{leg} is {value}; it must be finite and above 0 m.'
            )


def impossible_pair(
    platform: Anchors, base: Anchors, lengths: Sequence[float]
) -> tuple[int, int] | None:
    """Return two legs, 1 to 6, whose lengths no pose can have, by the triangle inequality.

    |l_i − l_j| ≤ |b_i − b_j| + |p_i − p_j| at every pose, and l_i + l_j + |p_i − p_j| is at
    least |b_i − b_j|, and the same with the platforms exchanged.
    """
    for i, j in combinations(range(6), 2):
        low, high = sorted((math.dist(platform[i], platform[j]), math.dist(base[i], base[j])))
        slack = SLACK * (lengths[i] + lengths[j] + high)
        if abs(lengths[i] - lengths[j]) > low + high + slack:
            return (i + 1, j + 1)
        if lengths[i] + lengths[j] + low < high - slack:
            return (i + 1, j + 1)
    return None


def check_possible(
    platform: Anchors, base: Anchors, lengths: Sequence[float], said: Sequence[str]
) -> None:
    """Refuse lengths that no pose can have.

    Args:
        platform: Anchors in platform axes, m.
        base: Anchors in base axes, m.
        lengths: m.
        said: What to call the reading of each in an error, with its value.

    Raises:
        InvalidValueError: The text names two that contradict each other.
    """
    pair = impossible_pair(platform, base, lengths)
    if pair:
        one, other = (said[number - 1] for number in pair)
        raise InvalidValueError(f'{one} and {other} fit no pose together; check their readings.')


def check_jump(
    readings: Sequence[float],
    before: Sequence[float],
    dt: float,
    fastest: float,
    drive: str = 'leg',
    unit: str = 'm',
) -> None:
    """Refuse readings that lie further from those before than the joints can move.

    Args:
        readings: m, or rad.
        before: The last good ones.
        dt: Time between the two, s.
        fastest: The fastest that a joint moves, m/s or rad/s.
        drive: What a joint is called, without its number.
        unit: What readings are in.

    Raises:
        InvalidValueError: The text names the joint and how far it jumped.
    """
    for number, (new, old) in enumerate(zip(readings, before, strict=True), start=1):
        if abs(new - old) > fastest * dt:
            raise InvalidValueError(
                f'{drive}_{number} jumped by {new - old:g} {unit} in {dt:g} s; at {fastest:g} '
                f'{unit}/s it moves {fastest * dt:g} {unit} at most.'
            )


def pose_covariance(
    lines: Sequence[Line], pose: Pose, length_noise: float | Sequence[float]
) -> np.ndarray:
    """Return the covariance of a pose, J Σ Jᵀ, shape (6, 6): x, y, z, and turns about x, y, z.

    All in base axes, m² and rad², in the order that ROS asks for.

    Args:
        lines: How each leg grows with the platform's twist, platform axes (`geometry.line`).
        pose: The pose.
        length_noise: Standard deviation of the length readings, m, one for all or one per leg.

    Raises:
        InvalidValueError: Noise that is not finite and 0 or more, or a pose at lock.
    """
    sigma = np.broadcast_to(np.asarray(length_noise, dtype=float), 6)
    if not (np.isfinite(sigma).all() and (sigma >= 0.0).all()):
        raise InvalidValueError(
            f'length_noise is {length_noise}; give finite values of 0 m or more, one or six.'
        )
    to_base = np.kron(np.eye(2), pose.rotation.T)
    spread = to_base @ _inverse(lines) * sigma
    covariance: np.ndarray = spread @ spread.T
    return covariance


def platform_twist(lines: Sequence[Line], rates: Sequence[float]) -> tuple[float, ...]:
    """Return (vx, vy, vz, p, q, r) of the platform in its own axes, from leg rates in m/s.

    Raises:
        InvalidValueError: A pose at lock, where leg rates do not tell the twist.
    """
    return tuple(float(x) for x in _inverse(lines) @ np.asarray(rates, dtype=float))


def _inverse(lines: Sequence[Line]) -> np.ndarray:
    try:
        return np.linalg.inv(np.array(lines))
    except np.linalg.LinAlgError as error:
        raise InvalidValueError(
            'The platform is at lock, where leg lengths do not tell its motion; move it away.'
        ) from error
