"""The Carpal wrist against the geometry of [Canfield1997], fig. 4.1, drawn with matrices."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import InvalidValueError, UnreachableError, make_wrist
from wrist_control.rotations import Pose, about_z, product, rates_between, turned
from wrist_control.studies.canfield_closure import fold
from wrist_control.wrists.carpal import Carpal

AZIMUTHS = np.radians([0.0, 120.0, 240.0])
RADIAL = np.stack([np.cos(AZIMUTHS), np.sin(AZIMUTHS), np.zeros(3)], axis=1)
UP = np.array([0.0, 0.0, 1.0])

angles = st.floats(-0.6, 0.6)
legs = st.tuples(*(st.floats(0.2, 1.2),) * 3)
rates = st.tuples(*(st.floats(-2.0, 2.0),) * 3)
wrists = st.builds(
    lambda b, length, ratio: Carpal(b, length, ratio * length),
    st.floats(0.02, 0.2),
    st.floats(0.05, 0.2),
    st.floats(0.2, 0.9),
)


def mid_nodes(wrist, positions):
    out = wrist.base_radius + wrist.leg_length * np.cos(positions)
    return out[:, None] * RADIAL + wrist.leg_length * np.sin(positions)[:, None] * UP


def mirror(nodes):
    """Return the reflection x -> M x + t in the plane through three points."""
    normal = np.cross(nodes[1] - nodes[0], nodes[2] - nodes[0])
    normal /= np.linalg.norm(normal)
    return np.eye(3) - 2.0 * np.outer(normal, normal), 2.0 * (normal @ nodes[0]) * normal


def normal_and_plunge(wrist, positions):
    """Return N̂x, N̂y of the midplane and the plunge, read off the plane itself."""
    nodes = mid_nodes(wrist, positions)
    plane = np.linalg.solve(nodes, np.ones(3))
    normal = plane / np.linalg.norm(plane) * np.sign(plane[2])
    return np.array([normal[0], normal[1], 1.0 / plane[2]])


@given(wrists, legs)
def test_hand_carries_the_base_hinges_onto_their_mirror_images(wrist, positions):
    pose = wrist.forward(positions)
    reflection, shift = mirror(mid_nodes(wrist, np.array(positions)))
    hinges = wrist.base_radius * RADIAL
    np.testing.assert_allclose(
        hinges @ pose.rotation + pose.position, hinges @ reflection + shift, atol=1e-12
    )


@given(wrists, legs)
def test_hand_frame_is_a_proper_tilt_without_torsion(wrist, positions):
    pose = wrist.forward(positions)
    assert np.linalg.det(pose.rotation) == pytest.approx(1.0)
    _, torsion, a3, a4 = pose.quaternion
    assert torsion == 0.0
    reflection, _ = mirror(mid_nodes(wrist, np.array(positions)))
    np.testing.assert_allclose(pose.rotation[2], -reflection @ UP, atol=1e-12)
    np.testing.assert_allclose(pose.rotation @ [-a4, -a3, 0.0], [-a4, -a3, 0.0], atol=1e-12)


def test_hand_at_home_is_aligned_with_the_forearm():
    wrist = Carpal()
    pose = wrist.forward(wrist.home)
    np.testing.assert_allclose(pose.rotation, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(pose.position, [0.0, 0.0, 2.0 * wrist.plunge], atol=1e-15)


@given(legs)
def test_plunge_is_the_distance_along_the_distal_normal_to_the_midplane(positions):
    wrist = Carpal()
    pose = wrist.forward(positions)
    _, _, plunge = normal_and_plunge(wrist, np.array(positions))
    pivot = np.array(pose.position) - plunge * pose.rotation[2]
    np.testing.assert_allclose(pivot, plunge * UP, atol=1e-12)


@given(wrists, legs)
def test_inverse_undoes_forward(wrist, positions):
    found = wrist.inverse(wrist.forward(positions), positions)
    np.testing.assert_allclose(found, positions, atol=1e-9)


@given(angles, angles)
def test_every_leg_has_two_branches_and_all_eight_make_the_pose(p, q):
    wrist = Carpal()
    pose = wrist.target_pose(wrist.forward(wrist.home), (p, q, 0.0), 1.0)
    outer = wrist.inverse(pose, wrist.home)
    inner = wrist.inverse(pose, (math.pi,) * 3)
    for chosen in itertools.product(*zip(outer, inner, strict=True)):
        assert wrist.inverse(pose, chosen) == pytest.approx(chosen)
        remade = wrist.forward(chosen)
        np.testing.assert_allclose(remade.rotation, pose.rotation, atol=1e-9)
        np.testing.assert_allclose(remade.position, pose.position, atol=1e-9)


def test_inverse_keeps_whole_turns():
    wrist = Carpal()
    near = tuple(theta + 4.0 * math.pi for theta in wrist.home)
    assert wrist.inverse(wrist.forward(wrist.home), near) == pytest.approx(near)


def test_torsion_or_a_displaced_plate_is_out_of_reach():
    wrist = Carpal()
    home = wrist.forward(wrist.home)
    with pytest.raises(UnreachableError, match='torsion'):
        wrist.inverse(Pose(product(home.quaternion, about_z(0.01)), home.position), wrist.home)
    with pytest.raises(UnreachableError, match='mirrored'):
        wrist.inverse(Pose(home.quaternion, (0.001, 0.0, 0.14)), wrist.home)


def test_mid_nodes_in_one_line_cannot_be_assembled():
    wrist = Carpal(base_radius=0.05, leg_length=0.1, plunge=0.05)
    folded = math.acos(-0.5)
    with pytest.raises(UnreachableError, match='one line'):
        wrist.forward((folded, folded, 0.0))


@given(wrists, legs)
def test_jacobian_is_the_finite_difference_of_forward(wrist, positions):
    h = 1e-6

    def rates_for(joint):
        low, high = (
            wrist.forward([x + side * h * (i == joint) for i, x in enumerate(positions)])
            for side in (-1.0, 1.0)
        )
        return rates_between(low.quaternion, high.quaternion, 2.0 * h)

    numeric = np.array([rates_for(joint) for joint in range(3)]).T
    exact = wrist.jacobian(positions)
    np.testing.assert_allclose(exact, numeric, atol=1e-6 * (1.0 + np.abs(exact).max() ** 2))
    assert np.linalg.matrix_rank(exact, tol=1e-9) == 2


@given(wrists, legs)
def test_normal_jacobian_is_the_finite_difference_of_the_plane(slopes, wrist, positions):
    exact = wrist.normal_jacobian(positions)
    numeric = slopes(lambda x: normal_and_plunge(wrist, x), np.array(positions))
    np.testing.assert_allclose(exact, numeric, atol=1e-6 * (1.0 + np.abs(exact).max() ** 2))


@given(wrists, legs, rates)
def test_rates_make_p_and_q_and_hold_the_plunge(wrist, positions, twist):
    joint_rates = np.array(wrist.rates(positions, twist))
    p, q, r = wrist.jacobian(positions) @ joint_rates
    size = 1e-9 * (1.0 + np.abs(joint_rates).max())
    assert (p, q) == pytest.approx(twist[:2], abs=size)
    assert wrist.normal_jacobian(positions)[2] @ joint_rates == pytest.approx(0.0, abs=size)
    a1, _, a3, a4 = wrist.forward(positions).quaternion
    assert a1 * r == pytest.approx(a3 * p - a4 * q, abs=size)


@given(legs, rates)
def test_roll_alone_moves_nothing(positions, twist):
    assert Carpal().rates(positions, (0.0, 0.0, twist[2])) == (0.0, 0.0, 0.0)


@given(rates, rates)
def test_advance_follows_p_and_q_exactly_over_any_step(first, second):
    wrist = Carpal(plunge=0.05)
    pose = wrist.target_pose(wrist.forward(wrist.home), first, 0.3)
    after = wrist.target_pose(pose, second, 0.3)
    p, q, _ = rates_between(pose.quaternion, after.quaternion, 0.3)
    assert (p, q) == pytest.approx(second[:2], abs=1e-9)


@given(rates, rates)
def test_one_long_step_ends_where_many_short_ones_do(first, second):
    wrist = Carpal(plunge=0.05)
    pose = wrist.target_pose(wrist.forward(wrist.home), first, 0.3)
    once, often = wrist.target_pose(pose, second, 0.3), pose
    for _ in range(30):
        often = wrist.target_pose(often, second, 0.01)
    np.testing.assert_allclose(once.rotation, often.rotation, atol=1e-12)
    np.testing.assert_allclose(once.position, often.position, atol=1e-12)


@given(rates, rates)
def test_advance_holds_the_plunge_and_stays_free_of_torsion(first, second):
    wrist = Carpal(plunge=0.05)
    pose = wrist.target_pose(wrist.forward(wrist.home), first, 0.3)
    pose = wrist.target_pose(pose, second, 0.3)
    assert pose.quaternion[1] == 0.0
    positions = wrist.inverse(pose, wrist.home)
    assert normal_and_plunge(wrist, np.array(positions))[2] == pytest.approx(0.05)


@given(wrists, legs)
def test_determinant_is_the_product_of_the_lifts_over_the_triangle(wrist, positions):
    """What [Canfield1997] only observed: det J is 0 exactly where a leg's discriminant is."""
    nodes = mid_nodes(wrist, np.array(positions))
    normal = np.cross(nodes[1] - nodes[0], nodes[2] - nodes[0])
    area = np.linalg.norm(normal)
    along = -np.sin(positions)[:, None] * RADIAL + np.cos(positions)[:, None] * UP
    lifts = wrist.leg_length * along @ (normal / area) * np.sign(normal[2])
    determinant = np.linalg.det(wrist.normal_jacobian(positions))
    assert determinant == pytest.approx(np.prod(lifts) / area, rel=1e-6, abs=1e-12)


