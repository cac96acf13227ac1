"""A short form of every attack of the hostile campaign, `make campaign`: nothing is found."""

import signal

import pytest

from hostile import live, others, steps, supervised
from hostile.stage import WRIST, Stage
from hostile.verdict import Verdict
from wrist_control.wrists import WRISTS

STEPS, PERIODS, MESSAGES = 200, 600, 400
SEED = 7


def assert_nothing_found(verdicts):
    for verdict in verdicts:
        assert verdict.good, verdict
    assert sum(verdict.count for verdict in verdicts) >= STEPS


@pytest.mark.parametrize('name', WRISTS)
def test_no_hostile_step_of_a_wrist_finds_anything(name):
    for number, kind in enumerate(steps.KINDS):
        assert_nothing_found(steps.attack(name, kind, STEPS, (SEED, number)))


@pytest.mark.parametrize('name', [name for name in WRISTS if name != 'stewart'])
def test_no_hostile_period_of_a_supervisor_finds_anything(name):
    assert_nothing_found(supervised.attack(name, PERIODS, (SEED, 9)))


@pytest.mark.parametrize('attack', live.ATTACKS, ids=[attack.name for attack in live.ATTACKS])
def test_no_hostile_message_to_live_nodes_finds_anything(graph, attack):
    # Of an operator that is killed a hundred messages are enough: one death.
    count = 100 if 'kill -9 op' in attack.name else MESSAGES
    verdict = live.attacked(attack, count, (SEED,), graph.domain)
    assert verdict.good, verdict
    assert verdict.count >= count


@pytest.fixture
def stage(graph):
    with Stage(graph.domain, Verdict('test')) as stage:
        yield stage


def test_a_node_that_dies_is_found(stage):
    stage.hand()
    stage.until_held()
    stage.check()
    assert stage.verdict.good
    stage.signal('joint_simulator', signal.SIGKILL)
    stage.check()
    assert stage.verdict.dead == 1
    assert 'joint_simulator ended' in stage.verdict.examples[0]


def test_a_node_that_says_nothing_any_more_is_found(stage, monkeypatch):
    stage.start('joint_simulator')
    stage.until(lambda: stage.pulse.spoke('joint_simulator', 0.0), 'no joints')
    monkeypatch.setattr('hostile.stage.PATIENCE', 3.0)
    stage.signal('joint_simulator', signal.SIGSTOP)
    stage.check()
    assert stage.verdict.dead == 1
    assert 'says nothing' in stage.verdict.examples[0]


def test_a_hand_that_moves_faster_than_the_campaign_believes_is_found(stage):
    """The judge hears real commands: of a hand with other limits it finds what it should."""
    stage.hand(joint_rate_limits=[1.0], joint_acceleration_limits=[50.0])
    stage.until_held()
    stage.follows_again()
    assert stage.verdict.limits > 0


def test_a_hand_that_moves_while_it_should_rest_is_found(stage):
    stage.hand()
    stage.until_held()
    stage.start('operator', maneuver='constant', constant_rates=[0.2, 0.0, 0.0])
    stage.until(lambda: stage.verdict.uncommanded, 'it does not move')
    assert stage.verdict.limits == stage.verdict.nonfinite == stage.verdict.dead == 0


def test_a_number_that_is_none_is_found_on_any_topic(stage):
    stage.finite(others.TwistStamped, 'platform_twist')
    publisher = stage.publisher(others.TwistStamped, 'platform_twist')
    message = others.TwistStamped()
    message.twist.linear.z = float('nan')
    publisher.publish(message)
    stage.until(lambda: stage.verdict.nonfinite == 1, 'it is not found')


def test_the_hand_that_is_attacked_is_one_of_ours():
    assert WRIST in WRISTS
