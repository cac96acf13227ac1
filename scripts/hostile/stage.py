"""Live nodes as users start them, in a domain of their own, and somebody who listens to all."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from functools import partial
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from types import TracebackType
from typing import Any

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, Twist
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray
from std_srvs.srv import SetBool

from hostile.listening import Judge, Pulse, floats_of
from hostile.verdict import Verdict
from wrist_control.graph.processes import executable_file
from wrist_control.wrists import Joint, make_wrist
from wrist_interfaces.msg import WristStatus

WRIST, DT = 'three_gimbal', 0.01
# The limits of the hand that is attacked: rad, rad/s, and the time to full speed and to a stop, s.
REACH, RATE, FASTER, SLOWER = 1.2, 0.5, 0.25, 0.1
LIMITS = {
    'joint_lower_limits': [-REACH],
    'joint_upper_limits': [REACH],
    'joint_rate_limits': [RATE],
    'joint_acceleration_limits': [RATE / FASTER],
    'joint_deceleration_limits': [RATE / SLOWER],
}
# So long something that lives may take to answer on a busy machine, s.
PATIENCE = 20.0
EVERYTHING = QoSProfile(depth=2000)


class DeadError(Exception):
    """Something that should live does not answer."""


class Stage:
    """Nodes in processes of their own, and all that is heard of them.

    Attributes:
        verdict: What was found so far.
        node: Who sends everything; spun in a thread of its own.
        judge: Judges `joint_command`.
        pulse: When each node was heard last.
        states: The newest joint states; None before the first.
        attacked: Topics that the attack itself is on: what is heard there is not judged.
    """

    def __init__(
        self, domain: int, verdict: Verdict, progress: Callable[[int], object] = bool
    ) -> None:
        """Start listening.

        Args:
            domain: A ROS domain that nobody else uses.
            verdict: Told of every finding.
            progress: Told how many messages were sent since the last time.
        """
        self.verdict, self._progress = verdict, progress
        self._domain = domain
        self._context = rclpy.Context()
        rclpy.init(context=self._context, domain_id=domain)
        self.node = rclpy.create_node('campaign', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        joints = make_wrist(WRIST).with_limits(
            rates=RATE,
            lower=-REACH,
            upper=REACH,
            accelerations=RATE / FASTER,
            decelerations=RATE / SLOWER,
        )
        self.joints: tuple[Joint, ...] = joints.joints
        self.judge = Judge(self.joints, DT, verdict)
        self.pulse = Pulse()
        self.states: Any = None
        self.attacked: set[str] = set()
        self._processes: dict[str, subprocess.Popen] = {}
        self._commands: dict[str, list[str]] = {}
        self._folder = TemporaryDirectory()
        self.listen(JointState, 'joint_command', self._hear_command)
        self.listen(JointState, 'joint_states', self._hear_joints)
        self.listen(DiagnosticArray, '/diagnostics', self.pulse.hear)
        self.finite(Float64MultiArray, 'joint_velocity_command')
        self.finite(PoseStamped, 'hand_pose')
        self.finite(WristStatus, 'wrist_status')
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._spin, daemon=True)
        self._thread.start()

    def _spin(self) -> None:
        while not self._ended.is_set():
            self._executor.spin_once(timeout_sec=0.1)

    def listen(self, kind: Any, topic: str, heard: Callable[..., object]) -> None:
        """Have something called with every message of a topic."""
        self.node.create_subscription(kind, topic, heard, EVERYTHING)

    def finite(self, kind: Any, topic: str) -> None:
        """See that all is finite that is said on a topic."""

        def hear(message: Any) -> None:
            if topic not in self.attacked and not all(map(math.isfinite, floats_of(message))):
                self.verdict.find('nonfinite', f'{topic}: {message}'[:1000])

        self.listen(kind, topic, hear)

    def _hear_command(self, message: JointState, info: dict[str, Any]) -> None:
        if 'joint_command' not in self.attacked:
            self.judge.hear(message, 1e-9 * info['source_timestamp'])

    def _hear_joints(self, message: JointState) -> None:
        self.states = message
        self.judge.hear_joints(message)

    def start(self, executable: str, **parameters: object) -> None:
        """Start a node in a process of its own, as users do."""
        command = [str(executable_file(executable)), '--ros-args', '--log-level', 'error']
        for name, value in parameters.items():
            command += ['-p', f'{name}:={str(value).lower() if value in (True, False) else value}']
        self._commands[executable] = command
        self.again(executable)

    def again(self, executable: str) -> None:
        """Start a node once more, with the parameters that it had."""
        with Path(self._folder.name, executable).open('a') as said:
            self._processes[executable] = subprocess.Popen(
                self._commands[executable],
                env={**os.environ, 'ROS_DOMAIN_ID': str(self._domain)},
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=said,
                start_new_session=True,
            )

    def hand(self, **parameters: object) -> None:
        """Start a resolver and its joints, and wait until the hand is held."""
        self.start(f'{WRIST}_resolver', **{**LIMITS, **parameters})
        clock = {name: value for name, value in parameters.items() if name == 'use_sim_time'}
        self.start(
            'joint_simulator',
            joints=[joint.name for joint in self.joints],
            joint_rate_limits=[1.1 * RATE],
            **clock,
        )

    def until_held(self) -> None:
        """Wait until joints are commanded."""
        self.until(lambda: self.judge.heard > 0, 'no joint_command')

    def signal(self, executable: str, number: signal.Signals) -> None:
        """Send a signal to a node."""
        process = self._processes[executable]
        process.send_signal(number)
        if number == signal.SIGKILL:
            process.wait()

    def end(self, executable: str) -> None:
        """End a node as users do, and forget it."""
        process = self._processes.pop(executable)
        process.send_signal(signal.SIGINT)
        try:
            code = process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            process.kill()
            code = process.wait()
        if code != 0:
            self.verdict.find('dead', f'{executable} ends with {code}: {self._said(executable)}')

    def publisher(self, kind: Any, topic: str, listeners: int = 1, qos: Any = 10) -> Any:
        """Return a publisher that has found its subscribers."""
        publisher = self.node.create_publisher(kind, topic, qos)
        self.until(lambda: publisher.get_subscription_count() >= listeners, f'no {topic}')
        return publisher

    def client(self, kind: Any, service: str) -> Any:
        """Return a client that has found its service."""
        client = self.node.create_client(kind, service)
        self.until(client.service_is_ready, f'no {service}')
        return client

    def sent(self, count: int = 1) -> None:
        """Count messages that were sent."""
        self.verdict.count += count
        self._progress(count)

    def until(self, condition: Callable[[], object], what: str) -> None:
        """Wait until something is true.

        Raises:
            DeadError: It never is; `what` is missing.
        """
        end = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > end:
                raise DeadError(f'{what} within {PATIENCE:g} s')
            time.sleep(0.01)

    def check(self) -> None:
        """See that every node lives, has met no error that nobody expected, and says so."""
        began = time.monotonic()
        for executable, process in self._processes.items():
            if process.poll() is not None:
                self.verdict.find('dead', f'{executable} ended: {self._said(executable)}')
                continue
            try:
                self.until(
                    partial(self.pulse.spoke, executable, began),
                    f'{executable} says nothing in /diagnostics',
                )
            except DeadError as error:
                self.verdict.find('dead', f'{error}; {self._said(executable)}')
        for node, sentence in self.pulse.errors.items():
            self.verdict.find('dead', f'{node}: {sentence} {self._said(node)}')
        self.pulse.errors.clear()

    def follows_again(self, step: Callable[[], object] = bool) -> None:
        """See that the hand can be enabled, follows, and rests.

        Args:
            step: Called between two commands: a clock may have to go on.
        """
        enable = self.client(SetBool, f'{WRIST}_resolver/enable')
        commands = self.publisher(Twist, 'cmd_vel_unstamped')
        self.judge.go_on()
        asked = [enable.call_async(SetBool.Request(data=True))]
        command, number = Twist(), count()

        def moving() -> bool:
            step()
            if asked[-1].done() and not asked[-1].result().success:
                asked.append(enable.call_async(SetBool.Request(data=True)))
            # To and fro: it may stand at the end of a joint's travel.
            command.angular.x = 0.2 * (-1.0) ** (next(number) // 100)
            self.judge.allow()
            commands.publish(command)
            time.sleep(DT)
            return self.judge.moving

        try:
            self.until(moving, 'the hand does not follow any more')
        except DeadError as error:
            answer = asked[-1].result() if asked[-1].done() else 'no answer'
            self.verdict.find('dead', f'{error}: {answer}')
        commands.publish(Twist())

    def _said(self, executable: str) -> str:
        path = Path(self._folder.name, executable)
        return path.read_text(errors='replace')[-1500:] if path.exists() else ''

    def __enter__(self) -> Stage:
        """Be used in a block."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End every node, and stop listening."""
        for process in self._processes.values():
            process.send_signal(signal.SIGCONT)
            process.kill()
            process.wait()
        # Nothing may be taken away that the other thread still waits for.
        self._ended.set()
        self._thread.join()
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self._context)
        self._folder.cleanup()
