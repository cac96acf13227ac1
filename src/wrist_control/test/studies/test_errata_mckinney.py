"""Every row of docs/errata.md for [McKinney1988]: as printed it fails, corrected it holds."""

import math

import numpy as np
import pytest

from wrist_control import make_wrist
from wrist_control.wrists.omni_wrist import shaft

LENGTH = 0.2
SINGLE = make_wrist('single_hooke')
DOUBLE = make_wrist('double_hooke', shaft_length=LENGTH)
OMNI = make_wrist('omni_wrist', shaft_length=LENGTH)
PHI, THETA, PSI = JOINTS = (1.2, 0.5, -0.4)
RATES = np.array([0.3, -0.2, 0.5])  # φ̇, θ̇, ψ̇
TWIST = np.array([0.4, 0.1, -0.6])  # p, q, r

SF, CF = math.sin(PHI), math.cos(PHI)
ST, CT = math.sin(THETA), math.cos(THETA)
SS, CS = math.sin(PSI), math.cos(PSI)
S2, C2 = math.sin(2.0 * PSI), math.cos(2.0 * PSI)


def rot_x(a):
    s, c = math.sin(a), math.cos(a)
    return np.array([[1, 0, 0, 0], [0, c, s, 0], [0, -s, c, 0], [0, 0, 0, 1.0]])


def rot_y(a):
    s, c = math.sin(a), math.cos(a)
    return np.array([[c, 0, -s, 0], [0, 1, 0, 0], [s, 0, c, 0], [0, 0, 0, 1.0]])


