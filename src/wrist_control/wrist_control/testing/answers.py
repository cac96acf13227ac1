"""Laws of single answers: each is compared with an independent truth at random places."""

from __future__ import annotations

import math

import numpy as np

from wrist_control.resolving.step import SINGULAR_MARGIN, start
from wrist_control.testing.broken import require, require_close
from wrist_control.testing.places import (
    Random,
    rate_map,
    regular_places,
    twist_between,
)
from wrist_control.wrists.wrist import Positions, Wrist

PLACES = 40
# A singular value of the jacobian below this is round-off, rad per rad or per m.
FREE = 1e-6
STEP = 1e-6  # rad or m: of a central difference; its error is about 1e-10


def home_is_a_place_to_start_from(wrist: Wrist, random: Random) -> None:
    """`start` accepts home, away from lock, inside every clearance and with room to move."""
    state = start(wrist)
    margin = wrist.margin(state.positions)
    require(margin >= SINGULAR_MARGIN, f'the margin at home is {margin:.2g}')
    for clearance in wrist.clearances(state.positions):
        require(clearance.remaining > 0.0, f'nothing is left of {clearance.name} at home')


def jacobian_is_the_finite_difference_of_forward(wrist: Wrist, random: Random) -> None:
    """`jacobian` is what `forward` does when one joint moves a little."""
    for positions in regular_places(wrist, random, PLACES):
        jacobian = wrist.jacobian(positions)
        columns = [_difference(wrist, positions, joint) for joint in range(len(positions))]
        # Near lock the hand's way bends, and what was rounded grows, as the square of it.
        largest = float(np.abs(jacobian).max())
        scale = max(1.0 + largest, largest**2)
        what = f'jacobian at {tuple(positions)}'
        require_close(jacobian, np.array(columns).T, 1e-7 * scale, what)


def _difference(wrist: Wrist, positions: Positions, joint: int) -> np.ndarray:
    middle = wrist.forward(positions)
    poses = []
    for sign in (1.0, -1.0):
        moved = list(positions)
        moved[joint] += sign * STEP
        poses.append(wrist.forward(wrist.resolve_assembly(moved, middle)))
    ahead, behind = (twist_between(wrist, middle, pose, STEP) for pose in poses)
    half: np.ndarray = 0.5 * (ahead - behind)
    return half


def rates_make_what_the_hand_can_follow(wrist: Wrist, random: Random) -> None:
    """`jacobian` times `rates` of a twist is the twist, in every component that is followed."""
    components = list(wrist.followed_components)
    for positions in regular_places(wrist, random, PLACES):
        for component in components:
            twist = np.eye(wrist.twist_size)[component]
            rates = wrist.rates(positions, tuple(twist.tolist()))
            require(all(map(math.isfinite, rates)), f'rates at {tuple(positions)} are {rates}')
            achieved = wrist.jacobian(positions) @ rates
            what = f'what rates make of {twist.tolist()} at {tuple(positions)}'
            tolerance = 1e-9 * (1.0 + float(np.abs(rates).max()))
            require_close(achieved[components], twist[components], tolerance, what)


def the_joints_can_turn_the_hand_about_its_followed_axes_and_no_other(
    wrist: Wrist, random: Random
) -> None:
    """At home: about all of these at once, and about as many as they can at all.

    The twist's other components are left to the mechanism.
    """
    angular, told = wrist.jacobian(wrist.home)[-3:], wrist.followed_axes
    free, most = (
        int(np.linalg.matrix_rank(rows, tol=FREE)) for rows in (angular[list(told)], angular)
    )
    require(
        free == most == len(told),
        f'followed_axes are {told}, but of these the joints can turn it about {free} at once, and '
        f'about {most} in all',
    )


def no_twist_needs_no_rates(wrist: Wrist, random: Random) -> None:
    """A hand that is to stand still moves no joint."""
    for positions in regular_places(wrist, random, PLACES):
        rates = wrist.rates(positions, (0.0,) * wrist.twist_size)
        require(not any(rates), f'rates of no twist at {tuple(positions)} are {rates}')


def inverse_of_forward_gives_the_joints_back(wrist: Wrist, random: Random) -> None:
    """`inverse` finds the branch of `near`, wherever in their ranges the joints are."""
    for positions in regular_places(wrist, random, PLACES):
        found = wrist.inverse(wrist.forward(positions), positions)
        require_close(list(found), list(positions), 1e-8, f'inverse near {tuple(positions)}')


def inverse_keeps_the_turns_of_near(wrist: Wrist, random: Random) -> None:
    """A joint that has made whole turns is not unwound, nor one that is a little off."""
    for positions in regular_places(wrist, random, PLACES):
        pose = wrist.forward(positions)
        turns = [
            math.tau * float(random.integers(-2, 3)) if joint.kind == 'revolute' else 0.0
            for joint in wrist.joints
        ]
        expected = np.array(list(positions)) + turns
        found = wrist.inverse(pose, tuple(expected.tolist()))
        require_close(list(found), expected, 1e-8, f'inverse near {expected.tolist()}')


def inverse_is_never_further_than_need_be(wrist: Wrist, random: Random) -> None:
    """From a little beside, `inverse` gives the pose, on a branch no further than the nearest."""
    for positions in regular_places(wrist, random, PLACES):
        off = 1e-3 * random.uniform(-1.0, 1.0, size=len(positions))
        near = tuple((np.array(list(positions)) + off).tolist())
        pose = wrist.forward(positions)
        found = wrist.inverse(pose, near)
        rotation = wrist.forward(found).rotation
        require_close(rotation, pose.rotation, 1e-8, f'the hand of inverse near {near}')
        way = float(np.abs(np.array(list(found)) - near).max())
        # A wrist with a joint to spare may leave that one where `near` has it.
        gain = float(np.linalg.norm(rate_map(wrist, positions), 2))
        allowed = (1.0 + gain) * float(np.linalg.norm(off)) + 1e-9
        require(way <= allowed, f'inverse near {near} is {way:.2g} away, at most {allowed:.2g}')


ANSWERS = (
    home_is_a_place_to_start_from,
    jacobian_is_the_finite_difference_of_forward,
    rates_make_what_the_hand_can_follow,
    the_joints_can_turn_the_hand_about_its_followed_axes_and_no_other,
    no_twist_needs_no_rates,
    inverse_of_forward_gives_the_joints_back,
    inverse_keeps_the_turns_of_near,
    inverse_is_never_further_than_need_be,
)
