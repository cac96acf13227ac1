"""The operator: a scripted maneuver, or constant rates, as commands at a steady rate."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from typing import Any

from geometry_msgs.msg import TwistStamped
from rclpy.node import Node
from std_msgs.msg import Header

from wrist_control.errors import InvalidValueError
from wrist_control.maneuvers import BARKER_SPEED, MANEUVERS, STILL, Maneuver, make_maneuver
from wrist_control.nodes import convert
from wrist_control.nodes.diagnostics import OK, Diagnostics
from wrist_control.nodes.parameters import Spec, declare, watch
from wrist_control.nodes.qos import NEWEST, OUTPUT
from wrist_control.nodes.running import run
from wrist_control.resolving.newest import Newest
from wrist_interfaces.msg import WristStatus

SPECS = [
    Spec('rate', 50.0, 'Commands per second, from the node clock', 'Hz', 1.0, 1000.0),
    Spec(
        'maneuver',
        'hold',
        'What to fly; "constant" publishes constant_rates',
        choices=(*MANEUVERS, 'constant'),
    ),
    Spec('speed', BARKER_SPEED, 'Hand rate that a maneuver is flown at', 'rad/s', 1e-6, 100.0),
    Spec(
        'constant_rates',
        [0.0, 0.0, 0.0],
        'p, q, r of the maneuver "constant"',
        'rad/s',
        -100.0,
        100.0,
        live=True,
    ),
    Spec('listeners', 1.0, 'Subscribers of cmd_vel that a maneuver waits for', '', 0.0, 100.0),
    Spec('frame_id', '', 'Frame of the commands: the hand frame, the forearm frame, or empty'),
]


class Operator(Node):
    """Publishes `cmd_vel`, and watches `wrist_status` as a person watches the hand."""

    def __init__(self, **node_options: Any) -> None:
        """Declare the parameters and start publishing.

        Args:
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used; the sentence says why.
        """
        super().__init__('operator', **node_options)
        self._values = declare(self, SPECS)
        self._maneuver: Maneuver | None = None
        if self._values['maneuver'] != 'constant':
            self._maneuver = make_maneuver(self._values['maneuver'], self._values['speed'])
        self._check(self._values)
        self._began: float | None = None
        self._times_lost: Newest[float] = Newest()
        self._lost_before = self._held_back = 0.0
        self._period = 1.0 / self._values['rate']
        self._done = False
        watch(self, SPECS, self._check, self._values.update)
        self._diagnostics = Diagnostics(self, self._health)
        self._publisher = self.create_publisher(TwistStamped, 'cmd_vel', OUTPUT)
        self.create_subscription(WristStatus, 'wrist_status', self._on_status, NEWEST)
        self.create_timer(self._period, self._tick)

    @staticmethod
    def _check(values: dict[str, Any]) -> None:
        rates = values.get('constant_rates', [0.0, 0.0, 0.0])
        if len(rates) != 3:
            raise InvalidValueError(
                f'constant_rates has {len(rates)} values; give three: p, q and r in rad/s.'
            )

    def _on_status(self, message: WristStatus) -> None:
        if math.isfinite(message.time_lost):
            self._times_lost.put(convert.seconds(message.header.stamp), message.time_lost)

    def _tick(self) -> None:
        now = self.get_clock().now()
        p, q, r = self._rates(convert.seconds_of(now.nanoseconds))
        header = Header(stamp=now.to_msg(), frame_id=self._values['frame_id'])
        twist = convert.twist_message((0.0, 0.0, 0.0, p, q, r))
        self._publisher.publish(TwistStamped(header=header, twist=twist))

    def _rates(self, now: float) -> Sequence[float]:
        if self._maneuver is None:
            rates: Sequence[float] = self._values['constant_rates']
            return rates
        time_lost = self._times_lost.at(now) or 0.0
        if self._began is None:
            if self._publisher.get_subscription_count() < self._values['listeners']:
                return STILL
            self._began, self._lost_before = now, time_lost
        time = now - self._began
        if self._maneuver.waits:
            time -= max(0.0, time_lost - self._lost_before) + self._held_back
        if time >= self._maneuver.duration and not self._done:
            self._done = True
            self.get_logger().info(f'{self._maneuver.name} flown in {now - self._began:.2f} s.')
        order = self._maneuver.order(time, self._period)
        self._held_back += (1.0 - order.share) * self._period
        return order.rates

    def _health(self) -> tuple[bytes, str, dict[str, str]]:
        if self._maneuver is None:
            return OK, f'Publishing constant rates {self._values["constant_rates"]}.', {}
        if self._began is None:
            return OK, 'Waiting for somebody to listen to cmd_vel.', {}
        doing = 'Flown' if self._done else 'Flying'
        return OK, f'{doing} {self._maneuver.name}.', {}


def main() -> None:
    """Run the operator."""
    sys.exit(run(Operator))
