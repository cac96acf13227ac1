"""Long ways and searches: how far stages follow a pose, and what seeds find."""

import math
from functools import partial

import numpy as np

from wrist_control.rotations import IDENTITY, Pose, turned, unit
from wrist_control.stewart import assembly, general, quadratics, stages, tracking
from wrist_control.stewart.forward_kinematics import Status

from .platforms import CROOKED, FK, SIZE, WRIST, apart, lengths_of, random_poses


def test_seeds_find_what_they_found_when_they_were_chosen():
    """Poses that fit sixty sets of lengths, no two of them alike."""
    found = [FK.assemblies(lengths_of(pose)) for pose in random_poses(60, 0.15, 1.0)]
    assert sum(map(len, found)) >= 153


def by_chance(lengths, rng, starts=70):
    """Return the poses above the base that six legs at a time find from starts anywhere."""
    platforms = general.scaled(WRIST.platform, WRIST.base, SIZE)
    goal, found = general.squares(platforms, lengths), []
    for _ in range(starts):
        x, y = rng.uniform(-0.2, 0.2, 2).tolist()
        start = Pose(unit(tuple(rng.normal(size=4).tolist())), (x, y, rng.uniform(0.05, 0.55)))
        track = general.solve_general(platforms, goal, stages.unknowns(start, SIZE))
        if track is not None and track.at[6] > 0.0:
            found.append(track)
    return [stages.pose_of(track.at, SIZE) for track in assembly.different(found)]


def test_a_search_misses_hardly_a_pose_that_seventy_solves_from_anywhere_find():
    """Another solver, and seeds that share nothing: what it finds beyond is one pose in forty."""
    rng, known, missed = np.random.default_rng(4), 0, 0
    for pose in random_poses(25, 0.1, 0.6, seed=8):
        lengths = lengths_of(pose)
        found = [one.pose for one in FK.assemblies(lengths)]
        for other in by_chance(lengths, rng):
            known += 1
            missed += all(apart(one, other) > 1e-6 for one in found)
    assert known > 30
    assert missed <= 0.04 * known


def test_a_low_and_overturned_pose_is_found_from_anywhere_around():
    """Where z is 6 % of the size the quadratics do not lead: six legs at a time do."""
    missed = 0
    for angle in np.linspace(0.0, math.tau, 12, endpoint=False).tolist():
        axis = (1.85 * math.cos(angle), 1.85 * math.sin(angle), 0.0)
        x, y, z = 0.02, -0.01, 0.06 * SIZE
        low = Pose(turned(IDENTITY, axis, 1.0), (x, y, z))
        found = [one.pose for one in FK.assemblies(lengths_of(low))]
        missed += all(apart(one, low) > 1e-6 for one in found)
    assert missed == 0


def test_seeds_at_several_heights_find_the_poses_of_any_platform():
    fk = CROOKED.forward_kinematics
    found = [
        fk.assemblies(lengths_of(pose, CROOKED)) for pose in random_poses(4, 0.12, 0.8, seed=4)
    ]
    assert sum(map(len, found)) >= 12


def test_ways_across_the_workspace_are_followed_to_their_end():
    """From one corner to another: a hundred stages and more, and past locks at a close."""
    ends = random_poses(80, 0.15, 1.0)
    solved = [
        FK.solve(lengths_of(goal), start).status
        for start, goal in zip(ends[::2], ends[1::2], strict=True)
    ]
    assert solved.count(Status.CONVERGED) >= 32


def test_a_way_in_stages_tells_the_corrections_of_all_of_them():
    goal, start = random_poses(2, 0.15, 1.0, seed=1)
    made = []

    def solve(right, before):
        track = tracking.solve_planar(FK.planar, right, before)
        if track is not None and track.followed:
            made.append(track.iterations)
        return track

    track, end = stages.follow(
        solve,
        partial(quadratics.right_side_at, FK.planar),
        quadratics.right_side(FK.planar, lengths_of(goal)),
        stages.unknowns(start, SIZE),
    )
    assert track.followed
    assert track.at == end
    assert len(made) > 2
    assert min(made) > 0
    assert track.iterations == sum(made)
