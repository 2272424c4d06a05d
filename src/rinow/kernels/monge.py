"""Principal curvatures of a surface given as a graph over a plane, from its first and second derivatives."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels._jit import kernel


class PrincipalFrames(NamedTuple):
    """Principal curvatures k1 >= k2, their directions, and normals: one row for each vertex."""

    k1: np.ndarray
    k2: np.ndarray
    direction1: np.ndarray
    direction2: np.ndarray
    normals: np.ndarray


@kernel
def tangent_frame(x, y, z):
    """Two unit vectors that form a right-handed frame with the unit vector (x, y, z) (Duff et al. 2017)."""
    s = math.copysign(1.0, z)
    a = -1.0 / (s + z)
    b = x * y * a
    return 1.0 + s * x * x * a, s * b, -s * x, b, s + y * y * a, -y


@kernel
def graph_frame(f1, f2, normal):
    """Orthonormal tangents, the first along the first coordinate, and normal of a graph over the plane of `normal`."""
    x, y, z = normal
    ax, ay, az, bx, by, bz = tangent_frame(x, y, z)
    e = math.sqrt(1.0 + f1 * f1)
    w = math.sqrt(1.0 + f1 * f1 + f2 * f2)
    ux, uy, uz = (ax + f1 * x) / e, (ay + f1 * y) / e, (az + f1 * z) / e
    nx, ny, nz = (x - f1 * ax - f2 * bx) / w, (y - f1 * ay - f2 * by) / w, (z - f1 * az - f2 * bz) / w
    return ux, uy, uz, ny * uz - nz * uy, nz * ux - nx * uz, nx * uy - ny * ux, nx, ny, nz


@kernel
def shape_operator(f1, f2, f11, f12, f22):
    """Entries S11, S12, S22 in the tangents of `graph_frame`.

    Positive where the surface bends away from the normal, as a sphere does from its outward one.
    """
    e = 1.0 + f1 * f1
    w2 = e + f2 * f2
    w = math.sqrt(w2)
    t = f1 * f2 / e
    return -f11 / (w * e), -(f12 - t * f11) / w2, -(f22 - 2.0 * t * f12 + t * t * f11) * e / (w * w2)


@kernel
def write_principal_frame(row, coefficients, unit, normal, frames):
    """Diagonalise the shape operator of c0 x + c1 y + c2 x^2 + c3 x y + c4 y^2 + ... over the plane of `normal`."""
    f1, f2 = coefficients[0], coefficients[1]
    s11, s12, s22 = shape_operator(f1, f2, 2.0 * coefficients[2], coefficients[3], 2.0 * coefficients[4])
    mean, half = 0.5 * (s11 + s22), 0.5 * (s11 - s22)
    radius = math.hypot(half, s12)
    frames.k1[row], frames.k2[row] = (mean + radius) / unit, (mean - radius) / unit
    cos, sin = (radius + half, s12) if half >= 0.0 else (s12, radius - half)
    length = math.hypot(cos, sin)
    cos, sin = (cos / length, sin / length) if length > 0.0 else (1.0, 0.0)
    ux, uy, uz, vx, vy, vz, nx, ny, nz = graph_frame(f1, f2, normal)
    d1, d2, n = frames.direction1, frames.direction2, frames.normals
    d1[row, 0], d1[row, 1], d1[row, 2] = cos * ux + sin * vx, cos * uy + sin * vy, cos * uz + sin * vz
    d2[row, 0], d2[row, 1], d2[row, 2] = cos * vx - sin * ux, cos * vy - sin * uy, cos * vz - sin * uz
    n[row, 0], n[row, 1], n[row, 2] = nx, ny, nz
