"""Triangles laid out in the plane, one beside the other.

Points and vectors of the plane are complex numbers.  The shape of the half-edge from a to b, in a face with apex c, is
the pair (c - a) / (b - a), (c - b) / (b - a): once the edge lies in the plane, two products place the apex.
"""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange

HALFEDGE = np.dtype(
    [
        ("from_start", np.complex128),  # (apex - start) / (end - start)
        ("from_end", np.complex128),  # (apex - end) / (end - start)
        ("bearing", np.float64),  # its angle in the fan at its start; below 0 in a face seen from behind
        ("end", np.int32),  # vertices
        ("apex", np.int32),
        ("left", np.int32),  # half-edge entered through the side from start to apex; -1 at the boundary
        ("right", np.int32),  # half-edge entered through the side from apex to end
        ("previous", np.int32),  # half-edge from apex to start
        ("sibling", np.int32),  # the next half-edge entered through the same edge, where three or more faces meet
    ]
)
"""All that a geodesic needs to cross a face from one of its half-edges: one line of the processor's cache."""


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
def side(vertices, i, j):
    """Vector from vertex i to vertex j, in space."""
    return vertices[j, 0] - vertices[i, 0], vertices[j, 1] - vertices[i, 1], vertices[j, 2] - vertices[i, 2]


@kernel
def inner(p, q):
    """Scalar product, in space."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


@kernel
def doubled_area(p, q):
    """Length of the vector product: twice the area of the triangle spanned by p and q."""
    x, y, z = p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]
    return math.sqrt(x * x + y * y + z * z)


@kernel
def triangle_shape(ab, ac, bc):
    """Shape of the half-edge from a to b with apex c, from its sides in space; its height from the two shortest.

    Positions tell the height of a flat triangle far better than side lengths, whose excess drowns in rounding.
    """
    n_ab, n_ac, n_bc = inner(ab, ab), inner(ac, ac), inner(bc, bc)
    if n_ab == 0.0:
        return 0j, 0j
    if n_ab >= n_ac and n_ab >= n_bc:
        area = doubled_area(ac, bc)
    elif n_ac >= n_bc:
        area = doubled_area(ab, bc)
    else:
        area = doubled_area(ab, ac)
    return complex(inner(ab, ac) / n_ab, area / n_ab), complex(inner(ab, bc) / n_ab, area / n_ab)


@parallel_kernel
def triangle_shapes(vertices, faces, out):
    """Write the shapes of the three half-edges of face f to rows 3 f, 3 f + 1, 3 f + 2."""
    for f in prange(faces.shape[0]):
        for k in range(3):
            a, b, c = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
            shape = triangle_shape(side(vertices, a, b), side(vertices, a, c), side(vertices, b, c))
            out[3 * f + k, 0], out[3 * f + k, 1] = shape
