"""Servo angles in, proved poses out: the node that is the legs' own, on moving base anchors."""

import math

import numpy as np
import pytest
import yaml

from wrist_control import WristError, make_wrist
from wrist_control.graph.processes import config_file
from wrist_control.nodes.rotary_stewart_forward_kinematics import RotaryStewartForwardKinematics
from wrist_control.rotations import Pose, rates_between, turned
from wrist_interfaces.msg import ForwardKinematicsStatus

from .stewart_flown import pose_of
from .stewart_readings import Watched, assert_same_pose

WRIST = make_wrist('rotary_stewart')
HOME = WRIST.home.pose
SERVOS = [f'servo_{servo}' for servo in range(1, 7)]
TILTED = Pose(turned(HOME.quaternion, (0.1, -0.08, 0.12), 1.0), (0.003, -0.002, 0.102))


class WatchedServos(Watched):
    """The node of the rotary platform, and everything that it says."""

    kind, names, home = RotaryStewartForwardKinematics, SERVOS, tuple(WRIST.home)


def test_the_pose_is_that_of_the_angles_with_its_proof(graph):
    watched = WatchedServos(graph)
    watched.begin()
    status = watched.status_of(WRIST.assembly_at(TILTED))
    assert status.status == ForwardKinematicsStatus.CONVERGED
    assert 0.0 < status.error_bound < 1e-11
    assert status.unique_radius > 0.001
    assert 'proved' in status.message
    assert_same_pose(pose_of(watched.poses[-1].pose.pose), TILTED)
    assert watched.poses[-1].header.frame_id == 'forearm'


def test_the_covariance_is_the_spread_of_poses_from_noisy_angles(graph):
    """Finite differences of the pose itself, servo by servo: J Σ Jᵀ in base axes."""
    noise = [1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3]
    watched = WatchedServos(graph, angle_noise=noise)
    watched.begin()
    angles = np.array(WRIST.assembly_at(TILTED))
    watched.status_of(angles)
    columns, step = [], 1e-5
    for servo, sigma in enumerate(noise):
        move = step * np.eye(6)[servo]
        ahead, behind = (
            WRIST.solve(tuple((angles + side * move).tolist()), TILTED).pose
            for side in (1.0, -1.0)
        )
        shift = np.subtract(ahead.position, behind.position)
        turn = TILTED.rotation.T @ rates_between(behind.quaternion, ahead.quaternion, 1.0)
        columns.append(sigma * np.concatenate([shift, turn]) / (2.0 * step))
    expected = np.array(columns).T @ np.array(columns)
    found = np.array(watched.poses[-1].pose.covariance).reshape(6, 6)
    np.testing.assert_allclose(found, expected, rtol=1e-4, atol=1e-12)


def test_the_twist_is_what_the_servo_rates_make(graph):
    watched = WatchedServos(graph)
    watched.begin()
    twist = (0.01, -0.02, 0.015, 0.3, -0.2, 0.1)
    angles = WRIST.assembly_at(TILTED)
    watched.status_of(angles, velocities=WRIST.rates(angles, twist))
    found = watched.twists[-1].twist
    linear, angular = found.linear, found.angular
    made = (linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
    assert made == pytest.approx(twist, abs=1e-9)


REFUSED = {
    'no number': ((math.nan, 0, 0, 0, 0, 0), 'not finite', 'The angle of servo_1 is nan'),
    'a jump': ((1.2, -0.6, 0.6, -0.6, 0.6, -0.6), 'jump', 'servo_1 jumped by 0.573459 rad'),
    'too far': ((0, 0, 0, 0, 2.0, 0), 'outside its limits', 'servo_5 is at 2 rad; valid is -1 to'),
}


@pytest.mark.parametrize(('angles', 'reason', 'says'), REFUSED.values(), ids=REFUSED)
def test_readings_that_cannot_be_are_refused_by_name(graph, angles, reason, says):
    limits = {'joint_lower_limits': [-1.0], 'joint_upper_limits': [1.5]}
    watched = WatchedServos(graph, jump_limit=3.0, **limits)
    poses, _ = watched.begin()
    watched.send([float(x) for x in angles])
    assert says in watched.refused(reason)
    assert len(watched.poses) == poses


def test_until_the_servos_were_home_no_pose_counts(graph):
    watched = WatchedServos(graph)
    far = Pose(turned(HOME.quaternion, (0.3, 0.2, 0.1), 1.0), (0.01, -0.015, 0.09))
    graph.until(lambda: watched.status_of(WRIST.assembly_at(far)).status != 255)
    assert watched.statuses[-1].status == ForwardKinematicsStatus.UNPROVEN
    assert 'every servo is within 0.25 rad of its angle there' in watched.statuses[-1].message
    assert watched.poses == []
    watched.begin()
    assert watched.poses


def test_until_the_first_reading_the_status_says_what_is_missing(graph):
    watched = WatchedServos(graph)
    graph.until(lambda: watched.statuses)
    assert 'No servo angles have come yet' in watched.statuses[-1].message
    assert 'servo_1 to servo_6' in watched.statuses[-1].message


def test_the_node_of_a_reachy_mini_takes_its_makers_angles(graph):
    """[ReachyMini]: a head pose and its six angles, by the maker's own inverse kinematics."""
    file = yaml.safe_load(config_file('reachy_mini.yaml').read_text())
    watched = WatchedServos(
        graph, **file['/**/rotary_stewart_forward_kinematics']['ros__parameters']
    )
    watched.begin()
    pose = Pose(turned(HOME.quaternion, (0.0, 0.2, 0.0), 1.0), (0.0, 0.005, 0.1053667))
    angles = (0.6717614, -0.670853, 0.8525178, -0.9499542, 0.7426939, -0.6387469)
    for share in np.linspace(0.1, 1.0, 10):
        reading = (1.0 - share) * np.array(watched.home) + share * np.array(angles)
        status = watched.status_of(reading, after=0.02)
        assert status.status == ForwardKinematicsStatus.CONVERGED
    assert_same_pose(pose_of(watched.poses[-1].pose.pose), pose, 1e-5)


@pytest.mark.parametrize(
    ('parameters', 'says'),
    [
        ({'angle_noise': [1e-3, 1e-3]}, 'angle_noise has 2 values; give 1 for all servos or 6'),
        ({'angle_noise': [math.inf]}, r'angle_noise is \[inf\]; give finite values of 0 rad'),
        ({'rod_length': 0.01}, 'There is no home at that home_height: The horn of servo_1'),
        ({'hinge_axes': [0.0] * 18}, 'The axis of servo_1 has no direction'),
    ],
)
def test_what_cannot_be_is_refused_at_the_start(graph, parameters, says):
    with pytest.raises(WristError, match=says):
        graph.start(RotaryStewartForwardKinematics, **parameters)
