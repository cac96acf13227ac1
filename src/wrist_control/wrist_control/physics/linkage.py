"""What mechanisms are put together from: links, joints, servos, gears and closed loops.

A linkage is drawn at home. A link stands where its own axes are, in the axes of its parent.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import mujoco

from wrist_control.physics.mechanism import Mechanism, Settings
from wrist_control.rotations import IDENTITY, Quaternion, Vector, xyzw

ORIGIN: Vector = (0.0, 0.0, 0.0)
X: Vector = (1.0, 0.0, 0.0)
Y: Vector = (0.0, 1.0, 0.0)
Z: Vector = (0.0, 0.0, 1.0)

# Of a link, kg, and its radius of gyration as a share of the mechanism's size.
MASS, GYRATION = 0.2, 0.3
# What a gear drive adds to its joint: this mass, kg, moved like the joint if that slides, and at
# the end of a lever as long as the mechanism if it turns.
ROTOR = 1.0
# The same of a joint without drive. Without any, a loop of light links explodes.
PASSIVE = 1e-3
# A loop is pulled together over this many steps, and takes this share of any load at once: as hard
# as MuJoCo lets it. What it gives way to a load falls with the square of the step.
PULL, HOLD = 2.0, 0.9999
# Where the solver stops: at 0 it would go on in its round-off, seven times as long.
TOLERANCE = 1e-14


class Linkage:
    """A mechanism in the making.

    Attributes:
        forearm: The body that does not move.
    """

    def __init__(self, size: float, settings: Settings) -> None:
        self._size = size
        self._settings = settings
        self._softness = (PULL * settings.step, 1.0), (HOLD, HOLD, 0.001, 0.5, 2.0)
        self._spec = mujoco.MjSpec()
        self._spec.compiler.degree = False
        self._spec.option.timestep = settings.step
        self._spec.option.gravity = settings.gravity
        self._spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        self._spec.option.tolerance = TOLERANCE
        self._spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE  # as it is read
        # Links pass through each other; what goes out of bounds is said, not put back at home.
        off = mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_AUTORESET
        self._spec.option.disableflags = int(off)
        self.forearm = self._spec.worldbody

    def link(
        self,
        parent: mujoco.MjsBody,
        name: str,
        at: Vector = ORIGIN,
        turn: Quaternion = IDENTITY,
    ) -> mujoco.MjsBody:
        """Return a new link, which without a joint is fixed to its parent.

        Args:
            parent: The link that it is mounted on.
            name: What it is called; `hand` is the hand.
            at: Its origin, parent's axes, m.
            turn: Its attitude in the parent's axes, Barker's quaternion.
        """
        inertia = MASS * (GYRATION * self._size) ** 2
        x, y, z, w = xyzw(turn)
        return parent.add_body(
            name=name,
            pos=at,
            quat=(w, x, y, z),
            mass=MASS,
            ipos=ORIGIN,
            inertia=(inertia,) * 3,
            explicitinertial=True,
            gravcomp=float(self._settings.balanced),
        )

    def hinge(
        self, link: mujoco.MjsBody, name: str, axis: Vector, driven: bool = False, home: float = 0
    ) -> None:
        """Let a link turn about an axis through its origin.

        Args:
            link: What turns.
            name: Of the joint.
            axis: Link's axes.
            driven: Whether a servo turns it.
            home: What the joint reads as drawn, rad.
        """
        lever = self._size * self._size
        self._joint(link, name, mujoco.mjtJoint.mjJNT_HINGE, axis, driven, home, lever)

    def slide(
        self, link: mujoco.MjsBody, name: str, axis: Vector, driven: bool = False, home: float = 0
    ) -> None:
        """Let a link slide along an axis; as `hinge`, but in m."""
        self._joint(link, name, mujoco.mjtJoint.mjJNT_SLIDE, axis, driven, home, 1.0)

    def _joint(
        self,
        link: mujoco.MjsBody,
        name: str,
        kind: mujoco.mjtJoint,
        axis: Vector,
        driven: bool,
        home: float,
        lever: float,
    ) -> None:
        link.add_joint(
            name=name,
            type=kind,
            axis=axis,
            ref=home,
            armature=(ROTOR if driven else PASSIVE) * lever,
            frictionloss=self._settings.friction if driven else 0.0,
            # As hard as a loop, or what shall stand still creeps.
            solref_friction=self._softness[0],
            solimp_friction=self._softness[1],
        )
        if driven:
            limit = self._settings.effort_limit
            self._spec.add_actuator(
                name=name,
                trntype=mujoco.mjtTrn.mjTRN_JOINT,
                target=name,
                gaintype=mujoco.mjtGain.mjGAIN_FIXED,
                biastype=mujoco.mjtBias.mjBIAS_AFFINE,
                forcelimited=math.isfinite(limit),
                forcerange=(-limit, limit) if math.isfinite(limit) else (0.0, 0.0),
            )

    def ball(
        self, name: str, one: mujoco.MjsBody, at: Vector, other: mujoco.MjsBody, there: Vector
    ) -> None:
        """Close a loop: hold a point of one link at a point of another, each in its own axes, m.

        Args:
            name: Of the joint.
            one: A link.
            at: The point of it.
            other: Another link.
            there: The point of that one.
        """
        ends = (f'{name} of {one.name}', f'{name} of {other.name}')
        one.add_site(name=ends[0], pos=at)
        other.add_site(name=ends[1], pos=there)
        self._hold(name, mujoco.mjtEq.mjEQ_CONNECT, mujoco.mjtObj.mjOBJ_SITE, ends)

    def gear(self, follower: str, leader: str) -> None:
        """Gear a hinge to turn as much as another does."""
        kinds = (mujoco.mjtEq.mjEQ_JOINT, mujoco.mjtObj.mjOBJ_JOINT)
        held = self._hold(f'{follower} as {leader}', *kinds, (follower, leader))
        held.data[1] = 1.0

    def _hold(
        self, name: str, kind: mujoco.mjtEq, what: mujoco.mjtObj, ends: tuple[str, str]
    ) -> mujoco.MjsEquality:
        return self._spec.add_equality(
            name=name,
            type=kind,
            objtype=what,
            name1=ends[0],
            name2=ends[1],
            solref=self._softness[0],
            solimp=self._softness[1],
        )

    def finished(self, hand: mujoco.MjsBody, probe: Vector, joints: Iterable[str]) -> Mechanism:
        """Return the mechanism.

        Args:
            hand: The link that is the hand.
            probe: Where its payload hangs, hand axes, m.
            joints: Names of the driven joints, in the wrist's order.
        """
        payload = self._settings.payload
        if payload > 0.0:
            inertia = payload * (0.1 * self._size) ** 2
            hand.add_body(
                name='payload',
                pos=probe,
                mass=payload,
                ipos=ORIGIN,
                inertia=(inertia,) * 3,
                explicitinertial=True,
            )
        return Mechanism(self._spec, tuple(joints), self._size, self._settings)
