"""Our kinematics before MuJoCo: they agree, and whatever is wrong shows."""

import dataclasses
from itertools import islice

import numpy as np
import pytest

pytest.importorskip('mujoco', reason='the extra physics is not installed')

from wrist_control import make_wrist
from wrist_control.physics.mechanism import Mechanism
from wrist_control.physics.models import MODELS, build
from wrist_control.rotations import IDENTITY, rates_between
from wrist_control.studies import judgement
from wrist_control.studies.judgement import BOUND, FIRM, LOADED, aims, expected_efforts, judge

POSES = 3
# How little a wrong number may be wrong to be seen.
LITTLE = 1e-5
# Every length and angle of a link; the others say where a wrist starts and how far it may go.
LINKS = [
    ('double_hooke', 'shaft_length'),
    ('omni_wrist', 'shaft_length'),
    ('carpal', 'base_radius'),
    ('carpal', 'leg_length'),
    ('stewart', 'platform_radius'),
    ('stewart', 'base_radius'),
    ('stewart', 'platform_angle'),
    ('stewart', 'base_angle'),
    ('rotary_stewart', 'hinge_radius'),
    ('rotary_stewart', 'hinge_offset'),
    ('rotary_stewart', 'horn_length'),
    ('rotary_stewart', 'rod_length'),
    ('rotary_stewart', 'platform_radius'),
    ('rotary_stewart', 'platform_angle'),
]


@pytest.mark.parametrize('name', MODELS)
def test_physics_and_kinematics_agree(name):
    verdict = judge(make_wrist(name), POSES)
    assert verdict.poses == POSES
    assert verdict.worst <= BOUND
    assert verdict.steps_per_second > 0.0


@pytest.mark.parametrize(('name', 'link'), LINKS)
def test_a_wrong_length_shows(name, link):
    wrist = make_wrist(name)
    wrong = dataclasses.replace(wrist, **{link: (1.0 + LITTLE) * getattr(wrist, link)})
    assert judge(wrist, POSES, built=wrong).worst > BOUND


def test_every_dimension_of_a_link_is_made_wrong_once():
    others = {'gain', 'cone_half_angle', 'plunge', 'home_height'}
    every = {(name, own) for name in MODELS for own in make_wrist(name).dimensions()}
    assert {(name, own) for name, own in every if own not in others} == set(LINKS)


# A leg of the platform turns about its foot: however its slide is mounted, it ends at its head.
# A horn that tilts moves its tip along its axis; its rod, nearly square to that, hardly feels it.
@pytest.mark.parametrize(
    'name', [name for name in MODELS if name not in ('stewart', 'rotary_stewart')]
)
def test_a_wrong_axis_shows(name, monkeypatch):
    def tilted(wrist, *settings):
        mechanism = build(wrist, *settings)
        for joint in mechanism.joints:
            axis = mechanism.model.joint(joint).axis
            axis += LITTLE * np.roll(axis, 1)
        return mechanism

    monkeypatch.setattr(judgement, 'build', tilted)
    verdict = judge(make_wrist(name), POSES)
    assert max(verdict.position, verdict.attitude) > 2.0 * BOUND


@pytest.mark.parametrize('name', MODELS)
def test_a_wrong_jacobian_shows_in_motion_and_in_efforts(name, monkeypatch):
    wrist = make_wrist(name)
    right = type(wrist).jacobian
    rates = np.eye(len(wrist.joints)) + LITTLE

    def wrong(self, positions):
        return right(self, positions) @ rates

    monkeypatch.setattr(type(wrist), 'jacobian', wrong)
    verdict = judge(wrist, POSES)
    assert verdict.motion > 2.0 * BOUND
    assert verdict.effort > 2.0 * BOUND
    assert max(verdict.position, verdict.attitude) <= BOUND


def test_a_mechanism_that_never_rests_is_not_judged_right(monkeypatch):
    settle = Mechanism.settle
    monkeypatch.setattr(Mechanism, 'settle', lambda self: settle(self, longest=0.02))
    assert judge(make_wrist('pitch_yaw'), 1).worst == np.inf


def test_the_judge_is_the_same_in_every_run():
    first, second = (judge(make_wrist('carpal'), 2)[:-1] for _ in range(2))
    assert first == second


@pytest.mark.parametrize('name', MODELS)
def test_poses_are_far_apart_and_inside_the_workspace(name):
    wrist = make_wrist(name)
    chosen = list(islice(aims(wrist, np.random.default_rng(1)), 10))
    turns = []
    for positions in (tuple(one.tolist()) for one in chosen):
        assert wrist.margin(positions) > 0.2
        assert all(limit.remaining > 0.0 for limit in wrist.clearances(positions))
        hand = wrist.forward(positions).quaternion
        turns.append(np.linalg.norm(rates_between(IDENTITY, hand, 1.0)))
    assert max(turns) > 0.4
    assert np.all(np.ptp(chosen, axis=0) > 0.02)


def test_no_pose_is_where_the_carpal_wrist_is_loose():
    wrist = make_wrist('carpal')
    mechanism = build(wrist)
    for positions in islice(aims(wrist, np.random.default_rng(1)), 30):
        mechanism.start_at(positions)
        assert mechanism.firmness > FIRM


def test_a_weight_beside_an_axis_is_held_by_its_lever():
    """The probe points along z, 6 in: what pulls along y turns about -x, what along x about y."""
    wrist = make_wrist('pitch_yaw')
    pull = LOADED._replace(payload=2.0, gravity=(3.0, 5.0, 7.0))
    lever = 2.0 * 0.1524
    assert expected_efforts(wrist, (0.0, 0.0), pull) == pytest.approx((5.0 * lever, -3.0 * lever))


def test_a_weight_on_a_platform_is_held_by_its_legs():
    wrist = make_wrist('stewart')
    pull = LOADED._replace(gravity=(0.0, 0.0, -9.81))
    efforts = expected_efforts(wrist, wrist.home, pull)
    rise = (np.subtract(wrist.platform, wrist.base)[:, 2] + wrist.home_height) / wrist.home
    assert efforts @ rise == pytest.approx(9.81)
