"""One fit about each centre: the frame of its osculating torus, and the curvature it gives the vertices of its core."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels import bends, monge, nested_fits, stencils
from rinow.kernels._jit import inlined, lean, parallel_kernel, prange
from rinow.kernels.nested_fits import ROOMY, TERMS
from rinow.kernels.osculating_torus import arc_place, offset_forms, torus_frame
from rinow.kernels.patch_fits import STEEP, curvature_and_gradients, forms_at_centre

STEEP_CORE = 0.6
"""Largest squared slope of a fit at a vertex of its core."""
SHARP = 2.0
"""Curvature, over the inverse spacing, that no mesh resolves: beyond it a fit has failed."""
FALLEN = 1e-6
"""Weight of a fit whose order had to be lowered."""
LOOSE = 40.0
"""A fit is loose beside its centre where it has more than so many times the variance there.  Its weight falls with the
square of that ratio."""
SYMMETRIC = 1.5
"""Largest ratio of variances of stencils that count as symmetric."""
N_VALUES = 15
"""Weight; weighted K, H, risk, radius; six entries of the second fundamental form; normal; height over the fit."""


class Patch(NamedTuple):
    """What is known of one patch: radius of its core, noise, risk, weight, order."""

    core: float
    noise: float
    risk: float
    weight: float
    order: int


@lean
def shape_in_frame(g11, g12, g22, l, m, n, volume):
    """Entries of the shape operator for the first tangent and the direction across it."""
    e = math.sqrt(g11)
    a, b = g12 / e, volume / e
    s11 = l / g11
    s12 = (m / e - a * s11) / b
    return s11, s12, (n - a * a * s11 - 2.0 * a * b * s12) / (b * b)


@lean
def principal(s11, s12, s22):
    """Eigenvalues of a symmetric matrix, the one of larger modulus last, and cosine and sine of the first direction."""
    mean, half = 0.5 * (s11 + s22), 0.5 * (s11 - s22)
    r = math.hypot(half, s12)
    cos, sin = (r + half, s12) if half >= 0.0 else (s12, r - half)
    length = math.hypot(cos, sin)
    cos, sin = (cos / length, sin / length) if length > 0.0 else (1.0, 0.0)
    if mean > 0.0:  # the first direction belongs to mean + r
        return mean - r, mean + r, -sin, cos
    return mean + r, mean - r, cos, sin


@lean
def combine(frame, x, y, z, out, first):
    """Write x d1 + y d2 + z n, of unit length, to out[first..first + 2]."""
    length = math.sqrt(x * x + y * y + z * z)
    for k in range(3):
        out[first + k] = (x * frame[3 + k] + y * frame[6 + k] + z * frame[k]) / length


@lean
def write_frame(jet, spacing, frame, out):
    """Write normal, principal directions and curvatures of a fit over a torus; of a steep one only the normal."""
    k1, k2 = frame[9] * spacing, frame[10] * spacing
    g11, g12, g22, l, m, n, volume = forms_at_centre(jet, k1, k2)
    e1, e2 = 1.0 - k1 * jet[0], 1.0 - k2 * jet[0]
    nx, ny, nz = -jet[1] * e2, -e1 * jet[2], e1 * e2
    tx, tz = e1, jet[1]
    cx, cy, cz = ny * tz, nz * tx - nx * tz, -ny * tx  # normal x first tangent
    t, c = math.sqrt(tx * tx + tz * tz), math.sqrt(cx * cx + cy * cy + cz * cz)
    first, second, cos, sin = principal(*shape_in_frame(g11, g12, g22, l, m, n, volume))
    combine(frame, nx, ny, nz, out, 0)
    p, q, r, s = cos / t, sin / c, -sin / t, cos / c
    combine(frame, p * tx + q * cx, q * cy, p * tz + q * cz, out, 3)
    combine(frame, r * tx + s * cx, s * cy, r * tz + s * cz, out, 6)
    flat = jet[1] * jet[1] + jet[2] * jet[2] > STEEP
    out[9], out[10] = (0.0, 0.0) if flat else (first / spacing, second / spacing)


@inlined
def polynomial(coefficients, order, reach, u, v):
    """Value, first and second derivatives at (u, v) of a polynomial in coordinates over `reach`, after Horner."""
    f = f1 = f2 = f11 = f12 = f22 = 0.0
    x, y = u / reach, v / reach
    for b in range(order, -1, -1):
        g = g1 = g2 = 0.0  # the factor of y^b, half its second derivative last
        for d in range(order, b - 1, -1):
            g2, g1, g = g2 * x + g1, g1 * x + g, g * x + coefficients[TERMS[d] - d - 1 + b]
        f22, f2, f = f22 * y + f2, f2 * y + f, f * y + g
        f12, f1, f11 = f12 * y + f1, f1 * y + g1, f11 * y + g2
    s = 1.0 / (reach * reach)
    return f, f1 / reach, f2 / reach, 2.0 * f11 * s, f12 * s, 2.0 * f22 * s


@inlined
def in_space(frame, x, y, z):
    """The vector x d1 + y d2 + z n."""
    return (
        x * frame[3] + y * frame[6] + z * frame[0],
        x * frame[4] + y * frame[7] + z * frame[1],
        x * frame[5] + y * frame[8] + z * frame[2],
    )


@lean
def write_values(u, v, jet, frame, spacing, out):
    """Write curvatures, second fundamental form and normal at a point of a patch; false where it is steep."""
    f, f1, f2, f11, f12, f22 = jet
    if not f1 * f1 + f2 * f2 <= STEEP_CORE:
        return False
    k1, k2 = frame[9] * spacing, frame[10] * spacing
    place = arc_place(v, k2)
    g11, g12, g22, l, m, n, volume = offset_forms(place, k1, k2, f, f1, f2, f11, f12, f22)
    gaussian = (l * n - m * m) / (volume * volume)
    mean = 0.5 * (g22 * l - 2.0 * g12 * m + g11 * n) / (volume * volume)
    if not (abs(mean) < SHARP and abs(gaussian) < SHARP * SHARP):
        return False
    out[1], out[2] = gaussian / (spacing * spacing), mean / spacing
    e1, e2 = math.sqrt(max(g11 - f1 * f1, 0.0)), 1.0 - k2 * f
    a, b, up = torus_frame(math.cos(k1 * u), math.sin(k1 * u), place[0], place[1])
    p, q, r = -f1 * e2 / volume, -e1 * f2 / volume, e1 * e2 / volume
    normal = in_space(
        frame, p * a[0] + q * b[0] + r * up[0], p * a[1] + q * b[1] + r * up[1], p * a[2] + q * b[2] + r * up[2]
    )
    p, r = e1 / math.sqrt(g11), f1 / math.sqrt(g11)
    tangent = in_space(frame, p * a[0] + r * up[0], p * a[1] + r * up[1], p * a[2] + r * up[2])
    across = monge.cross(normal, tangent)
    s11, s12, s22 = shape_in_frame(g11, g12, g22, l, m, n, volume)
    i = 5
    for j in range(3):
        for k in range(j, 3):
            mixed = tangent[j] * across[k] + across[j] * tangent[k]
            out[i] = (s11 * tangent[j] * tangent[k] + s12 * mixed + s22 * across[j] * across[k]) / spacing
            i += 1
    out[11], out[12], out[13] = normal
    return True


@lean
def is_even_handed(lower, upper):
    """Whether an odd order has nearly the variance of the even one below it, as on stencils with points all around.

    There both agree at the centre, but only the odd one follows the first derivatives of curvature away from it.
    """
    return upper[0] + upper[3] + upper[5] < SYMMETRIC * (lower[0] + lower[3] + lower[5])


@lean
def chosen_order(wanted, top, fit):
    """The order wanted, the odd one above it where that is as good at the centre, or the highest there is."""
    if wanted % 2 == 0 and top == wanted + 1 and is_even_handed(fit.covariances[wanted], fit.covariances[top]):
        return top
    return min(wanted, top)


@lean
def lightest(start, stop, values):
    """The row of least weight; before the first one without any."""
    row = start if start < stop else start - 1
    for i in range(start + 1, stop):
        if values[i, 0] < values[row, 0]:
            row = i
    return row


@lean
def write_core(start, stop, size, order, fit, coefficients, bias, reach, frame, patch, sheet, ball, vertices, values):
    """Write the weighted values of one patch at the vertices nearer than patch.core spacings to its centre.

    Some of them may be reached over vertices farther away only, so that there are more than rows: the heaviest stay.
    """
    k, centre, points = start, ball.members[0], ball.points
    c, spacing, core = fit.covariances[order], sheet.spacing[centre], patch.core
    at_centre, is_crowded, inside = c[0] + c[3] + c[5], size < ROOMY * TERMS[order], -1
    if is_crowded:
        bends.bend_variances(points, size, core, reach, order, fit)
    most = patch.weight * (1.0 if order >= patch.order else FALLEN)
    for j in range(size):
        u, v, q = points[0, j], points[1, j], ball.members[j]
        s = u * u + v * v
        if not s < core * core:
            continue
        inside += 1
        if stencils.squared_distance(sheet.vertices, centre, q) >= (core * spacing) ** 2:
            continue
        gain = fit.bends[inside] / at_centre if is_crowded else 1.0
        weight = (1.0 - s / (core * core)) ** 2 * most * min(1.0, LOOSE / gain) ** 2
        row = k if k < stop else lightest(start, stop, values)
        if row < k and not (row >= start and weight > values[row, 0]):
            continue
        out = values[row]
        x, y = u - fit.origin[0], v - fit.origin[1]
        jet = polynomial(coefficients, order, reach, x, y)
        if not write_values(u, v, jet, frame, spacing, out):
            continue
        sign = 1.0
        if not sheet.is_oriented:
            dot = out[11] * sheet.normals[q, 0] + out[12] * sheet.normals[q, 1] + out[13] * sheet.normals[q, 2]
            sign = 1.0 if dot >= 0.0 else -1.0
        out[1] -= bias
        out[3], out[4], out[14] = patch.risk * max(gain, 1.0), reach * spacing, (points[2, j] - jet[0]) * spacing
        out[0] = weight
        for m in range(1, N_VALUES):
            out[m] *= weight * (sign if m == 2 or 5 <= m else 1.0)
        vertices[row] = q
        k = max(k, row + 1)


@lean
def write_patch(start, stop, size, top, asked, reach, frame, patch, fit, sheet, ball, coefficients, vertices, values):
    """Write the values of one patch from its fits of orders up to `top`, of a factorisation made for `asked`."""
    spacing = sheet.spacing[ball.members[0]]
    order = chosen_order(patch.order, top, fit)
    nested_fits.coefficients(order, asked, fit, coefficients)
    factor = curvature_and_gradients(fit.jets[order], frame[9] * spacing, frame[10] * spacing)[4]
    c = fit.covariances[order]
    bias = patch.noise / spacing**4 * factor * (c[2] - c[3])  # the mean of f11 f22 - f12^2 over the noise
    write_core(start, stop, size, order, fit, coefficients, bias, reach, frame, patch, sheet, ball, vertices, values)


@lean
def add_row(i, values, v, totals):
    """Add row i of the values to the totals of vertex v."""
    last, weight, more = values.shape[1], totals[v, 0], values[i, 0]
    if weight > 0.0 and more > 0.0:
        apart = values[i, 1] / more - totals[v, 1] / weight
        totals[v, last] += weight * more / (weight + more) * apart * apart
    for k in range(last):
        totals[v, k] += values[i, k]


@parallel_kernel
def add_values(vertices, values, least, most, n_blocks, totals):
    """Add the values of patches to the totals of their vertices; the last total is of the squared deviations of K.

    Each block of the vertices from `least` to `most` looks through all values for its own, so that they are added in
    their order.
    """
    n = most + 1 - least
    for block in prange(n_blocks):
        first, last = least + n * block // n_blocks, least + n * (block + 1) // n_blocks
        for i in range(len(vertices)):
            if first <= vertices[i] < last:
                add_row(i, values, vertices[i], totals)


@parallel_kernel
def mean_values(totals, normals, out, direction1, direction2):
    """Write K, H, risk, radius, height over the fits, variance of K between them, and directions of the means.

    All are nan without a patch; k1 >= k2.  Curvatures change their sign here: positive where the surface bends away
    from its normal.
    """
    for v in prange(len(totals)):
        total, weight = totals[v], totals[v, 0]
        if not weight > 0.0:
            out[v, :] = np.nan
            direction1[v, :], direction2[v, :] = np.nan, np.nan
            continue
        out[v, 0], out[v, 1] = total[1] / weight, -total[2] / weight
        out[v, 2], out[v, 3], out[v, 4] = total[3] / weight, total[4] / weight, total[14] / weight
        out[v, 5] = total[N_VALUES] / weight
        n = (total[11], total[12], total[13])
        length = stencils.norm(n)
        if not length > 0.0:
            n, length = (normals[v, 0], normals[v, 1], normals[v, 2]), 1.0
        n = (n[0] / length, n[1] / length, n[2] / length)
        t = monge.some_tangent(n)
        b = monge.cross(n, t)
        s11 = s12 = s22 = 0.0
        k = 5
        for i in range(3):
            for j in range(i, 3):
                x = -total[k] if i == j else -2.0 * total[k]
                s11, s22 = s11 + x * t[i] * t[j], s22 + x * b[i] * b[j]
                s12 += 0.5 * x * (t[i] * b[j] + t[j] * b[i])
                k += 1
        half = 0.5 * (s11 - s22)
        r = math.hypot(half, s12)
        cos, sin = (r + half, s12) if half >= 0.0 else (s12, r - half)
        length = math.hypot(cos, sin)
        cos, sin = (cos / length, sin / length) if length > 0.0 else (1.0, 0.0)
        for i in range(3):
            direction1[v, i], direction2[v, i] = cos * t[i] + sin * b[i], cos * b[i] - sin * t[i]
