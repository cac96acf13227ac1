"""Pose and jacobian of a URDF's wrist against MuJoCo, which reads the same file."""

import numpy as np
import pytest

from wrist_control import make_wrist

from .robots import FOLDER, SHIPPED, random_robot, shipped

mujoco = pytest.importorskip('mujoco', reason='the extra physics is not installed')

# Links without a mass cannot move in MuJoCo, and it would forget those that are fixed.
NEEDED = (
    '<mujoco><compiler fusestatic="false" boundmass="1" boundinertia="1" balanceinertia="true"/>'
    '</mujoco></robot>'
)


def compared(wrist, random, count=30):
    """Return the largest differences of rotation, position and jacobian, hand axes."""
    model = mujoco.MjModel.from_xml_string(wrist.description.replace('</robot>', NEEDED))
    data = mujoco.MjData(model)
    tip = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, wrist.tip)
    joints = [model.joint(joint.name) for joint in wrist.joints]
    forearm = model.body_parentid[joints[0].bodyid[0]]
    worst = np.zeros(3)
    for _ in range(count):
        data.qpos[:] = random.uniform(-1.0, 1.0, model.nq)  # the arm's joints, too
        positions = random.uniform(-3.0, 3.0, len(joints))
        for joint, position in zip(joints, positions, strict=True):
            data.qpos[joint.qposadr[0]] = position
        mujoco.mj_forward(model, data)
        base, hand = (data.xmat[body].reshape(3, 3) for body in (forearm, tip))
        place = base.T @ (data.xpos[tip] - data.xpos[forearm])
        every = np.zeros((3, model.nv))
        mujoco.mj_jacBody(model, data, None, every, tip)
        jacobian = hand.T @ every[:, [joint.dofadr[0] for joint in joints]]
        pose = wrist.forward(positions)
        differences = (
            pose.rotation - hand.T @ base,
            pose.position - place,
            wrist.jacobian(positions) - jacobian,
        )
        worst = np.maximum(worst, [np.abs(one).max() for one in differences])
    return worst


@pytest.mark.parametrize('name', SHIPPED)
def test_a_shipped_robot_is_where_mujoco_has_it(name):
    assert (compared(shipped(name), np.random.default_rng(1)) < 1e-12).all()


def test_any_axes_are_where_mujoco_has_them():
    random = np.random.default_rng(2)
    for count in (2, 3, 4) * 5:
        assert (compared(random_robot(random, count), random) < 1e-12).all()


def test_joints_before_the_wrist_do_not_count():
    names = ['panda_joint3', 'panda_joint4']
    text = (FOLDER / 'panda.urdf').read_text()
    wrist = make_wrist('urdf', description=text, tip='panda_link4', joints=names)
    assert (compared(wrist, np.random.default_rng(3)) < 1e-12).all()
