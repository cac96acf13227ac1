"""Along the branch of a pose, however long the way: stages, each with its proof."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from wrist_control.rotations import Pose, quaternion_of, unit
from wrist_control.stewart.certificate import Proof, make_tuple
from wrist_control.stewart.quadratics import Nine, Number, Six, Three

# Where a proof can hold, Newton's steps end after five at most; a search from afar takes up to 12
# for every pose that it finds. More are harmless, and cost a search their time.
MOST_CORRECTIONS = 12
# The quaternion's first row loses digits as 2 / √trace, which is √8 here: POSE_ERROR rests on it.
# Above 1 would be as good and slower, as the other way to a quaternion takes twice the time.
SMALLEST_TRACE = 0.5
# Ways across the workspace take up to 390. More are harmless: SHORTEST_STAGE ends what cannot be.
MOST_STAGES = 400
# Close to lock the pose goes like the root of what is left, and stages shrink with it. At 1e-3
# one way in ten is given up that goes round a lock; at 1e-5 there is hardly one more, and those
# that end at a lock take half as long again.
SHORTEST_STAGE = 1e-4

Unknowns = Nine[float]
Four = tuple[Number, Number, Number, Number]


class Tangent(NamedTuple):
    """Where the equations were linearised, and Newton's inverse there.

    Attributes:
        origin: The unknowns there.
        inverse: Of a planar platform `quadratics.newton_inverse`, of any other
            `general.Linearisation.inverse`.
    """

    origin: Unknowns
    inverse: Any


class Track(NamedTuple):
    """Where a root was followed to; lengths are shares of the characteristic length.

    Attributes:
        at: The unknowns at the end.
        iterations: Corrections made on the way.
        proof: What is proved around `at`.
        followed: True when the root at `at` is proved to be the one that the start leads to.
        tangent: The equations' last linearisation, where the solver can start from one.
    """

    at: Unknowns
    iterations: int
    proof: Proof
    followed: bool
    tangent: Tangent | None = None


Solve = Callable[[Six[float], Unknowns], 'Track | None']
Own = Callable[[Unknowns], Six[float]]


def follow(
    solve: Solve, own: Own, goal: Six[float], start: Unknowns
) -> tuple[Track | None, Unknowns]:
    """Follow the root at a pose to where the squares of the lengths go straight to a goal.

    A step is proved from its end: where (S11) of docs/equations.md holds between two poses, every
    set of lengths on the straight way back has exactly one root near the end, and the start is the
    last of them. A longer way is made in stages.

    Args:
        solve: Solves for a goal from a start, in one go.
        own: What goal the lengths at an assembled pose are.
        goal: Any six numbers that are linear in the squared lengths.
        start: An assembled pose; its own lengths are where the way begins.

    Returns:
        The root, which is not `followed` where the way meets a lock or a place where the solver
        cannot go, and None where there is not even that; and how far the way was followed.
    """
    direct = solve(goal, start)
    if direct is not None and direct.followed:
        return direct, direct.at
    share, iterations, origin = 0.5, 0, own(start)
    for _ in range(MOST_STAGES):
        track = solve(between(origin, goal, share), start)
        if track is None or not track.followed:
            share *= 0.5
            if share < SHORTEST_STAGE:
                break
            continue
        start, iterations = track.at, iterations + track.iterations
        if share == 1.0:
            return track._replace(iterations=iterations), start
        origin = own(start)
        # Half as long again as the last, of a rest that is shorter: any growth will do.
        share = min(1.0, 1.5 * share / (1.0 - share))
    return direct, start


def between(start: Six[float], goal: Six[float], share: float) -> Six[float]:
    """Return the goal at a share of the way."""
    if share == 1.0:
        return goal
    a, b, c, d, e, f = (old + share * (new - old) for old, new in zip(start, goal, strict=True))
    return (a, b, c, d, e, f)


def unknowns(pose: tuple[Four[Number], Three[Number]], size: float) -> Nine[Number]:
    """Return the unknowns at a pose, or as arrays at a quaternion and a position of arrays.

    The first two rows of `rotations.direction_cosines`, without the third.
    """
    (a1, a2, a3, a4), (x, y, z) = pose
    s1, s2, s3, s4 = a1 * a1, a2 * a2, a3 * a3, a4 * a4
    d2, d3, d4 = a2 + a2, a3 + a3, a4 + a4
    a12, a13, a14, a23, a24, a34 = d2 * a1, d3 * a1, d4 * a1, d2 * a3, d2 * a4, d3 * a4
    u1, u2, u3 = s1 - s2 - s3 + s4, a34 + a12, a24 - a13
    v1, v2, v3 = a34 - a12, s1 - s2 + s3 - s4, a23 + a14
    return (x / size, y / size, u1, v1, u2, v2, z / size, u3, v3)


def pose_of(at: Unknowns, size: float) -> Pose:
    """Return the pose of the unknowns."""
    x, y, u1, v1, u2, v2, z, u3, v3 = at
    w1, w2, w3 = u2 * v3 - u3 * v2, u3 * v1 - u1 * v3, u1 * v2 - u2 * v1
    trace = 1.0 + u1 + v2 + w3
    if trace > SMALLEST_TRACE:
        quaternion = unit((trace, u2 - v1, w1 - u3, v3 - w2))
    else:
        quaternion = quaternion_of(((u1, u2, u3), (v1, v2, v3), (w1, w2, w3)))
    return make_tuple(Pose, (quaternion, (x * size, y * size, z * size)))
