"""The paper's angles and modified Jacobian, against matrices and finite differences."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrist_control import make_wrist
from wrist_control.rotations import about_x, about_y, about_z, product
from wrist_control.studies.nguyen_angles import (
    PaperAngles,
    angles_of,
    modified_inverse_jacobian,
    pose_of,
    rotation_matrix,
)

WRIST = make_wrist('stewart')
PLATFORM, BASE = np.array(WRIST.platform), np.array(WRIST.base)
angles = st.builds(PaperAngles, *[st.floats(-1.2, 1.2)] * 3)
positions = st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1), st.floats(0.3, 0.6))


@given(angles)
def test_the_turns_are_about_x_then_y_then_z_of_the_base(a):
    turns = product(
        product(about_z(a.angle_z_alpha), about_y(a.angle_y_beta)), about_x(a.angle_x_gamma)
    )
    pose = pose_of((0.0, 0.0, 0.4), a)
    assert np.abs(np.dot(pose.quaternion, turns)) == pytest.approx(1.0)
    assert angles_of(pose) == pytest.approx(a, abs=1e-12)


def test_the_papers_roll_is_about_z():
    rolled = rotation_matrix(PaperAngles(0.3, 0.0, 0.0))
    assert rolled[2] == pytest.approx([0, 0, 1])


@given(positions, angles)
def test_the_modified_jacobian_is_the_difference_of_the_lengths(position, a):
    def lengths(x):
        arms = PLATFORM @ rotation_matrix(PaperAngles(*x[3:])).T
        return np.linalg.norm(x[:3] + arms - BASE, axis=1)

    at, h = np.array([*position, *a]), 1e-6
    found = modified_inverse_jacobian(PLATFORM, BASE, position, a)
    for column, e in enumerate(np.eye(6)):
        difference = (lengths(at + h * e) - lengths(at - h * e)) / (2 * h)
        assert found[:, column] == pytest.approx(difference, abs=1e-8)


@given(positions, angles)
def test_it_is_the_geometric_one_with_angle_rates_for_turning_rates(position, a):
    pose = pose_of(position, a)
    lines = np.array(WRIST.assembly_at(pose).lines)
    # ω in base axes of α̇, β̇, γ̇: z; y turned by α; x turned by α and β.
    turn_z, turn_zy = PaperAngles(a[0], 0.0, 0.0), PaperAngles(a[0], a[1], 0.0)
    axes = np.column_stack(
        [[0, 0, 1], rotation_matrix(turn_z)[:, 1], rotation_matrix(turn_zy)[:, 0]]
    )
    to_platform = pose.rotation
    expected = np.hstack([lines[:, :3] @ to_platform, lines[:, 3:] @ to_platform @ axes])
    assert modified_inverse_jacobian(PLATFORM, BASE, position, a) == pytest.approx(
        expected, abs=1e-12
    )
