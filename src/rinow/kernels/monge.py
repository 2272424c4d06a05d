"""Principal curvatures of a surface given as a graph over a plane, from its first and second derivatives."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels._jit import lean


class PrincipalFrames(NamedTuple):
    """Principal curvatures k1 >= k2, their directions, and normals: one row for each vertex."""

    k1: np.ndarray
    k2: np.ndarray
    direction1: np.ndarray
    direction2: np.ndarray
    normals: np.ndarray


@lean
def cross(a, b):
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@lean
def combination(s, a, t, b):
    """The vector s a + t b."""
    return s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]


@lean
def some_tangent(normal):
    """A unit vector orthogonal to a unit normal, without a branch (Duff et al. 2017)."""
    x, y, z = normal
    s = math.copysign(1.0, z)
    a = -1.0 / (s + z)
    return 1.0 + s * x * x * a, s * x * y * a, -s * x


@lean
def graph_frame(f1, f2, tangent, normal):
    """Orthonormal tangents, the first over `tangent`, and normal of a graph with slopes f1, f2 along it and across."""
    e = math.sqrt(1.0 + f1 * f1)
    w = math.sqrt(1.0 + f1 * f1 + f2 * f2)
    across = combination(f1 / w, tangent, f2 / w, cross(normal, tangent))
    n = combination(1.0 / w, normal, -1.0, across)
    t = combination(1.0 / e, tangent, f1 / e, normal)
    return t, cross(n, t), n


@lean
def shape_operator(f1, f2, f11, f12, f22):
    """Entries S11, S12, S22 in the tangents of `graph_frame`.

    Positive where the surface bends away from the normal, as a sphere does from its outward one.
    """
    e = 1.0 + f1 * f1
    w2 = e + f2 * f2
    w = math.sqrt(w2)
    t = f1 * f2 / e
    return -f11 / (w * e), -(f12 - t * f11) / w2, -(f22 - 2.0 * t * f12 + t * t * f11) * e / (w * w2)


@lean
def write_principal_frame(row, coefficients, unit, tangent, normal, frames):
    """Diagonalise the shape operator of the graph c0 x + c1 y + c2 x^2 + c3 x y + c4 y^2 + ..., x along `tangent`."""
    f1, f2 = coefficients[0], coefficients[1]
    s11, s12, s22 = shape_operator(f1, f2, 2.0 * coefficients[2], coefficients[3], 2.0 * coefficients[4])
    mean, half = 0.5 * (s11 + s22), 0.5 * (s11 - s22)
    radius = math.hypot(half, s12)
    frames.k1[row], frames.k2[row] = (mean + radius) / unit, (mean - radius) / unit
    cos, sin = (radius + half, s12) if half >= 0.0 else (s12, radius - half)
    length = math.hypot(cos, sin)
    cos, sin = (cos / length, sin / length) if length > 0.0 else (1.0, 0.0)
    t, b, n = graph_frame(f1, f2, tangent, normal)
    p, q = combination(cos, t, sin, b), combination(cos, b, -sin, t)
    for k in range(3):
        frames.direction1[row, k], frames.direction2[row, k], frames.normals[row, k] = p[k], q[k], n[k]


@lean
def write_no_frame(row, normal, frames):
    """Write nan for a vertex without a fit, and its normal."""
    frames.k1[row] = frames.k2[row] = np.nan
    for k in range(3):
        frames.direction1[row, k] = frames.direction2[row, k] = np.nan
        frames.normals[row, k] = normal[k]