@given(wrists, st.floats(0.0, 2.0 * math.pi), st.floats(0.0, 1.0))
def test_inside_the_workspace_nothing_but_closure_is_singular(wrist, azimuth, share):
    """Legs outward, plunge held: the mid-nodes stay on their own side and span a plane."""
    tilt = 0.99 * share * fold(wrist, azimuth)
    aim = (-math.sin(azimuth) * tilt, math.cos(azimuth) * tilt, 0.0)
    positions = wrist.home
    for part in np.linspace(0.0, 1.0, 20):
        pose = wrist.target_pose(wrist.forward(wrist.home), aim, part)
        positions = wrist.inverse(pose, positions)
    assert np.all(wrist.base_radius + wrist.leg_length * np.cos(positions) > 0.0)
    assert np.linalg.det(wrist.normal_jacobian(positions)) > 0.0


@given(wrists, st.floats(0.0, 2.0 * math.pi))
def test_reach_is_where_a_leg_stops_closing(wrist, azimuth):
    reach = fold(wrist, azimuth)

    def closes(tilt):
        aim = (-math.sin(azimuth) * tilt, math.cos(azimuth) * tilt, 0.0)
        pose = Pose(turned((1.0, 0.0, 0.0, 0.0), aim, 1.0))
        z, _, x, y = pose.quaternion
        distance = 2.0 * wrist.plunge * z
        wrist.inverse(
            Pose(pose.quaternion, (distance * x, -distance * y, distance * z)), wrist.home
        )

    closes(0.999 * reach)
    if reach < 3.1:
        with pytest.raises(UnreachableError, match='closure of leg'):
            closes(1.001 * reach)


@pytest.mark.parametrize(
    ('dimensions', 'sentence'),
    [
        ({'plunge': 0.1}, 'plunge is 0.1 m with leg_length 0.1 m; .* make plunge smaller'),
        ({'leg_length': -1.0}, 'leg_length is -1.0; valid is'),
        ({'base_radius': math.nan}, 'base_radius is nan; valid is'),
    ],
)
def test_bad_dimensions_are_refused_with_what_is_valid(dimensions, sentence):
    with pytest.raises(InvalidValueError, match=sentence):
        make_wrist('carpal', **dimensions)
