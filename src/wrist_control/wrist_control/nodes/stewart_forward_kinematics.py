"""The forward kinematics of a platform: leg lengths in, or servo angles, proved poses out."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from typing import Any, ClassVar

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseWithCovariance, PoseWithCovarianceStamped, TwistStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from wrist_control.errors import RefusedError
from wrist_control.nodes.resolver_settings import mechanism, mechanism_specs
from wrist_control.resolving.commands import check_not_ahead
from wrist_control.resolving.platform_observer import (
    Observed,
    Observer,
    ObserverSettings,
    in_metres_and_radians,
)
from wrist_control.ros import convert
from wrist_control.ros.diagnostics import OK, WARN, Diagnostics
from wrist_control.ros.guarded import GuardedNode
from wrist_control.ros.parameters import FRAME, Spec
from wrist_control.ros.qos import NEWEST, OUTPUT
from wrist_control.ros.running import run
from wrist_control.ros.wrong_types import WrongTypes
from wrist_control.wrists import wrist_class
from wrist_control.wrists.platform import Platform
from wrist_interfaces.msg import ForwardKinematicsStatus

# What a reading is good for when nobody says: its noise, and the fastest that a joint moves.
NOISE = {'m': 1e-4, 'rad': 1e-3}
FASTEST = {'m': 0.5, 'rad': 6.0}


def specs(wrist_name: str) -> list[Spec]:
    """Return the parameters of the forward kinematics of a platform."""
    kind = platform_class(wrist_name)
    unit, drive, measured = kind.unit, kind.drive, kind.measured
    each, least = f'one for each {drive}, or one for all', 0.0 if unit == 'm' else -math.inf
    return [
        *mechanism_specs(wrist_name),
        Spec(
            'joint_lower_limits',
            [least],
            f'Least {measured} that counts, {each}',
            unit,
            least,
        ),
        Spec(
            'joint_upper_limits',
            [math.inf],
            f'Largest {measured} that counts, {each}',
            unit,
            least,
        ),
        Spec(
            f'{measured}_noise',
            [NOISE[unit]],
            f'Standard deviation of a reading, {each}',
            unit,
            0.0,
        ),
        Spec(
            'jump_limit',
            FASTEST[unit],
            f'The fastest that a {drive} moves, and the platform no faster than the end of its '
            f'rod; readings further apart are refused; .inf for no limit',
            f'{unit}/s',
            1e-6,
        ),
        Spec(
            'gap_limit',
            1.0,
            'After this long without a good pose the platform must be home again',
            's',
            0.001,
            3600.0,
        ),
        Spec('base_frame', 'forearm', 'Name of the frame that platform_pose is given in', FRAME),
        Spec('platform_frame', 'hand', 'Name of the frame that platform_twist is given in', FRAME),
        Spec('joint_prefix', '', 'Put before every joint name'),
    ]


def platform_class(wrist_name: str) -> type[Platform]:
    """Return the class of a platform by its name."""
    kind = wrist_class(wrist_name)
    assert issubclass(kind, Platform)
    return kind


SPECS = specs('stewart')
# In place of a bound that is not known: nothing that is not finite leaves a node.
UNKNOWN = -1.0


class StewartForwardKinematics(GuardedNode):
    """Publishes the pose of the platform, and how much of it is proved.

    `platform_pose` and `platform_twist` are published for a CONVERGED answer only: whoever hears
    them need not listen to `forward_kinematics_status` to be safe. That is published for every
    reading that could be one of this platform's, and NO_DATA once a second until the first.

    Attributes:
        wrist_name: Which platform, by the registry of wrists.
    """

    wrist_name: ClassVar[str] = 'stewart'

    def __init__(self, **node_options: Any) -> None:
        """Declare the parameters and start listening.

        Args:
            node_options: Passed on to rclpy.

        Raises:
            WristError: A parameter cannot be used; the sentence says why.
        """
        super().__init__(f'{self.wrist_name}_forward_kinematics', **node_options)
        self._values = values = self.declare(specs(self.wrist_name))
        self._wrist = wrist = self._platform()
        noise = values[f'{wrist.measured}_noise']
        self._observer = Observer(
            wrist, ObserverSettings(noise, values['jump_limit'], values['gap_limit'])
        )
        self._status = ForwardKinematicsStatus(
            status=ForwardKinematicsStatus.NO_DATA,
            error_bound=UNKNOWN,
            message=f'No {wrist.drive} {wrist.measured}s have come yet; is joint_states '
            f'published, with {wrist.drive}_1 to {wrist.drive}_6 in it?',
        )
        self._last_good = self.get_clock().now()  # or the start, before the first
        self._refused = ''
        self._diagnostics = Diagnostics(self, self._health)
        self._wrong_types = WrongTypes(self, {'joint_states': 'sensor_msgs/msg/JointState'})
        self._poses = self.create_publisher(PoseWithCovarianceStamped, 'platform_pose', OUTPUT)
        self._twists = self.create_publisher(TwistStamped, 'platform_twist', OUTPUT)
        self._statuses = self.create_publisher(
            ForwardKinematicsStatus, 'forward_kinematics_status', OUTPUT
        )
        self.create_subscription(JointState, 'joint_states', self._on_joint_states, NEWEST)
        self._waiting = self.create_timer(1.0, self._wait, clock=self.steady)

    def _platform(self) -> Platform:
        values = self._values
        wrist = mechanism(self.wrist_name, values).with_limits(
            lower=values['joint_lower_limits'], upper=values['joint_upper_limits']
        )
        named = [
            joint._replace(name=values['joint_prefix'] + joint.name) for joint in wrist.joints
        ]
        platform = replace(wrist, joints=tuple(named))
        assert isinstance(platform, Platform)
        return platform

    def _on_joint_states(self, message: JointState) -> None:
        stamp = message.header.stamp
        if convert.seconds(stamp) is None:
            stamp = self.get_clock().now().to_msg()
        seconds = convert.seconds_of(stamp.sec * 10**9 + stamp.nanosec)
        ahead = seconds - convert.seconds_of(self.get_clock().now().nanoseconds)
        try:
            check_not_ahead('reading', ahead)
            observed = self._observer.take(message.name, message.position, seconds)
        except RefusedError as error:
            self._refuse(error)
            return
        if observed.solution.pose is None:
            reason = observed.solution.status.name.lower()
            self._refuse(RefusedError(reason, observed.message))
        elif observed.covariance is not None:
            self._last_good, self._refused = self.get_clock().now(), ''
        self._publish(self._with_twist(observed, message), stamp)

    def _with_twist(self, observed: Observed, message: JointState) -> Observed:
        try:
            return self._observer.with_twist(observed, message.name, message.velocity)
        except RefusedError as error:
            self._refuse(error)
            return observed

    def _refuse(self, error: RefusedError) -> None:
        self._refused = str(error)
        self._diagnostics.refuse('joint_states', error)

    def _publish(self, observed: Observed, stamp: Time) -> None:
        self._waiting.cancel()
        in_base = Header(stamp=stamp, frame_id=self._values['base_frame'])
        in_platform = Header(stamp=stamp, frame_id=self._values['platform_frame'])
        if observed.covariance is not None and observed.solution.pose is not None:
            pose = convert.pose_message(in_base, observed.solution.pose).pose
            covariance = observed.covariance.ravel()
            self._poses.publish(
                PoseWithCovarianceStamped(
                    header=in_base, pose=PoseWithCovariance(pose=pose, covariance=covariance)
                )
            )
        if observed.twist is not None:
            twist = convert.twist_message(observed.twist)
            self._twists.publish(TwistStamped(header=in_platform, twist=twist))
        self._status = self._status_message(in_base, observed)
        self._statuses.publish(self._status)

    def _status_message(self, header: Header, observed: Observed) -> ForwardKinematicsStatus:
        error, unique = in_metres_and_radians(observed.solution, self._wrist.size)
        return ForwardKinematicsStatus(
            header=header,
            status=int(observed.solution.status),
            iterations=observed.solution.iterations,
            error_bound=error if math.isfinite(error) else UNKNOWN,
            unique_radius=unique,
            message=observed.message,
        )

    def _wait(self) -> None:
        stamp = self.get_clock().now().to_msg()
        self._status.header = Header(stamp=stamp, frame_id=self._values['base_frame'])
        self._statuses.publish(self._status)

    def _health(self) -> tuple[bytes, str, dict[str, str]]:
        status = self._status
        age = 1e-9 * (self.get_clock().now() - self._last_good).nanoseconds
        values = {
            'status': str(status.status),
            'iterations': str(status.iterations),
            'error bound': f'{status.error_bound:.3g}',
            'unique radius': f'{status.unique_radius:.3g}',
            'time without a good pose': f'{age:.3f} s',
            'last refused': self._refused or 'nothing since the last good pose',
        }
        for (publisher, topic), sentence in self._wrong_types.found.items():
            values[f'{publisher} on {topic}'] = sentence
        if status.status != ForwardKinematicsStatus.CONVERGED or self._wrong_types.found:
            return WARN, status.message, values
        if age > self._values['gap_limit']:
            return WARN, f'No good pose for {age:.1f} s; check joint_states.', values
        return OK, status.message, values


def main() -> None:
    """Run the forward kinematics of the Stewart platform."""
    sys.exit(run(StewartForwardKinematics))
