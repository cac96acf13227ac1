"""What the wrists of [McKinney1988] do alike: the conventional one and those of Hooke joints."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from wrist_control.resolving import LimitKind, start, step
from wrist_control.wrists.double_hooke import DoubleHooke
from wrist_control.wrists.omni_wrist import OmniWrist
from wrist_control.wrists.roll_pitch_roll import RollPitchRoll
from wrist_control.wrists.single_hooke import SingleHooke

SINGLE, DOUBLE, OMNI = SingleHooke(), DoubleHooke(shaft_length=0.2), OmniWrist(shaft_length=0.2)
CONVENTIONAL = RollPitchRoll()
angles = st.floats(-3.0, 3.0)


def bent(largest):
    """Return joints of which the first rolls and the others bend as far as this, rad."""
    return st.tuples(angles, *(st.floats(-largest, largest),) * 2)


unlocked = st.tuples(angles, angles, angles).filter(lambda x: abs(math.sin(x[1])) > 0.01)
commands = st.tuples(*(st.floats(-1.0, 1.0),) * 3)
JOINTS = {SINGLE: bent(1.4), DOUBLE: bent(1.2), OMNI: bent(1.2), CONVENTIONAL: unlocked}


def named(wrists):
    return pytest.mark.parametrize('wrist', wrists, ids=lambda wrist: type(wrist).__name__)


def branches(wrist, positions, turns):
    """Return other joint positions that hold the same hand, some of them whole turns apart."""
    first, second, third = positions
    half, whole = math.pi, math.tau * turns
    if wrist is OMNI:
        return [
            (first - math.tau * inner, second + half * outer, third + half * inner)
            for inner, outer in itertools.product((-1, 0, 1), repeat=2)
        ]
    return {
        SINGLE: [
            (first + whole, second, third - whole),
            (first + half, half - second + whole, third + half),
        ],
        DOUBLE: [
            (first + whole, second, third - whole),
            (first, second + half, half - third),
            (first, second, third + half),
            (first, second + half + whole, -third),
        ],
        CONVENTIONAL: [
            (first + whole, second, third - whole),
            (first + half, -second + whole, third + half),
        ],
    }[wrist]


@pytest.mark.parametrize(('wrist', 'axes'), [(SINGLE, 'XYZ'), (CONVENTIONAL, 'XYX')])
@given(st.data())
def test_the_hand_turns_about_its_three_axes_in_this_order(wrist, axes, data):
    positions = data.draw(st.tuples(angles, angles, angles))
    turned = Rotation.from_euler(axes, positions).as_matrix()
    np.testing.assert_allclose(wrist.forward(positions).rotation, turned.T, atol=1e-12)


@named(JOINTS)
@given(st.data(), commands)
def test_rates_solve_the_jacobian(wrist, data, twist):
    positions = data.draw(JOINTS[wrist])
    rates = np.linalg.solve(wrist.jacobian(positions), twist)
    np.testing.assert_allclose(wrist.rates(positions, twist), rates, rtol=1e-9, atol=1e-9)


@named(JOINTS)
@given(st.data(), st.integers(-2, 2))
def test_inverse_stays_on_the_branch_and_in_the_turn_of_near(wrist, data, turns):
    positions = data.draw(JOINTS[wrist])
    pose = wrist.forward(positions)
    for branch in branches(wrist, positions, turns):
        np.testing.assert_allclose(wrist.forward(branch).rotation, pose.rotation, atol=1e-12)
        np.testing.assert_allclose(wrist.inverse(pose, branch), branch, atol=1e-9)


@named([DOUBLE, OMNI])
@given(bent(1.2))
def test_equation_20_is_the_velocity_of_the_hands_origin(slopes, wrist, positions):
    numeric = slopes(lambda x: wrist.forward(x).position, positions)
    np.testing.assert_allclose(wrist.origin_jacobian(positions), numeric, atol=1e-8)


@pytest.mark.parametrize(
    ('wrist', 'bend'),
    [(SingleHooke(math.radians(30.0)), 30.0), (DOUBLE, 90.0), (OMNI, 90.0)],
    ids=['single', 'double', 'omni'],
)
@given(st.floats(-3.1, 3.1), commands)
def test_the_hand_never_leaves_the_cone_and_can_always_come_back(wrist, bend, azimuth, push):
    assume(max(map(abs, push)) > 0.1)
    *_, made = walked(wrist, start(wrist), out_to(azimuth), 40)
    assert made.scale_factor < 1e-6
    assert [(limit.joint, limit.kind) for limit in made.limits] == [('cone', LimitKind.WORKSPACE)]
    along_forearm = made.state.pose.rotation[0, 0]
    assert along_forearm == pytest.approx(math.cos(math.radians(bend)), abs=1e-7)
    for pushed in walked(wrist, made.state, push, 5):
        assert wrist.clearances(pushed.state.positions)[0].remaining >= -2e-9
    inward = tuple(-x for x in out_to(azimuth))
    assert step(wrist, made.state, inward, 0.05).scale_factor == 1.0


def out_to(azimuth):
    return (0.0, math.cos(azimuth), math.sin(azimuth))


def walked(wrist, state, twist, count):
    for _ in range(count):
        made = step(wrist, state, twist, 0.05)
        yield made
        state = made.state
