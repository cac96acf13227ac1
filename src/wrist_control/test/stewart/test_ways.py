"""Long ways and searches: how far stages follow a pose, and what seeds find."""

from wrist_control.stewart.forward_kinematics import Status

from .platforms import CROOKED, FK, lengths_of, random_poses


def test_seeds_find_what_they_found_when_they_were_chosen():
    """Poses that fit sixty sets of lengths, no two of them alike."""
    found = [FK.assemblies(lengths_of(pose)) for pose in random_poses(60, 0.15, 1.0)]
    assert sum(map(len, found)) >= 137


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
