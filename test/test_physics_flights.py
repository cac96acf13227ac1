"""Teleoperation over physics, by topic only: flights, joints that fail, a start on what sags."""

import math

import numpy as np
import pytest
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState

from wrist_control import make_wrist
from wrist_control.nodes.resolver_settings import CAREFUL, SLOWING_DOWN
from wrist_control.physics.models import MODELS
from wrist_interfaces.msg import WristStatus

from .physics_flown import RATE, PhysicsFlown

LOADED = {'payload': 0.5}
# A head on rods of 85 mm carries a tenth of that, and no links of 0.2 kg, as every wrist has here:
# under those its servos sag so far at the edge of its workspace that it goes through lock.
LOADS = {'rotary_stewart': {'payload': 0.05, 'balanced': True}}
# How far a joint turns, or slides, at least: platforms meet their edges on the way.
LEAST_TURNED = {'stewart': 0.02, 'rotary_stewart': 0.4}
PLATFORMS = ('stewart', 'rotary_stewart')
# How far the hand is from where it was told to be at most, in turn, rad, and in place, m.
TURN, PLACE = 0.015, 0.001
# Nearer to lock than this margin the Stewart platform's legs no longer hold it well: what they
# sag by is a hundred times as much at the hand.
NEAR_LOCK, TURN_NEAR_LOCK, PLACE_NEAR_LOCK = 0.3, 0.25, 0.05


def steepest(commands):
    """Return by how much a joint's commanded rate changes from tick to tick at most."""
    return np.abs(np.diff([command.velocity for command in commands], axis=0)).max(axis=0)


def gentlest_stop(wrist):
    """Return by how much a joint's rate may change in a tick on the way to a stop."""
    return [CAREFUL[joint.kind] / SLOWING_DOWN / RATE for joint in make_wrist(wrist).joints]


@pytest.mark.parametrize('wrist', MODELS)
def test_every_wrist_flies_the_stick_and_the_basic_test_and_the_hand_is_where_it_is_told(
    graph, wrist
):
    flown = PhysicsFlown(graph, wrist, **LOADS.get(wrist, LOADED))
    flown.resolve()
    flown.fly('stick', 64)
    flown.fly('basic_test', 300)
    states = {status.state for status in flown.heard['wrist_status']}
    assert WristStatus.FAULT not in states
    turned = [state.position for state in flown.heard['joint_states']]
    assert np.ptp(turned, axis=0).max() > LEAST_TURNED.get(wrist, 0.7)
    _, turn, place, margin = flown.errors().T
    near_lock = (margin < NEAR_LOCK) & (wrist in PLATFORMS)
    assert np.count_nonzero(~near_lock) > 100
    assert turn[~near_lock].max() < TURN
    assert place[~near_lock].max() < PLACE
    assert turn.max() < TURN_NEAR_LOCK
    assert place.max() < PLACE_NEAR_LOCK


@pytest.mark.parametrize('wrist', MODELS)
def test_a_joint_that_sticks_in_motion_stops_the_hand_in_a_ramp(graph, wrist):
    flown = PhysicsFlown(graph, wrist, **LOADED)
    flown.resolve()
    flown.fly('stick', 20)
    at_rest = len(flown.commands)
    operator = flown.start('basic_test')
    flown.pass_time(0.5)
    fastest = int(np.argmax(np.abs(flown.commands[-1].velocity)))
    stuck = make_wrist(wrist).joints[fastest].name
    flown.physics.set_parameters([Parameter('stuck_joint', value=stuck)])
    sticks_at = flown.heard['joint_states'][-1].position[fastest]
    flown.until(lambda: flown.status.state == WristStatus.FAULT, 100)
    assert f'{stuck} is at {sticks_at:.2f}'[:-1] in flown.status.message
    assert 'it does not follow.' in flown.status.message
    flown.pass_time(0.5)
    assert np.all(steepest(flown.commands[at_rest:]) <= np.multiply(gentlest_stop(wrist), 1.001))
    assert not any(flown.commands[-1].velocity)
    hand = [one.pose.position.x for one in flown.heard['true_hand_pose'][-5:]]
    assert np.ptp(hand) < 1e-4
    assert flown.status.state == WristStatus.FAULT
    flown.stop(operator)


def test_servos_that_are_told_rates_follow_as_well(graph):
    """Nothing corrects what a lost message leaves behind: the hand is where they add up to."""
    flown = PhysicsFlown(graph, 'three_gimbal', command='joint_velocity_command', **LOADED)
    flown.resolve()
    flown.fly('stick', 64)
    assert np.ptp([state.position for state in flown.heard['joint_states']], axis=0).max() > 0.2
    assert flown.errors()[:, 1].max() < 2.0 * TURN


def test_a_servo_that_can_do_no_more_stops_the_hand_in_a_ramp(graph):
    """The hand stands upright at first, and its payload is heavier the further it is tilted."""
    flown = PhysicsFlown(
        graph, 'three_gimbal', payload=1.0, gravity=[-9.8, 0.0, 0.0], effort_limits=[0.7]
    )
    flown.resolve()
    operator = flown.start('basic_test')
    flown.until(lambda: flown.status.state == WristStatus.FAULT, 150)
    assert flown.status.message.startswith('theta is at')
    flown.pass_time(0.3)
    efforts = np.abs([state.effort for state in flown.heard['joint_states']])
    assert efforts.max() == pytest.approx(0.7)
    assert np.all(steepest(flown.commands) <= np.multiply(gentlest_stop('three_gimbal'), 1.001))
    assert not any(flown.commands[-1].velocity)
    flown.stop(operator)


@pytest.mark.parametrize('wrist', MODELS)
def test_a_resolver_that_starts_on_a_moving_sagging_mechanism_does_not_jump(graph, wrist):
    """Its first command is where the joints came to rest; the servos sag once more from there."""
    flown = PhysicsFlown(graph, wrist, servo_bandwidth=25.0, loop_delay=0.03, **LOADED)
    told = np.array(make_wrist(wrist).home)
    mover = graph.publisher(JointState, 'joint_command')
    names = [joint.name for joint in make_wrist(wrist).joints]
    away = 0.01 if wrist == 'stewart' else 0.3
    mover.publish(JointState(name=names, position=list(told + away)))
    flown.pass_time(0.1)
    moving = flown.heard['joint_states'][-1]
    assert np.abs(moving.velocity).max() > 0.05 * away
    flown.resolve()
    rested = flown.heard['joint_states'][-1].position
    settled = [state.position for state in flown.heard['joint_states']]
    first = flown.commands[0]
    assert not any(any(command.velocity) for command in flown.commands)
    nearest = np.abs(np.subtract(settled, first.position)).max(axis=1).min()
    assert nearest < 1e-9
    sag = np.abs(np.subtract(rested, told + away)).max()
    flown.pass_time(1.0)
    moved = np.abs(np.subtract(flown.heard['joint_states'][-1].position, rested)).max()
    assert moved < 1.5 * sag + 1e-4
    assert flown.status.state == WristStatus.IDLE
    assert math.isclose(flown.commands[-1].position[0], first.position[0], abs_tol=1e-12)
