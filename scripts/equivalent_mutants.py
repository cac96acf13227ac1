"""Faults that are none: nothing that anybody could see changes, so no test can find them."""

from __future__ import annotations

from typing import NamedTuple


class Equivalent(NamedTuple):
    """One random fault that is not made.

    Attributes:
        file: Path below the package's folder.
        line: The whole line it would be in.
        before: The text that would be replaced.
        after: What would replace it.
        why: Why nobody could tell.
    """

    file: str
    line: str
    before: str
    after: str
    why: str


MANEUVERS = 'operating/maneuvers.py'
EQUIVALENT = (
    *(
        Equivalent(
            MANEUVERS,
            'x, y, z = (chance.gauss(0.0, 1.0) for _ in range(3))',
            '1.0',
            after,
            'a direction has no length',
        )
        for after in ('(10.0)', '(0.1)', '(2.0)')
    ),
    *(
        Equivalent(
            'operating/pilot.py',
            'self._share = 1.0',
            '1.0',
            after,
            'at the first order no time has been lost, and so the share is not looked at',
        )
        for after in ('(10.0)', '(0.1)', '(2.0)', '(0.0)', '(-1.0)')
    ),
    *(
        Equivalent('stewart/batch.py', line, before, after, 'a distance is the same both ways')
        for line, before, after in (
            (
                'followed = (np.abs(start[6]) > LOW) & (bound * (_distance(start, at) + error) '
                '<= BRANCH_LIMIT)',
                '_distance(start, at)',
                '(_distance(at, start))',
            ),
            (
                'for a, b in zip(one, other, strict=True):',
                'zip(one, other, strict=True)',
                '(zip(other, one, strict=True))',
            ),
        )
    ),
    Equivalent(
        'stewart/batch.py',
        'break',
        'break',
        'pass',
        'further steps where every row has ended cost time alone',
    ),
    Equivalent(
        'stewart/batch.py',
        'bound = np.where(slack > 0.0, bound / slack, math.inf)',
        'slack > 0.0',
        '(slack >= 0.0)',
        'what is divided by no slack is inf as well',
    ),
    *(
        Equivalent(
            'stewart/forward_kinematics.py',
            'CLEARLY_HIGH = 2.0 * tracking.LOW',
            before,
            after,
            'higher costs time alone',
        )
        for before, after in (
            ('2.0 * tracking.LOW', '(2.0 / tracking.LOW)'),
            ('2.0', '(20.0)'),
            ('2.0', '(3.0)'),
        )
    ),
    Equivalent(
        'stewart/forward_kinematics.py',
        'and self._hadamard_ratio(other.pose) * side > 0.0',
        'self._hadamard_ratio(other.pose) * side',
        '(self._hadamard_ratio(other.pose) / side)',
        'the sign of a quotient is that of the product',
    ),
    Equivalent(
        'stewart/forward_kinematics.py',
        'if impossible_pair(self.platform, self.base, lengths):',
        'impossible_pair(self.platform, self.base, lengths)',
        '(impossible_pair(self.base, self.platform, lengths))',
        'what it asks of the two platforms is the same of both',
    ),
    Equivalent(
        'stewart/forward_kinematics.py',
        'many = np.broadcast_to(np.asarray(lengths, dtype=float), (starts.shape[1], 6))',
        '1',
        '(-1)',
        'the second of two axes is the last',
    ),
    *(
        Equivalent(
            'stewart/general.py',
            'return (u2 * v3 - u3 * v2, u3 * v1 - u1 * v3, u1 * v2 - u2 * v1)',
            '(u2 * v3 - u3 * v2, u3 * v1 - u1 * v3, u1 * v2 - u2 * v1)',
            after,
            'a distance is the same in any order',
        )
        for after in (
            '(u3 * v1 - u1 * v3, u2 * v3 - u3 * v2, u1 * v2 - u2 * v1)',
            '(u2 * v3 - u3 * v2, u1 * v2 - u2 * v1, u3 * v1 - u1 * v3)',
        )
    ),
    Equivalent(
        'stewart/general.py',
        'done = left <= 0.125 * floor or floor > left > 0.5 * last',
        'left <= 0.125 * floor',
        '(left < 0.125 * floor)',
        'what is left is never just that, and one more correction would cost time alone',
    ),
    Equivalent(
        'stewart/quadratics.py',
        'radii = (p * p).sum(axis=1) + (b * b).sum(axis=1)',
        '1',
        '(-1)',
        'the second of two axes is the last',
    ),
    Equivalent(
        'stewart/quadratics.py',
        'weight = np.array([[1.0], [math.sqrt(2.0)], [math.sqrt(2.0)]])',
        '1.0',
        '(-1.0)',
        'a norm does not see a sign',
    ),
    Equivalent(
        'wrists/spare_joint.py',
        'bound = joint.upper if speed * determinant > 0.0 else joint.lower',
        'speed * determinant > 0.0',
        '(speed * determinant >= 0.0)',
        'a joint at rest nears neither limit, and what is left of it is not looked at',
    ),
    *(
        Equivalent(
            'wrists/pitch_yaw.py',
            'before = self.inverse(pose, (0.0, 0.0))',
            '0.0',
            after,
            'whole turns are taken off again',
        )
        for after in ('(1.0)', '(-1.0)')
    ),
    Equivalent(
        'resolving/platform_observer.py',
        'check_possible(kinematics.platform, kinematics.base, lengths, self._said(readings))',
        'check_possible(kinematics.platform, kinematics.base, lengths, self._said(readings))',
        '(check_possible(kinematics.base, kinematics.platform, lengths, self._said(readings)))',
        'two legs differ by no more than their anchors are apart, on either side',
    ),
    Equivalent(
        'resolving/supervisor.py',
        "self, *, stamp_time: float, receipt_time: float, withheld: str = '', pause: float = 0.0",
        '0.0',
        '(-1.0)',
        'a pause counts only when it is long',
    ),
    Equivalent(
        'resolving/easing.py',
        'POWERS = (0.25, 4.0)',
        '0.25',
        '(0.025)',
        'joints go with a root of the factor at the least, so that only rounding comes this low',
    ),
    Equivalent(
        'wrists/roll_pitch_roll.py',
        'Rod((-FORK, -side, 0.0), (-FORK, side, 0.0)),',
        'Rod((-FORK, -side, 0.0), (-FORK, side, 0.0))',
        '(Rod((-FORK, side, 0.0), (-FORK, -side, 0.0)))',
        'a bar looks the same from either end',
    ),
    Equivalent(
        'wrists/double_hooke.py',
        'if math.hypot(a1, a4) > LOCK:',
        'math.hypot(a1, a4) > LOCK',
        '(math.hypot(a1, a4) >= LOCK)',
        'nothing is ever exactly at this distance from lock',
    ),
    *(
        Equivalent(
            'resolving/supervisor.py',
            'self._home_speed, self._share = 0.0, 1.0',
            '1.0',
            after,
            'until something moves, the share is one of nothing',
        )
        for after in ('(0.1)', '(10.0)', '(-1.0)', '(2.0)', '(0.0)')
    ),
    *(
        Equivalent(
            'wrists/omni_wrist.py',
            'THETA_BOW, PSI_BOW, SLOT = 0.5, 0.6, 0.007',
            number,
            f'(-{number})',
            'a bow looks the same from either end, and a slot from either side',
        )
        for number in ('0.5', '0.6', '0.007')
    ),
)
