"""One wrist as the console sees it: by topic, and by asking its resolver what it is."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from geometry_msgs.msg import TwistStamped
from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.client import Client
from rclpy.parameter import Parameter, parameter_value_to_python
from rclpy.publisher import Publisher
from rclpy.task import Future
from sensor_msgs.msg import JointState
from std_msgs.msg import Empty, Header
from std_srvs.srv import SetBool, Trigger

from wrist_control.errors import RefusedError, WristError
from wrist_control.nodes.resolver_settings import completed, limited, mechanism
from wrist_control.resolving.joint_order import finite_in_joint_order
from wrist_control.ros import convert
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.parameters import plain
from wrist_control.ros.publishers import publishing
from wrist_control.ros.qos import EVERY_RELIABLE, NEWEST, OUTPUT
from wrist_control.rotations import Vector
from wrist_control.web.samples import OffPath, Sample
from wrist_control.wrists import Wrist
from wrist_interfaces.msg import WristStatus

NOT_THERE = 'No resolver listens here yet: start one, or wait for it, and try again.'
# A resolver that has said nothing for so long, s, is not there.
SILENCE = 1.0
# How often the resolver is looked for, and asked again for its limits, s.
LOOKS_EVERY, ASKS_EVERY = 0.25, 2.0


class WatchedWrist:
    """Follows one wrist's topics, and asks its resolver for what a page wants.

    Everything here is called on the thread of the node; a page reads the attributes, each of
    which is replaced as a whole.

    Attributes:
        prefix: What its topics begin with: empty, or a namespace and a slash.
        wrist: The mechanism with its present limits; None until its resolver has told.
        name: What it is called; empty until then.
        rate_ceilings: The joint rate limits that the resolver had when it was found, rad/s or m/s.
        status: What its resolver said last; None while it is silent.
        positions: Where the joints really are, in joint order; None before they were heard.
        off_path: How far the hand is off the commanded path.
        newest: What was heard last; None before.
        said: What a service answered last, and a number that counts the answers.
    """

    def __init__(self, node: GuardedNode, prefix: str = '') -> None:
        """Begin to listen.

        Args:
            node: The console.
            prefix: What its topics begin with.
        """
        self.prefix = prefix
        self._node = node
        self._commands: Publisher = node.create_publisher(TwistStamped, f'{prefix}cmd_vel', OUTPUT)
        self._stops: Publisher = node.create_publisher(Empty, f'{prefix}stop', OUTPUT)
        node.create_subscription(
            WristStatus, f'{prefix}wrist_status', self._on_status, EVERY_RELIABLE
        )
        node.create_subscription(JointState, f'{prefix}joint_states', self._on_states, NEWEST)
        node.create_subscription(JointState, f'{prefix}joint_command', self._on_command, NEWEST)
        self._clients: dict[str, Client] = {}
        self.said: tuple[int, bool, str] = (0, True, '')
        self._share: float | None = None
        self.lose()
        node.create_timer(LOOKS_EVERY, self._look)

    def lose(self) -> None:
        """Forget the resolver, as if nobody had been there."""
        for client in self._clients.values():
            self._node.destroy_client(client)
        self._clients.clear()
        self._resolver = ''
        self._values: dict[str, Any] = {}
        self._asked = 0.0
        self._wanted_share = self._share  # what a page has set holds for whoever comes next
        self.wrist: Wrist | None = None
        self.name = ''
        self.rate_ceilings: tuple[float, ...] = ()
        self.status: WristStatus | None = None
        self._status_heard = 0.0
        self.positions: tuple[float, ...] | None = None
        self._rates: tuple[float, ...] = ()
        self.off_path: OffPath | None = None
        self.newest: Sample | None = None

    def command(self, rates: Vector) -> None:
        """Ask for hand rates, rad/s."""
        header = Header(stamp=self._node.get_clock().now().to_msg())
        self._commands.publish(convert.command_message(header, rates))

    def stop(self) -> None:
        """Ask for a stop, whoever else asks for motion."""
        self._stops.publish(Empty())

    def enable(self) -> None:
        """Ask the resolver to go on."""
        if not self._ask(SetBool, '~/enable', SetBool.Request(data=True), self._on_answer):
            self._tell(False, NOT_THERE)

    def reset(self) -> None:
        """Ask the resolver to go back to where it began."""
        if not self._ask(Trigger, '~/reset', Trigger.Request(), self._on_answer):
            self._tell(False, NOT_THERE)

    def limit_rates(self, share: float) -> None:
        """Ask the resolver to hold its joints to a share of the rates that it was found with.

        Until it has answered it is asked again and again: a limit shall not be lost on the way.
        """
        self._share = self._wanted_share = share
        self._ask_for_limits()

    def _ask_for_limits(self) -> None:
        if self._wanted_share is None or not self.rate_ceilings:
            return
        limits = [self._wanted_share * ceiling for ceiling in self.rate_ceilings]
        limit = Parameter('joint_rate_limits', Parameter.Type.DOUBLE_ARRAY, limits)
        request = SetParameters.Request(parameters=[limit.to_parameter_msg()])
        self._ask(SetParameters, '~/set_parameters', request, self._on_set)

    def _look(self) -> None:
        """See who resolves this wrist, and ask for what it is."""
        now = time.monotonic()
        if self.status is not None and now - self._status_heard > SILENCE:
            self.lose()
        names = publishing(self._node, f'{self.prefix}wrist_status')
        if self._resolver not in names:
            self.lose()
            self._resolver = names[0] if names else ''
        self._ask_for_limits()
        is_due = self._resolver and now - self._asked > ASKS_EVERY
        listing = ListParameters, '~/list_parameters', ListParameters.Request(), self._on_list
        if is_due and self._ask(*listing):
            self._asked = now

    def _ask(self, kind: Any, service: str, request: Any, answer: Callable[[Any], None]) -> bool:
        """Ask the resolver something; return whether it listens, and will be heard by `answer`."""
        if not self._resolver:
            return False
        name = service.replace('~', self._resolver)
        if name not in self._clients:
            self._clients[name] = self._node.create_client(kind, name)
        client = self._clients[name]
        if not client.service_is_ready():
            return False
        client.call_async(request).add_done_callback(
            partial(self._on_done, self._resolver, answer)
        )
        return True

    def _on_done(self, resolver: str, answer: Callable[[Any], None], future: Future) -> None:
        """Hand an answer on, unless it is of a resolver that is gone."""
        if resolver == self._resolver and (result := future.result()) is not None:
            answer(result)

    def _on_answer(self, answer: Any) -> None:
        self._tell(answer.success, answer.message)

    def _on_set(self, answer: SetParameters.Response) -> None:
        self._asked, self._wanted_share = 0.0, None
        (result,) = answer.results
        if not result.successful:
            self._tell(False, result.reason)

    def _tell(self, success: bool, sentence: str) -> None:
        self.said = (self.said[0] + 1, success, sentence)

    def _on_list(self, answer: ListParameters.Response) -> None:
        names = list(answer.result.names)
        self._ask(
            GetParameters,
            '~/get_parameters',
            GetParameters.Request(names=names),
            partial(self._on_values, names),
        )

    def _on_values(self, names: list[str], answer: GetParameters.Response) -> None:
        found = {
            name: plain(parameter_value_to_python(value))
            for name, value in zip(names, answer.values, strict=True)
        }
        if found == self._values:
            return
        self._values = found
        try:
            self._become(found)
        except (WristError, KeyError) as error:
            self.wrist = None
            self._tell(False, f'{self._resolver} does not say which wrist it moves ({error}).')

    def _become(self, values: Mapping[str, Any]) -> None:
        wrist = limited(mechanism(values['wrist'], values), completed(values))
        if not self.rate_ceilings:
            self.rate_ceilings = tuple(joint.rate_limit for joint in wrist.joints)
        if self.off_path is None:
            self.off_path = OffPath(wrist)
        self.wrist, self.name = wrist, values['wrist']

    def _on_status(self, message: WristStatus) -> None:
        now = time.monotonic()
        before, self.status, self._status_heard = self.status, message, now
        if self.wrist is None or self.off_path is None:
            return
        commanded, achieved = (
            convert.twist_values(twist)[3:] for twist in (message.commanded, message.achieved)
        )
        if before is not None and message.time_lost < before.time_lost:
            self.off_path.clear()
        self.off_path.follow(commanded, achieved, message.scale_factor, self._dt)
        rates = self._rates or (0.0,) * len(self.wrist.joints)
        self.newest = Sample(now, commanded, achieved, message.scale_factor, message.margin, rates)

    @property
    def _dt(self) -> float:
        return 1.0 / float(self._values['rate'])

    def _on_states(self, message: JointState) -> None:
        self.positions = self._in_order(message.name, message.position) or self.positions

    def _on_command(self, message: JointState) -> None:
        self._rates = self._in_order(message.name, message.velocity) or self._rates

    def _in_order(self, names: Any, values: Any) -> tuple[float, ...] | None:
        """Return values in joint order; None where they are not this wrist's, or not numbers."""
        if self.wrist is None:
            return None
        prefix = self._values['joint_prefix']
        plain = [name.removeprefix(prefix) for name in names]
        joints = [joint.name for joint in self.wrist.joints]
        try:
            return finite_in_joint_order(joints, plain, values)
        except RefusedError:
            return None
