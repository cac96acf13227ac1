"""A mechanism in MuJoCo: servos that are told where to go, and a hand that follows by physics.

Joint positions are in the order of the wrist's joints, rad or m; efforts are N m or N.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import mujoco
import numpy as np

from wrist_control.errors import UnreachableError, UnstableError
from wrist_control.rotations import Pose, Vector

# Nothing moves faster than this in a mechanism at rest, rad/s or m/s.
AT_REST = 1e-9
# A start far from home is neared in this many stages, so that loops stay on their own branch.
STAGES = 50
# A loop is closed when Newton's step is below this, rad or m; it has this many steps for it.
CLOSED, MOST_STEPS = 1e-11, 12
# Nothing that is stable is quicker than this, rad/s² or m/s².
MAD = 1e7


Numbers: TypeAlias = 'Sequence[float] | np.ndarray'


class Settings(NamedTuple):
    """What a mechanism of any wrist is given.

    Attributes:
        step: Time step of the physics, s.
        bandwidth: How quickly each servo moves what it carries, rad/s.
        damping_ratio: Of each servo; 1 reaches the target soonest without passing it.
        effort_limit: Most that a servo can do, N m or N.
        friction: Dry friction in every driven joint, N m or N.
        payload: What hangs at the end of the hand's probe, kg.
        gravity: Forearm axes, m/s².
        balanced: The links have counterweights, so that gravity pulls at the payload alone.
    """

    step: float = 0.0005
    bandwidth: float = 100.0
    damping_ratio: float = 1.0
    effort_limit: float = math.inf
    friction: float = 0.0
    payload: float = 0.0
    gravity: Vector = (0.0, 0.0, 0.0)
    balanced: bool = False


class Mechanism:
    """A wrist's links, joints and servos, moved by MuJoCo.

    Attributes:
        model: MuJoCo's model, for whoever needs more than this class offers.
        data: Its state; after changing it, `refresh`.
        joints: Names of the driven joints, in the order of every array here.
        size: Characteristic length of the mechanism, m.
    """

    def __init__(
        self, spec: mujoco.MjSpec, joints: Sequence[str], size: float, settings: Settings
    ) -> None:
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.joints = tuple(joints)
        self.size = size
        self.settings = settings
        own = [self.model.joint(name) for name in self.joints]
        self._places = np.array([joint.qposadr[0] for joint in own])
        self._freedoms = np.array([joint.dofadr[0] for joint in own])
        self._servos = np.array([self.model.actuator(name).id for name in self.joints])
        self._hand = self.model.body('hand').id
        self._time = 0.0
        self.refresh()
        self._tune()
        self._firm = 1.0
        self._firm = self.firmness
        self._target = self.positions
        self._target_rates = np.zeros(len(self.joints))

    @property
    def positions(self) -> np.ndarray:
        """Joint positions, rad or m."""
        return self.data.qpos[self._places].copy()

    @property
    def rates(self) -> np.ndarray:
        """Joint rates, rad/s or m/s."""
        return self.data.qvel[self._freedoms].copy()

    @property
    def efforts(self) -> np.ndarray:
        """What the servos did in the last step, N m or N."""
        return self.data.actuator_force[self._servos].copy()

    @property
    def target(self) -> np.ndarray:
        """Where the servos are told to be by now, rad or m."""
        return self._target.copy()

    @property
    def hand_pose(self) -> Pose:
        """Where the hand is, forearm frame."""
        w, x, y, z = self.data.xquat[self._hand].tolist()
        px, py, pz = self.data.xpos[self._hand].tolist()
        return Pose((w, z, y, x), (px, py, pz))

    @property
    def hand_twist(self) -> np.ndarray:
        """How the hand moves: (vx, vy, vz, p, q, r) in hand axes, m/s and rad/s."""
        found = np.zeros(6)
        body = mujoco.mjtObj.mjOBJ_XBODY
        mujoco.mj_objectVelocity(self.model, self.data, body, self._hand, found, 1)
        return np.concatenate([found[3:], found[:3]])

    @property
    def firmness(self) -> float:
        """How well loops and still drives hold every link: 1 as at home, 0 where one is loose."""
        _, rows = self._loops()
        return float(np.linalg.svd(self._held(rows))[1][-1]) / self._firm

    @property
    def opening(self) -> float:
        """How far a loop or a gear is open at most, m or rad."""
        opened, _ = self._loops()
        return float(np.max(np.abs(opened), initial=0.0))

    def command(self, targets: Numbers, rates: Numbers | None = None) -> None:
        """Tell the servos where to go.

        Args:
            targets: Joint positions, rad or m.
            rates: How the targets move on from there, rad/s or m/s; None for at rest.
        """
        self._target = np.array(targets, dtype=float)
        self._target_rates = np.array([0.0] * len(targets) if rates is None else rates)

    def command_rates(self, rates: Numbers) -> None:
        """Let the servos' targets move on from where they are, rad/s or m/s."""
        self.command(self._target, rates)

    def push(self, force: Numbers, torque: Numbers) -> None:
        """Push at the hand's origin from now on, forearm axes, N and N m."""
        self.data.xfrc_applied[self._hand] = [*force, *torque]

    def advance(self, seconds: float) -> None:
        """Let time pass; what is less than a step is kept for the next call, s.

        Raises:
            UnstableError: The step is too long for what moves.
        """
        self._time += seconds
        while self.data.time < self._time - 0.5 * self.settings.step:
            self._step()

    def settle(self, longest: float = 5.0) -> bool:
        """Let time pass until nothing moves, and tell whether that was reached.

        Args:
            longest: Give up after this time, s.

        Raises:
            UnstableError: The step is too long for what moves.
        """
        for _ in range(round(longest / self.settings.step)):
            self._step()
            fastest = np.max(np.abs(self.data.qvel))
            growing = np.max(np.abs(self.data.qacc)) / self.settings.bandwidth
            if max(fastest, growing) < AT_REST:
                break
        else:
            return False
        self._time = self.data.time
        return True

    def start_at(self, positions: Numbers) -> None:
        """Put the mechanism there at rest, its loops closed, the servos holding it.

        MuJoCo's own constraints close the loops, on the way from home by `STAGES` straight moves.

        Raises:
            UnreachableError: They cannot be closed there.
        """
        mujoco.mj_resetData(self.model, self.data)
        self._time = 0.0
        self.refresh()
        home = self.positions
        for share in np.linspace(0.0, 1.0, STAGES + 1)[1:]:
            self._close(home + share * (np.asarray(positions) - home))
        self.command(positions)

    def refresh(self) -> None:
        """Let everything follow from positions and velocities as they are."""
        mujoco.mj_step1(self.model, self.data)

    def _step(self) -> None:
        """Make a step, with whatever follows from its end known afterwards."""
        # A servo brakes by its rate: told ahead, it lags by nothing at a steady rate.
        ahead = 2.0 * self.settings.damping_ratio / self.settings.bandwidth
        self.data.ctrl[self._servos] = self._target + ahead * self._target_rates
        self._target += self.settings.step * self._target_rates
        mujoco.mj_step2(self.model, self.data)
        if not np.max(np.abs(self.data.qacc)) < MAD:
            raise UnstableError(
                f'The mechanism was torn apart at {self.data.time:g} s with steps of '
                f'{self.settings.step:g} s; choose shorter ones, or a smaller bandwidth.'
            )
        mujoco.mj_step1(self.model, self.data)

    def _loops(self) -> tuple[np.ndarray, np.ndarray]:
        """Return how far loops and gears are open, and how each freedom changes that."""
        closed = self.data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
        rows = self.data.efc_J.reshape(-1, self.model.nv)
        return self.data.efc_pos[closed], rows[closed]

    def _held(self, rows: np.ndarray) -> np.ndarray:
        """Return what loops and drives see of each freedom."""
        return np.vstack([rows, np.eye(self.model.nv)[self._freedoms]])

    def _close(self, positions: np.ndarray) -> None:
        for _ in range(MOST_STEPS):
            self.refresh()
            opened, rows = self._loops()
            missing = np.concatenate([-opened, positions - self.positions])
            move = np.linalg.lstsq(self._held(rows), missing, rcond=None)[0]
            mujoco.mj_integratePos(self.model, self.data.qpos, move, 1.0)
            if np.max(np.abs(move)) < CLOSED:
                self.refresh()
                return
        raise UnreachableError(
            f'The mechanism cannot be assembled at {positions.tolist()}; start it nearer to home.',
            'assembly',
        )

    def _tune(self) -> None:
        """Make every servo as strong as what it carries at home needs, the others held."""
        _, rows = self._loops()
        count = len(self.joints)
        wanted = np.vstack([np.zeros((len(rows), count)), np.eye(count)])
        moves = np.linalg.lstsq(self._held(rows), wanted, rcond=None)[0]
        carried = np.array([self._inertia(move) for move in moves.T])
        stiffness = carried * self.settings.bandwidth**2
        damping = carried * 2.0 * self.settings.damping_ratio * self.settings.bandwidth
        self.model.actuator_gainprm[self._servos, 0] = stiffness
        self.model.actuator_biasprm[self._servos, 1] = -stiffness
        self.model.actuator_biasprm[self._servos, 2] = -damping

    def _inertia(self, move: np.ndarray) -> float:
        """Return what a move of all freedoms carries, kg m² or kg."""
        momentum = np.zeros(self.model.nv)
        mujoco.mj_mulM(self.model, self.data, momentum, np.ascontiguousarray(move))
        return float(move @ momentum)
