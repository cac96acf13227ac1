"""The live part of the campaign: hostile messages through real nodes, attack by attack."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from hostile import commanding, disturbing, others
from hostile.stage import DeadError, Stage
from hostile.verdict import Verdict
from wrist_control.graph.domains import Domain
from wrist_control.testing.places import Random


class Attack(NamedTuple):
    """One attack on live nodes.

    Attributes:
        name: In the table.
        run: Sends so many messages, or a few more.
        share: How much of all messages it has.
        hand: Whether there is a hand, which must follow again at the end.
    """

    name: str
    run: Callable[[Stage, Random, int], None]
    share: float
    hand: bool = True


ATTACKS = (
    Attack('cmd_vel', commanding.stamped_commands, 0.14),
    Attack('cmd_vel_unstamped', commanding.unstamped_commands, 0.1),
    Attack('joint_states', commanding.joint_states, 0.1),
    Attack('flood', commanding.flood, 0.2),
    Attack('late bursts', commanding.late_bursts, 0.05),
    Attack('two operators', commanding.two_operators, 0.04),
    Attack('30 % lost, 0.2 s late', commanding.loss_and_delay, 0.03),
    Attack('stop and enable', commanding.stops, 0.03),
    Attack('deadman', commanding.deadman, 0.04, hand=False),
    Attack('clock jumps', disturbing.clock_jumps, 0.04, hand=False),
    Attack('SIGSTOP resolver', disturbing.stopped_resolver, 0.02),
    Attack('SIGSTOP joint_simulator', disturbing.stopped_joints, 0.02),
    Attack('kill -9 joint_simulator', disturbing.killed_joints, 0.03),
    Attack('kill -9 operator', disturbing.killed_operator, 0.005),
    Attack('parameters and services', disturbing.parameters_and_services, 0.06),
    Attack('joint_simulator', others.joint_simulator, 0.06, hand=False),
    Attack('forward kinematics', others.forward_kinematics, 0.06, hand=False),
    Attack('operator', others.operator, 0.06),
)


def attacked(
    attack: Attack,
    count: int,
    seed: tuple[int, ...],
    domain: int,
    progress: Callable[[int], object] = bool,
) -> Verdict:
    """Make one attack, and return what was found.

    Args:
        attack: Which.
        count: How many messages, at least.
        seed: Chooses everything.
        domain: A ROS domain that nobody else uses.
        progress: Told how many messages were sent since the last time.
    """
    verdict, random = Verdict(f'live: {attack.name}'), np.random.default_rng(seed)
    with Stage(domain, verdict, progress) as stage:
        try:
            attack.run(stage, random, count)
            if attack.hand:
                stage.follows_again()
        except DeadError as error:
            verdict.find('dead', str(error))
        stage.check()
    return verdict


def verdicts(total: int, seed: int, progress: Callable[[int], object]) -> Iterator[Verdict]:
    """Make every attack, one after the other.

    Args:
        total: How many messages of all attacks together, at least.
        seed: Chooses everything.
        progress: Told how many messages were sent since the last time.
    """
    shares = sum(attack.share for attack in ATTACKS)
    for number, attack in enumerate(ATTACKS):
        domain = Domain()
        try:
            count = int(total * attack.share / shares) + 1
            yield attacked(attack, count, (seed, number), domain.number, progress)
        finally:
            domain.release()
