"""The mechanism in three dimensions, as `Wrist.bodies` says."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from nicegui import ui
from nicegui.elements.scene.scene_object3d import Object3D

from wrist_control.rotations import IDENTITY, Pose, Vector, to_forearm
from wrist_control.web.reach import edge_of_reach
from wrist_control.wrists import Wrist
from wrist_control.wrists.body import HAND, Ball, Body, Rod, colours, turn_of_z
from wrist_control.wrists.surface import placed, triangles

# Three.js sees best what is about as large as one: 1 m is so much there.
SCALE = 10.0
# The trail: so many points at most, so far apart at least, m.
TRAIL, APART = 160, 0.002
DOT = 0.015  # of the probe's length
LOST, EDGE = '#f43f5e', '#f59e0b'
BACKGROUND = '#0d131b'
# Where the camera stands, as a direction, and how far away in sizes of the mechanism.
CAMERA: Vector = (0.72, -1.0, 0.55)
AWAY = 1.2


class Surface(Object3D, component='surface.js'):
    """A surface of triangles."""

    def __init__(self, shown: np.ndarray) -> None:
        """Make one.

        Args:
            shown: Triangles, shape (n, 3, 3), m.
        """
        super().__init__((SCALE * shown).ravel().round(4).tolist())


class WristScene:
    """One wrist: its bodies, the way of its probe, the axis that it is losing, its edge."""

    def __init__(self) -> None:
        """Make an empty scene in the present place of the page."""
        self._scene = ui.scene(
            width=300,
            height=300,
            grid=False,
            fps=30,
            background_color=BACKGROUND,
            camera=ui.scene.perspective_camera(fov=38, near=0.05, far=200),
        ).classes('mechanism')
        self._wrist: Wrist | None = None
        self._bodies: list[Object3D] = []
        self._poses: list[Pose] = []
        self._tips: list[list[float]] = []

    def show(self, wrist: Wrist) -> None:
        """Show another wrist, or the same one with other limits."""
        bodies = wrist.bodies(wrist.home)
        same = self._wrist is not None and self._wrist.bodies(self._wrist.home) == bodies
        self._wrist = wrist
        if same:
            return
        self._scene.clear()
        with self._scene:
            self._bodies = [
                self._body(body, colour)
                for body, colour in zip(bodies, colours(bodies), strict=True)
            ]
            self._tips = []
            self._trail = self._scene.point_cloud([[0.0, 0.0, 0.0]], point_size=0.025)
            self._trail.material(HAND)
            reach = math.hypot(*wrist.probe)
            axis = Rod((0.0, 0.0, -0.7 * reach), (0.0, 0.0, 0.7 * reach), DOT * reach)
            self._lost = Surface(triangles(axis)).material(LOST)
            edge = edge_of_reach(wrist)
            for tip in edge:
                Surface(triangles(Ball(tip, DOT * reach))).material(EDGE)
        self._poses = [Pose(IDENTITY)] * len(bodies)
        self._look_at(bodies, edge)

    @staticmethod
    def _body(body: Body, colour: str) -> Object3D:
        return Surface(np.concatenate([triangles(shape) for shape in body.shapes])).material(
            colour
        )

    def _look_at(self, bodies: Sequence[Body], edge: Sequence[Vector]) -> None:
        corners = np.concatenate(
            [
                placed(triangles(shape).reshape(-1, 3), body.pose)
                for body in bodies
                for shape in body.shapes
            ]
            + [np.array([tip]) for tip in edge]
        )
        low, high = corners.min(axis=0), corners.max(axis=0)
        centre = SCALE * 0.5 * (low + high)
        size = SCALE * float(np.linalg.norm(high - low))
        x, y, z = (AWAY * size / math.hypot(*CAMERA) * part for part in CAMERA)
        cx, cy, cz = centre.tolist()
        self._scene.move_camera(cx + x, cy + y, cz + z, cx, cy, cz, 0, 0, 1, duration=0.0)

    def move(self, positions: Sequence[float], lost_axis: Vector, margin: float) -> None:
        """Show the mechanism at other joint positions.

        Args:
            positions: Joint positions, rad or m.
            lost_axis: Unit vector in hand axes.
            margin: 0 at lock: the axis is shown the better the nearer it is.
        """
        assert self._wrist is not None
        bodies = self._wrist.bodies(self._wrist.resolve_assembly(positions, self._hand))
        for index, (shown, body) in enumerate(zip(self._bodies, bodies, strict=True)):
            if body.pose != self._poses[index]:
                self._poses[index] = body.pose
                _place(shown, body.pose)
        hand = bodies[-1].pose
        _place(self._lost, Pose(_turned_to(hand, lost_axis), hand.position))
        self._lost.material(LOST, opacity=max(0.0, min(1.0, 1.0 - 2.5 * margin)))
        self._follow(hand.point(self._wrist.probe))

    @property
    def _hand(self) -> Pose:
        assert self._wrist is not None
        return self._poses[-1] if self._tips else self._wrist.forward(self._wrist.home)

    def _follow(self, tip: Vector) -> None:
        point = [SCALE * part for part in tip]
        if self._tips and math.dist(point, self._tips[-1]) < SCALE * APART:
            return
        self._tips = [*self._tips[1 - TRAIL :], point]
        self._trail.set_points(self._tips)


def _turned_to(hand: Pose, axis: Vector) -> tuple[float, float, float, float]:
    """Return the turn that takes z to an axis that is given in hand axes."""
    return turn_of_z(to_forearm(hand.quaternion, axis)) if any(axis) else IDENTITY


def _place(shown: Object3D, pose: Pose) -> None:
    x, y, z = pose.position
    shown.move(SCALE * x, SCALE * y, SCALE * z)
    shown.rotate_R(pose.rotation.T.round(6).tolist())
