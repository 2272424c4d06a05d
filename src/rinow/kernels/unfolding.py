"""Triangles laid out in the plane beside one another, and the cones of straight lines that pass through them.

Points and vectors of the plane are complex numbers.  The shape of the half-edge from a to b, in a face with apex c, is
the pair (c - a) / (b - a), (c - b) / (b - a): once the edge lies in the plane, two products place the apex.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.tolerances import SEEN_ANGLE

_SEEN_SQUARE = SEEN_ANGLE * SEEN_ANGLE


class Window(NamedTuple):
    """Straight lines from the origin that enter a face between two rays, through one of its half-edges."""

    row: int
    """The half-edge; -1 for no window."""
    start: complex
    """Its start in the plane, on the left seen from the origin."""
    edge: complex
    """The vector from its start to its end."""
    left: complex
    """A point on the left ray."""
    right: complex
    """A point on the right ray."""


@kernel
def cross(p, q):
    """Signed area of the parallelogram of p and q: positive where q lies to the left of p."""
    return p.real * q.imag - p.imag * q.real


@kernel
def dot(p, q):
    """Scalar product."""
    return p.real * q.real + p.imag * q.imag


@kernel
def square(p):
    """Squared length."""
    return p.real * p.real + p.imag * p.imag


@kernel
def nearest_square(window):
    """Squared distance from the origin to the part of the edge between the two rays; inf for an edge seen edge-on."""
    height = cross(window.edge, window.start)
    ray = window.left
    if dot(ray, window.edge) <= 0.0:  # the foot of the perpendicular is not left of the left ray
        ray = window.right
        if dot(ray, window.edge) >= 0.0:
            return height * height / square(window.edge)
    slope = cross(window.edge, ray)
    return height * height * square(ray) / (slope * slope) if slope > 0.0 else np.inf


@kernel
def is_seen(left, right, point):
    """Whether a point lies between two rays, or beside one by no more than rounding can explain.

    A vertex exactly behind another one may fall between the cones on either side of it; the cones are never widened.
    """
    outside = cross(left, point)
    if outside <= 0.0:
        outside = -cross(right, point)
        left = right
    return outside <= 0.0 or outside * outside <= _SEEN_SQUARE * square(left) * square(point)


@kernel
def squared_length(p):
    """Squared length of a vector of space."""
    return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]


@kernel
def side(vertices, i, j):
    """Vector from vertex i to vertex j."""
    return vertices[j, 0] - vertices[i, 0], vertices[j, 1] - vertices[i, 1], vertices[j, 2] - vertices[i, 2]


@kernel
def doubled_area(p, q):
    """Length of the vector product, twice the area of the triangle spanned by p and q."""
    x, y, z = p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]
    return math.sqrt(x * x + y * y + z * z)


@kernel
def triangle_shape(vertices, i, j, k):
    """Shape of the half-edge from vertex i to vertex j with apex k, its height from the two shortest sides."""
    ab, ac, bc = side(vertices, i, j), side(vertices, i, k), side(vertices, j, k)
    n_ab, n_ac, n_bc = squared_length(ab), squared_length(ac), squared_length(bc)
    if n_ab >= n_ac and n_ab >= n_bc:
        area = doubled_area(ac, bc)
    elif n_ac >= n_bc:
        area = doubled_area(ab, bc)
    else:
        area = doubled_area(ab, ac)
    if n_ab == 0.0:
        return 0j, 0j
    u = (ab[0] * ac[0] + ab[1] * ac[1] + ab[2] * ac[2]) / n_ab
    v = (ab[0] * bc[0] + ab[1] * bc[1] + ab[2] * bc[2]) / n_ab
    return complex(u, area / n_ab), complex(v, area / n_ab)


@parallel_kernel
def triangle_shapes(vertices, faces, out):
    """Write the shapes of the three half-edges of each face to rows 3 f, 3 f + 1, 3 f + 2."""
    for f in prange(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        out[3 * f, 0], out[3 * f, 1] = triangle_shape(vertices, i, j, k)
        out[3 * f + 1, 0], out[3 * f + 1, 1] = triangle_shape(vertices, j, k, i)
        out[3 * f + 2, 0], out[3 * f + 2, 1] = triangle_shape(vertices, k, i, j)
