"""Rotations in Barker's convention: quaternions (a1, a2, a3, a4) and direction cosines C.

A trap for everyone who knows other libraries: **the quaternion here is (w, z, y, x)**, the scalar
first and the vector backwards, as the paper prints it. `Pose.xyzw` and `xyzw` give the order of
ROS and SciPy, and `from_xyzw` takes it.

C takes the components of a vector from forearm axes to hand axes, so it is the transpose of the
matrix that turns the forearm into the hand. a1 = cos(μ/2), (a4, a3, a2) = sin(μ/2) (x, y, z) for
a hand turned by μ about the unit vector (x, y, z). [Barker1986], fig. 1(c).

Everything here is plain floats: the mathematics of a resolver step costs less than numpy's
overhead on three-vectors.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
DirectionCosines = tuple[Vector, Vector, Vector]

IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)


class Pose(NamedTuple):
    """Where the hand is: its orientation, and its origin in forearm axes.

    Attributes:
        quaternion: Barker's (a1, a2, a3, a4) = (w, z, y, x), unit length; see `xyzw`.
        position: Origin of the hand axes in forearm axes, m.
    """

    quaternion: Quaternion
    position: Vector = (0.0, 0.0, 0.0)

    @property
    def rotation(self) -> np.ndarray:
        """Barker's C, forearm axes to hand axes, shape (3, 3)."""
        return np.array(direction_cosines(self.quaternion))

    @property
    def xyzw(self) -> Quaternion:
        """The quaternion in the order of ROS and SciPy: x, y, z, w."""
        return xyzw(self.quaternion)

    def point(self, offset: Vector) -> Vector:
        """Return the forearm components of a point given in the axes of the pose, m."""
        x, y, z = self.position
        dx, dy, dz = to_forearm(self.quaternion, offset)
        return (x + dx, y + dy, z + dz)


class Poses(NamedTuple):
    """Many poses as arrays, one row each.

    Attributes:
        quaternion: Barker's (a1, a2, a3, a4) = (w, z, y, x), shape (n, 4).
        position: Origins of the hand axes in forearm axes, m, shape (n, 3).
    """

    quaternion: np.ndarray
    position: np.ndarray


def placed(pose: Pose, local: Pose) -> Pose:
    """Return the forearm pose of what stands somewhere in the axes of a pose."""
    return Pose(product(pose.quaternion, local.quaternion), pose.point(local.position))


def direction_cosines(a: Quaternion) -> DirectionCosines:
    """Return the rows of C for a unit quaternion. [Barker1986], fig. 2(d)."""
    a1, a2, a3, a4 = a
    s1, s2, s3, s4 = a1 * a1, a2 * a2, a3 * a3, a4 * a4
    a12, a13, a14 = 2.0 * a1 * a2, 2.0 * a1 * a3, 2.0 * a1 * a4
    a23, a24, a34 = 2.0 * a2 * a3, 2.0 * a2 * a4, 2.0 * a3 * a4
    return (
        (s1 - s2 - s3 + s4, a34 + a12, a24 - a13),
        (a34 - a12, s1 - s2 + s3 - s4, a23 + a14),
        (a13 + a24, a23 - a14, s1 + s2 - s3 - s4),
    )


def quaternion_of(c: DirectionCosines | np.ndarray) -> Quaternion:
    """Return the quaternion of a direction-cosine matrix, a1 >= 0.

    The largest of the four squares is taken first, so no division is ever by a small number.
    """
    (c11, c12, c13), (c21, c22, c23), (c31, c32, c33) = ((float(x) for x in row) for row in c)
    squares = (
        1.0 + c11 + c22 + c33,
        1.0 - c11 - c22 + c33,
        1.0 - c11 + c22 - c33,
        1.0 + c11 - c22 - c33,
    )
    largest = max(range(4), key=squares.__getitem__)
    products = (
        (squares[0], c12 - c21, c31 - c13, c23 - c32),
        (c12 - c21, squares[1], c23 + c32, c13 + c31),
        (c31 - c13, c23 + c32, squares[2], c12 + c21),
        (c23 - c32, c13 + c31, c12 + c21, squares[3]),
    )[largest]
    a = unit(products)
    return a if a[0] >= 0.0 else negated(a)


def negated(a: Quaternion) -> Quaternion:
    """Return the other quaternion of the same rotation."""
    return (-a[0], -a[1], -a[2], -a[3])


