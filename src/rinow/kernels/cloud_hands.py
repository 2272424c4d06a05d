"""How the points around each point of a cloud differ from their mirror image."""

import math

from rinow.kernels import monge
from rinow.kernels._jit import inner, parallel_kernel, prange

SQUARINGS = 5
"""Of the adjugate of a matrix, whose largest eigenvector is the smallest one of the matrix: to its 32nd power."""


@inner
def squared(m):
    """The square of a symmetric matrix (xx, xy, xz, yy, yz, zz), over its trace; 0 for 0."""
    a, b, c, d, e, f = m
    s = (a * a + b * b + c * c, a * b + b * d + c * e, a * c + b * e + c * f)
    t = (b * b + d * d + e * e, b * c + d * e + e * f, c * c + e * e + f * f)
    trace = s[0] + t[0] + t[2]
    unit = 1.0 / trace if trace > 0.0 else 0.0
    return s[0] * unit, s[1] * unit, s[2] * unit, t[0] * unit, t[1] * unit, t[2] * unit


@inner
def normal_of(v, near, points, far2, normal):
    """Unit normal of the plane through a point that fits its weighted neighbours best, with the sign of another one."""
    xx = xy = xz = yy = yz = zz = 0.0
    for w in near:
        dx, dy, dz = points[w, 0] - points[v, 0], points[w, 1] - points[v, 1], points[w, 2] - points[v, 2]
        share = (1.0 - (dx * dx + dy * dy + dz * dz) / far2) ** 2 / far2
        xx, xy, xz = xx + share * dx * dx, xy + share * dx * dy, xz + share * dx * dz
        yy, yz, zz = yy + share * dy * dy, yz + share * dy * dz, zz + share * dz * dz
    m = (
        yy * zz - yz * yz,
        xz * yz - xy * zz,
        xy * yz - xz * yy,
        xx * zz - xz * xz,
        xy * xz - xx * yz,
        xx * yy - xy * xy,
    )
    for _ in range(SQUARINGS):
        m = squared(m)
    a, b, c, d, e, f = m
    x = a * normal[0] + b * normal[1] + c * normal[2]
    y = b * normal[0] + d * normal[1] + e * normal[2]
    z = c * normal[0] + e * normal[1] + f * normal[2]
    size = math.sqrt(x * x + y * y + z * z)
    return (x / size, y / size, z / size) if size > 0.0 else (0.0, 0.0, 0.0)


@parallel_kernel
def turns(points, normals, near, out):
    """Write the imaginary part of the moment of order 4 times the squared conjugate one of order 2, and its modulus.

    The moments are those of the nearest points in the tangent plane, in units of the distance of the last one; the
    weights fall to 0 there, so that nothing depends on which of points of one distance come first.
    """
    for v in prange(points.shape[0]):
        far2 = 0.0
        for w in near[v]:
            dx, dy, dz = points[w, 0] - points[v, 0], points[w, 1] - points[v, 1], points[w, 2] - points[v, 2]
            far2 = max(far2, dx * dx + dy * dy + dz * dz)
        out[v, 0], out[v, 1] = 0.0, 0.0
        if far2 > 0.0:
            normal = normal_of(v, near[v], points, far2, (normals[v, 0], normals[v, 1], normals[v, 2]))
            t = monge.some_tangent(normal)
            b = monge.cross(normal, t)
            second, fourth = 0j, 0j
            for w in near[v]:
                dx, dy, dz = points[w, 0] - points[v, 0], points[w, 1] - points[v, 1], points[w, 2] - points[v, 2]
                z = complex(t[0] * dx + t[1] * dy + t[2] * dz, b[0] * dx + b[1] * dy + b[2] * dz)
                share = (1.0 - (dx * dx + dy * dy + dz * dz) / far2) ** 2
                z2 = z * z / far2
                second += share * z2
                fourth += share * z2 * z2
            product = fourth * second.conjugate() ** 2
            out[v, 0], out[v, 1] = product.imag, abs(product)
