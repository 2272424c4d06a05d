"""Coordinates of space around an osculating torus, and curvature of a surface given as an offset from it.

The torus touches the surface at the origin of a frame (d1, d2, n) and has the normal curvatures k1 along d1 and k2
along d2, positive where it bends towards n.  (u1, u2) are the lengths of its two circular arcs and w is the distance
from it; plane, cylinder and sphere are the cases without k1 and k2, without k1, and of equal k1 and k2.  The height of
a circle over its tangent is singular at one radius, so that its Taylor series is of no use near it; here the same
circle is w = 0.
"""

import math

from rinow.kernels._jit import inlined, lean

LARGEST_TURN = math.cos(1.9)
"""Cosine of the largest angle of either arc."""


@inlined
def arc(x, a, k):
    """Length of the arc of curvature k whose angle has the sine k x / m and the cosine a / m, m^2 = (k x)^2 + a^2.

    Three bisections and an odd polynomial for the arc tangent, without a branch: loops over it become vector code, and
    nothing is divided by k.  The error is below 2e-16 of the length up to the angle 1.9.
    """
    m = math.sqrt(a * a + k * k * x * x)
    c = a / m
    c2 = math.sqrt(0.5 + 0.5 * c)
    c4 = math.sqrt(0.5 + 0.5 * c2)
    t = x / (m * 4.0 * c2 * c4 * (1.0 + c4))
    s = k * k * t * t
    p = 0.07684050674492864 + s * (-0.06529623856244636 + s * 0.04625575422515519)
    p = 0.11111104979229786 + s * (-0.09090616249100918 + s * p)
    p = 0.19999999999571585 + s * (-0.1428571421337126 + s * p)
    p = 1.0 + s * (-0.33333333333332354 + s * p)
    return 8.0 * t * p


@inlined
def torus_coordinates(x, y, z, k1, k2):
    """(u1, u2, w) of the point x d1 + y d2 + z n, and cosines and sines of the two angles."""
    a = 1.0 - k1 * z
    m = math.sqrt(a * a + k1 * k1 * x * x)
    height = (2.0 * z - k1 * (x * x + z * z)) / (1.0 + m)
    b = 1.0 - k2 * height
    l = math.sqrt(b * b + k2 * k2 * y * y)
    w = (2.0 * height - k2 * (y * y + height * height)) / (1.0 + l)
    return arc(x, a, k1), arc(y, b, k2), w, a / m, k1 * x / m, b / l, k2 * y / l


@inlined
def arc_place(u, k):
    """Cosine and sine of the angle of an arc of length u, and its height over the tangent at its beginning."""
    t = k * u
    s, c = math.sin(0.5 * t), math.cos(0.5 * t)
    sagitta = 2.0 * s * s / k if abs(t) > 1e-9 else 0.5 * k * u * u
    return 1.0 - 2.0 * s * s, 2.0 * s * c, sagitta


@inlined
def offset_forms(place, k1, k2, f, f1, f2, f11, f12, f22):
    """First and second fundamental form of w = f(u1, u2): g11, g12, g22, L, M, N, and the volume sqrt(det g).

    By symmetry only the second arc matters, of which `place` is the `arc_place`.  The frame is that of the torus at
    (u1, u2), its normal the third axis; X_i are the tangents, L, M, N the products of the second derivatives of X with
    the unit normal.
    """
    cos, sin, sagitta = place
    e1, e2 = 1.0 - k1 * (sagitta + f * cos), 1.0 - k2 * f
    g11, g12, g22 = e1 * e1 + f1 * f1, f1 * f2, e2 * e2 + f2 * f2
    nx, ny, nz = -f1 * e2, -e1 * f2, e1 * e2
    volume = math.sqrt(nx * nx + ny * ny + nz * nz)
    k1s, k1c = k1 * sin, k1 * cos
    l = -2.0 * k1c * f1 * nx + e1 * k1s * ny + (e1 * k1c + f11) * nz
    m = -k1 * (e2 * sin + f2 * cos) * nx - k2 * f1 * ny + f12 * nz
    n = -2.0 * k2 * f2 * ny + (e2 * k2 + f22) * nz
    return g11, g12, g22, l / volume, m / volume, n / volume, volume


@lean
def torus_frame(cos1, sin1, cos2, sin2):
    """Components in (d1, d2, n) of the two arc directions and the normal of the torus."""
    return (cos1, 0.0, sin1), (-sin1 * sin2, cos2, cos1 * sin2), (-sin1 * cos2, -sin2, cos1 * cos2)