def unit(a: Quaternion) -> Quaternion:
    """Return a quaternion scaled to unit length. [Barker1986], fig. 2(c), normalization."""
    a1, a2, a3, a4 = a
    n = 1.0 / math.sqrt(a1 * a1 + a2 * a2 + a3 * a3 + a4 * a4)
    return (a1 * n, a2 * n, a3 * n, a4 * n)


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Return the rotation a followed by b, b about the axes that a has turned."""
    a1, a2, a3, a4 = a
    b1, b2, b3, b4 = b
    return (
        a1 * b1 - a4 * b4 - a3 * b3 - a2 * b2,
        a1 * b2 + a2 * b1 + a4 * b3 - a3 * b4,
        a1 * b3 + a3 * b1 + a2 * b4 - a4 * b2,
        a1 * b4 + a4 * b1 + a3 * b2 - a2 * b3,
    )


def conjugate(a: Quaternion) -> Quaternion:
    """Return the inverse rotation of a unit quaternion."""
    return (a[0], -a[1], -a[2], -a[3])


def turned(a: Quaternion, rates: Vector, dt: float) -> Quaternion:
    """Return the orientation after turning at constant hand rates for a time.

    Exact for constant rates, however large. [Barker1986], fig. 2(c), whose G must carry a minus
    sign and whose C2 = sin ρ / ω divides by zero at rest: docs/errata.md.

    Args:
        a: Orientation before, a unit quaternion.
        rates: p, q, r about the hand's own x, y, z axes, rad/s.
        dt: Duration, s.
    """
    p, q, r = rates
    omega = math.hypot(p, q, r)  # squares of large rates would overflow
    if omega == 0.0:
        return a
    rho = 0.5 * omega * dt
    c2 = math.sin(rho) / omega
    return unit(product(a, (math.cos(rho), c2 * r, c2 * q, c2 * p)))


def rates_between(a: Quaternion, b: Quaternion, dt: float) -> Vector:
    """Return the constant hand rates that turn a into b in a time, the shorter way, rad/s."""
    d1, d2, d3, d4 = product(conjugate(a), b)
    if d1 < 0.0:
        d1, d2, d3, d4 = -d1, -d2, -d3, -d4
    sine = math.sqrt(d2 * d2 + d3 * d3 + d4 * d4)
    if sine == 0.0:
        return (0.0, 0.0, 0.0)
    scale = 2.0 * math.atan2(sine, d1) / (sine * dt)
    return (d4 * scale, d3 * scale, d2 * scale)


def to_forearm(a: Quaternion, vector: Vector) -> Vector:
    """Return the forearm components of a vector given in hand axes: Cᵀ v."""
    (c11, c12, c13), (c21, c22, c23), (c31, c32, c33) = direction_cosines(a)
    x, y, z = vector
    return (
        c11 * x + c21 * y + c31 * z,
        c12 * x + c22 * y + c32 * z,
        c13 * x + c23 * y + c33 * z,
    )


def to_hand(a: Quaternion, vector: Vector) -> Vector:
    """Return the hand components of a vector given in forearm axes: C v."""
    return to_forearm(conjugate(a), vector)


def cross(a: Vector, b: Vector) -> Vector:
    """Return the vector product a × b."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def between(a: Vector, b: Vector) -> Vector:
    """Return the vector from one point to another, b − a."""
    return (b[0] - a[0], b[1] - a[1], b[2] - a[2])


def dot(a: Vector, b: Vector) -> float:
    """Return the scalar product a · b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def about_x(angle: float) -> Quaternion:
    """Return a turn about x, rad."""
    return (math.cos(0.5 * angle), 0.0, 0.0, math.sin(0.5 * angle))


def about_y(angle: float) -> Quaternion:
    """Return a turn about y, rad."""
    return (math.cos(0.5 * angle), 0.0, math.sin(0.5 * angle), 0.0)


def about_z(angle: float) -> Quaternion:
    """Return a turn about z, rad."""
    return (math.cos(0.5 * angle), math.sin(0.5 * angle), 0.0, 0.0)


def about(axis: Vector, angle: float) -> Quaternion:
    """Return a turn about a unit vector, rad."""
    s = math.sin(0.5 * angle)
    return (math.cos(0.5 * angle), s * axis[2], s * axis[1], s * axis[0])


def xyzw(a: Quaternion) -> Quaternion:
    """Return the components in the order of ROS: x, y, z, w."""
    return (a[3], a[2], a[1], a[0])


def from_xyzw(a: Quaternion) -> Quaternion:
    """Return Barker's quaternion of components in the order of ROS: x, y, z, w."""
    return (a[3], a[2], a[1], a[0])


def nearest_turn(angle: float, near: float) -> float:
    """Return the angle plus the whole turns that bring it closest to another, rad."""
    return angle - math.tau * round((angle - near) / math.tau)
