"""Where wrists are attacked, and within which limits."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from wrist_control.testing.held import beside_locks
from wrist_control.testing.places import Random, regular_places
from wrist_control.wrists import Wrist, make_wrist
from wrist_control.wrists.wrist import Positions

# How many regular places of a wrist are used over and over again.
REGULAR = 60
# Rates, rad/s and m/s, and how far from the start the limits lie at most, rad and m.
SPEED = {'revolute': 0.56, 'prismatic': 0.05}
SPACE = {'revolute': 2.0, 'prismatic': 0.1}
# The shortest and the longest time to full speed, or from there to a stop, s.
QUICK, SLOW = 0.01, 1.0


@lru_cache
def places(name: str, seed: int) -> tuple[list[Positions], list[Positions]]:
    """Return places all over the workspace of a wrist, and places beside its locks.

    Args:
        name: One of the registered wrists.
        seed: Chooses them.
    """
    wrist, random = make_wrist(name), np.random.default_rng(seed)
    regular = list(regular_places(wrist, random, REGULAR))
    return regular, [*beside_locks(wrist, random)] or regular


def with_hostile_limits(
    wrist: Wrist, positions: Positions, random: Random, *, at_limits: bool, eased: bool
) -> Wrist:
    """Return a wrist with limits around a place.

    Args:
        wrist: The mechanism.
        positions: Where it will start, rad or m.
        random: Chooses the limits.
        at_limits: Whether joints start on their limits.
        eased: Whether joints need time to change their rates.
    """
    count = len(wrist.joints)
    rates = np.array([SPEED[joint.kind] for joint in wrist.joints])
    rates *= 10.0 ** random.uniform(-1.0, 1.0, size=count)
    limited = wrist.with_limits(rates=rates.tolist())
    if at_limits:
        limited = _in_a_box(limited, positions, random)
    if eased:
        times = 10.0 ** random.uniform(math.log10(QUICK), math.log10(SLOW), size=(2, count))
        faster, slower = (rates / times).tolist()
        if random.random() < 0.1:  # one joint that may change its rate at once
            free = int(random.integers(count))
            faster[free] = slower[free] = math.inf
        limited = limited.with_limits(accelerations=faster, decelerations=slower)
    return limited


def _in_a_box(wrist: Wrist, positions: Positions, random: Random) -> Wrist:
    """Return a wrist whose joints may move little, about half of them starting on a limit."""
    space = np.array([SPACE[joint.kind] for joint in wrist.joints])
    here, away = np.array(list(positions)), random.uniform(0.0, 1.0, size=(2, len(space)))
    away[0] *= random.random(len(space)) < 0.7
    away[1] = np.where(away[0] > 0.0, away[1] * (random.random(len(space)) < 0.7), away[1])
    away[1] = np.maximum(away[1], 1e-6 * (away[0] == 0.0))
    own = np.array([(joint.lower, joint.upper) for joint in wrist.joints]).T
    lower = np.maximum(here - space * away[0], own[0])
    upper = np.minimum(here + space * away[1], own[1])
    return wrist.with_limits(
        lower=np.minimum(lower, here).tolist(), upper=np.maximum(upper, here + 1e-12).tolist()
    )
