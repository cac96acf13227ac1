"""Barker's basic test maneuver through operator, resolver and joints: the library's numbers."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import TwistStamped
from sensor_msgs.msg import JointState

from wrist_control import WRISTS, fly, make_maneuver, make_wrist
from wrist_control.graph.recording import recorded_flight
from wrist_control.nodes.joint_simulator import JointSimulator
from wrist_control.nodes.operator import Operator
from wrist_control.nodes.resolver import Resolver
from wrist_interfaces.msg import WristStatus

RATE = 32.0
TICKS = {math.inf: 240, math.radians(32.0): 330, math.radians(16.0): 600}


def fly_through(graph, limit, maneuver='basic_test', wrist='three_gimbal', ticks=None):
    clock = graph.lockstep(1.0 / RATE)
    common = {'use_sim_time': True, 'rate': RATE}
    names = [joint.name for joint in make_wrist(wrist).joints]
    home = list(make_wrist(wrist).home)
    graph.start(
        Resolver,
        wrist,
        **common,
        joint_rate_limits=[limit],
        free_joints=True,
        require_joint_states=True,
    )
    graph.start(
        JointSimulator,
        **common,
        joint_rate_limits=[limit],
        joints=names,
        initial_positions=home,
    )
    clock.listen(
        {'wrist_status': WristStatus, 'joint_command': JointState, 'joint_states': JointState}
    )
    clock.begin()
    graph.start(Operator, **common, maneuver=maneuver, listeners=2.0)
    clock.listen({'cmd_vel': TwistStamped})
    clock.begin()
    for _ in range(ticks or TICKS[limit]):
        clock.tick()
    limited = make_wrist(wrist).with_limits(rates=limit)
    return recorded_flight(limited, make_maneuver(maneuver), 1.0 / RATE, clock.heard)


@pytest.mark.parametrize('limit', [math.inf, math.radians(32.0)])
def test_the_graph_flies_what_the_library_flies(graph, limit):
    flown = fly_through(graph, limit)
    alone = fly('three_gimbal', 'basic_test', RATE, joint_rate_limits=limit)
    for name in ('joint_positions', 'joint_rates', 'scale_factor', 'time_lost', 'tip', 'command'):
        np.testing.assert_allclose(getattr(flown, name), getattr(alone, name), atol=1e-12)


def test_the_joints_never_move_faster_than_their_limit(graph):
    limit = math.radians(32.0)
    flown = fly_through(graph, limit)
    increments = np.abs(np.diff(flown.joint_positions, axis=0)) * RATE
    assert increments.max() <= limit * (1.0 + 1e-8)


def test_half_the_limit_costs_the_same_as_in_the_library_within_two_steps(graph):
    """Every command is scaled here, and the operator sees it one step late."""
    limit = math.radians(16.0)
    flown = fly_through(graph, limit)
    alone = fly('three_gimbal', 'basic_test', RATE, joint_rate_limits=limit)
    assert flown.time_lost[-1] == pytest.approx(alone.time_lost[-1], abs=2.0 / RATE)


@pytest.mark.parametrize('wrist', WRISTS)
def test_the_graph_of_every_wrist_flies_what_the_library_flies(graph, wrist):
    limit = math.radians(28.0)  # a little less than is asked for
    flown = fly_through(graph, limit, 'basic_test', wrist, ticks=100)
    alone = fly(wrist, 'basic_test', RATE, joint_rate_limits=limit)
    rows = 40  # the graph was stopped on its way
    for name in ('joint_positions', 'joint_rates', 'scale_factor', 'time_lost', 'hand_rotation'):
        np.testing.assert_allclose(
            getattr(flown, name)[:rows], getattr(alone, name)[:rows], atol=1e-9, err_msg=name
        )