def rot_z(a):
    s, c = math.sin(a), math.cos(a)
    return np.array([[c, s, 0, 0], [-s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])


def trans_x(length):
    moved = np.eye(4)
    moved[0, 3] = -length
    return moved


def first_joint():
    return rot_z(PSI) @ rot_y(THETA) @ rot_x(PHI)


def wrist_transformation():
    """Return T_W, forearm to hand coordinates: equation (13)."""
    return rot_y(THETA) @ rot_z(PSI) @ trans_x(LENGTH) @ first_joint()


def differs(printed, correct):
    return np.abs(np.subtract(printed, correct)).max() > 0.01


def test_equation_4_is_right_but_for_a_zero_lost_in_its_last_row():
    matrix = np.array(
        [
            [CT * CS, CF * SS + SF * ST * CS, SF * SS - CF * ST * CS, 0.0],
            [-CT * SS, CF * CS - SF * ST * SS, SF * CS + CF * ST * SS, 0.0],
            [ST, -SF * CT, CF * CT, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
    np.testing.assert_allclose(matrix, first_joint(), atol=1e-15)
    np.testing.assert_allclose(SINGLE.forward(JOINTS).rotation, matrix[:3, :3], atol=1e-15)


def test_equation_5_holds_for_gamma_and_not_for_phi():
    phi_rate = np.linalg.solve(SINGLE.jacobian(JOINTS), (1.0, 0.0, 0.0))[0]
    cos_bend = CT * CS  # (6)
    sin2_bend = 1.0 - cos_bend**2
    gamma = math.atan2(SS, ST * CS)
    assert cos_bend / (1.0 - math.sin(gamma) ** 2 * sin2_bend) == pytest.approx(1.0 / phi_rate)
    assert phi_rate == pytest.approx(CS / CT)
    assert differs(cos_bend / (1.0 - SF**2 * sin2_bend), 1.0 / phi_rate)


def test_equation_5_holds_for_phi_while_the_hand_bends_in_the_plane_of_x_and_z():
    roll, bend = 0.7, 0.6  # φ + γ = 0: the hand at (cos β, 0, −sin β)
    theta = math.atan(math.tan(bend) * math.cos(roll))
    psi = -math.asin(math.sin(bend) * math.sin(roll))
    np.testing.assert_allclose(
        SINGLE.forward((roll, theta, psi)).rotation[0],
        (math.cos(bend), 0.0, -math.sin(bend)),
        atol=1e-12,
    )
    phi_rate = SINGLE.rates((roll, theta, psi), (1.0, 0.0, 0.0))[0]
    printed = math.cos(bend) / (1.0 - (math.sin(roll) * math.sin(bend)) ** 2)
    assert printed == pytest.approx(1.0 / phi_rate)


def test_equation_12_is_a_rotation_about_y():
    np.testing.assert_allclose(
        DOUBLE.forward(JOINTS).rotation, wrist_transformation()[:3, :3], atol=1e-12
    )
    without = rot_z(PSI) @ trans_x(LENGTH) @ first_joint()
    assert differs(without, wrist_transformation())


def test_equation_14_columns():
    y = CF * SS + SF * ST * CS
    z = SF * SS - CF * ST * CS
    columns = [
        (2.0 * CT**2 * CS**2 - 1.0, -2.0 * CT * SS * CS, 2.0 * ST * CT * CS**2),  # n
        (2.0 * CT * CS * y, -2.0 * SS * y + CF, 2.0 * ST * CS * y - SF),  # o
        (2.0 * CT * CS * z, -2.0 * SS * z + SF, 2.0 * ST * CS * z + CF),  # a
        (-LENGTH * CT * CS, LENGTH * SS, -LENGTH * ST * CS),  # u
    ]
    np.testing.assert_allclose(np.transpose(columns), wrist_transformation()[:3], atol=1e-12)
    printed_first_row_of_a = 2.0 * CT * CS * z + SF
    assert differs(printed_first_row_of_a, wrist_transformation()[0, 2])


def test_equation_15_gives_the_hands_origin():
    t = wrist_transformation()
    n, o, a, u = t[:3].T
    origin = (-u @ n, -u @ o, -u @ a)
    shaft_axis = (CT * CS, CF * SS + SF * ST * CS, SF * SS - CF * ST * CS)
    np.testing.assert_allclose(origin, LENGTH * np.array(shaft_axis), atol=1e-12)
    np.testing.assert_allclose(np.linalg.inv(t)[:3, 3], origin, atol=1e-12)
    np.testing.assert_allclose(DOUBLE.forward(JOINTS).position, origin, atol=1e-12)


def test_equations_16_to_23_have_a_one_where_a_rate_has_a_zero():
    """A translation leaves rates alone only if their fourth component is 0."""
    rates = np.array([0.3, -0.2, 0.5])
    assert differs((trans_x(LENGTH) @ [*rates, 1.0])[:3], rates)
    np.testing.assert_array_equal((trans_x(LENGTH) @ [*rates, 0.0])[:3], rates)


def test_equation_20_turns_equation_19_back_to_forearm_axes():
    f, t, s = RATES
    in_shaft_axes = LENGTH * np.array([0.0, f * ST + s, f * CT * SS - t * CS])  # (19)
    forearm = first_joint()[:3, :3].T @ in_shaft_axes
    h = 1e-6
    ahead, behind = (DOUBLE.forward(JOINTS + side * h * RATES).position for side in (1.0, -1.0))
    np.testing.assert_allclose(np.subtract(ahead, behind) / (2.0 * h), forearm, atol=1e-9)
    np.testing.assert_allclose(DOUBLE.origin_jacobian(JOINTS) @ RATES, forearm, atol=1e-12)


def test_equation_22_second_component_before_the_last_rotation():
    f, t, s = RATES
    x, z = f * CT * C2 + t * S2, f * ST + 2.0 * s
    correct = (rot_y(THETA) @ [x, -f * CT * S2 + t * (C2 + 1.0), z, 0.0])[:3]
    printed = (rot_y(THETA) @ [x, f * CT * S2 + t * (C2 + 1.0), z, 0.0])[:3]
    np.testing.assert_allclose(DOUBLE.jacobian(JOINTS) @ RATES, correct, atol=1e-12)
    assert differs(printed, correct)


def test_equation_23_last_element_of_the_first_row_is_negative():
    assert DOUBLE.jacobian(JOINTS)[0, 2] == pytest.approx(-2.0 * ST)
    h = 1e-6
    ahead, behind = (DOUBLE.forward((PHI, THETA, PSI + d)).rotation for d in (h, -h))
    spin = (ahead - behind) / (2.0 * h) @ DOUBLE.forward(JOINTS).rotation.T
    assert spin[1, 2] == pytest.approx(-2.0 * ST, abs=1e-8)  # Ċ Cᵀ = −[ω]×


def test_equation_26_begins_with_minus_p():
    p, q, r = TWIST
    tangents = 0.5 * q * math.tan(THETA) * math.tan(PSI)
    rest = tangents + r * (1.0 - 2.0 * ST**2) / (2.0 * CT)
    phi_rate = p - q * math.tan(PSI) / CT + r * math.tan(THETA)  # (24)
    theta_rate = (p * CT + r * ST) * math.tan(PSI) + q * (1.0 - 2.0 * SS**2) / (2.0 * CS**2)
    solved = np.linalg.solve(DOUBLE.jacobian(JOINTS), TWIST)
    np.testing.assert_allclose((phi_rate, theta_rate, -p * ST + rest), solved, atol=1e-12)
    assert differs(p * ST + rest, solved[2])


def test_the_tip_is_not_shortened_by_the_length_over_root_2():
    """The distance from the first joint to the tip of an end effector of length e, ψ = 45°."""
    pose = DOUBLE.forward((0.0, 0.0, math.radians(45.0)))
    for e in (0.05, 0.2, 1.0):
        tip = np.array(pose.position) + e * pose.rotation[0]
        shortened = LENGTH + e - np.linalg.norm(tip)
        exact = LENGTH + e - math.sqrt(LENGTH**2 + e**2 + math.sqrt(2.0) * LENGTH * e)
        assert shortened == pytest.approx(exact)
        assert shortened < 0.3 * LENGTH < LENGTH / math.sqrt(2.0)


def test_equation_30_lacks_a_square_root():
    theta_a, psi_a = 0.5, -0.4
    numerator = np.array(
        [
            math.cos(theta_a) * math.cos(psi_a),
            math.cos(theta_a) * math.sin(psi_a),
            -math.sin(theta_a) * math.cos(psi_a),
        ]
    )
    below = math.cos(theta_a) ** 2 + (math.sin(theta_a) * math.cos(psi_a)) ** 2
    np.testing.assert_allclose(shaft((0.0, theta_a, psi_a)), numerator / math.sqrt(below))
    assert np.linalg.norm(numerator / math.sqrt(below)) == pytest.approx(1.0)
    assert np.linalg.norm(numerator / below) != pytest.approx(1.0, abs=0.01)


def test_the_inner_drive_turns_about_z_and_the_outer_about_y():
    """At figure 8's θ = 45° the outer drive, θa, has turned alone, and the hand about y."""
    assert OMNI.rates((0.0, 0.3, 0.0), (0.0, 1.0, 0.0))[2] == 0.0
    assert OMNI.rates((0.0, 0.0, 0.3), (0.0, 0.0, 1.0))[1] == 0.0
    np.testing.assert_allclose(OMNI.forward((0.0, 0.3, 0.0)).position[1], 0.0, atol=1e-15)
    np.testing.assert_allclose(OMNI.forward((0.0, 0.0, 0.3)).position[2], 0.0, atol=1e-15)


def test_actuator_1_turns_the_driver_yoke_about_x_and_actuator_2_the_cross_about_y():
    """Y_W lies along the arm held by the driver yoke: it rolls with φ and does not pitch."""
    arm = first_joint()[:3, :3].T @ rot_z(PSI)[:3, :3] @ [0.0, 1.0, 0.0]
    np.testing.assert_allclose(arm, rot_x(PHI)[:3, :3].T @ [0.0, 1.0, 0.0], atol=1e-15)
    in_hand = SINGLE.jacobian(JOINTS)[:, 1]
    np.testing.assert_allclose(SINGLE.forward(JOINTS).rotation.T @ in_hand, arm, atol=1e-12)


def test_equations_27_to_29_are_no_rates_to_integrate():
    """The text means (24) to (26): they lead from one pose to the next."""
    h = 1e-4
    after = np.array(JOINTS) + h * np.array(DOUBLE.rates(JOINTS, TWIST))
    turned = DOUBLE.forward(after).rotation @ DOUBLE.forward(JOINTS).rotation.T
    spin = np.array([turned[1, 2], turned[2, 0], turned[0, 1]]) / h
    np.testing.assert_allclose(spin, TWIST, atol=1e-3)
