"""Polynomials of order 3 and 4 through a vertex, fitted to the circles through it and the vertices of its three rings.

As for quadrics, each height has the weight 1/d^4 of its distance: what is near decides, and what is farther away tells
the higher terms.
"""

import math

import numpy as np

from rinow.kernels import monge, nested_fits, stencils
from rinow.kernels._jit import lean, parallel_kernel, prange
from rinow.kernels.stencils import SOFTENING

N_RINGS = 3
LOW, HIGH = 3, 4
"""Orders of the fits."""


@lean
def fit_jets(points, n, work):
    """Fit orders up to HIGH to n weighted points and to the centre; return the highest order that is determined."""
    moments, offsets = work.moments[0], work.offsets[0]
    moments[:], offsets[:] = 0.0, 0.0
    moments[0, 0] = 1.0 / (SOFTENING * SOFTENING)
    for i in range(n):
        u, v, w = points[i, 0], points[i, 1], points[i, 2]
        d2 = u * u + v * v + w * w + SOFTENING
        y = 1.0 / (d2 * d2)
        for b in range(2 * HIGH + 1):
            x = y
            for a in range(2 * HIGH + 1 - b):
                moments[b, a] += x
                if a + b <= HIGH:
                    offsets[b, a] += w * x
                x *= u
            y *= v
    return nested_fits.fit_orders(len(work.counts) - 1, 1.0, nested_fits.highest_order(n + 1, HIGH), work)


@lean
def write_curvatures(order, unit, work, out):
    """Write Gaussian and mean curvature at the centre of the fit of some order."""
    _, f1, f2, f11, f12, f22 = work.jets[order]
    s11, s12, s22 = monge.shape_operator(f1, f2, f11, f12, f22)
    out[0], out[1] = (s11 * s22 - s12 * s12) / (unit * unit), 0.5 * (s11 + s22) / unit


@lean
def better_normal(normal, tangent, work):
    """The normal of the fit of order LOW over a tangent plane."""
    jet = work.jets[LOW]
    return monge.graph_frame(jet[1], jet[2], tangent, normal)[2]


@parallel_kernel
def ring_jets(surface, n_blocks, out):
    """Write Gaussian and mean curvature (n, 2, 2) by orders LOW and HIGH, nan where they are not determined.

    A second fit is made over the tangent plane that the first one finds.
    """
    n = surface.vertices.shape[0]
    for block in prange(n_blocks):
        members, marks = np.empty(n + 1, np.int32), np.zeros(n, np.int32)
        points, work = np.empty((n, 3)), nested_fits.fits(1)
        for v in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            out[v] = np.nan
            count, reach = stencils.rings(v, N_RINGS, surface, members, marks)
            normal, unit, top = stencils.normal_at(v, surface), math.sqrt(reach), LOW
            for _ in range(2):
                if top < LOW or not unit > 0.0 or normal == (0.0, 0.0, 0.0):
                    break
                size = stencils.facing(members, count, normal, surface)
                tangent = stencils.local_coordinates(members, size, unit, normal, surface.vertices, points)
                top = fit_jets(points, size - 1, work)
                if top >= LOW:
                    write_curvatures(LOW, unit, work, out[v, 0])
                    write_curvatures(min(top, HIGH), unit, work, out[v, 1])
                    normal = better_normal(normal, tangent, work)
