"""How the normal turns along the straight section across each edge of a mesh.

The section leaves the edge at a right angle on both sides and runs straight on in the unfolded faces.  On a smooth
surface its turning Θ(r) over the distance r on each side is 2 κ r, across a crease it tends to the angle J of the
crease: with Θ(r) = J + c r the sectional curvature κ = Θ/(2 r) scales as r^p with p = d log κ / d log r = -J/Θ.
"""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.adjacency import next_corner

STARTS = (0.5, 0.22, 0.81)
"""Where sections leave an edge; no simple fractions, so that they meet few vertices of regular meshes."""
REACH = 3.0
"""Length of a section, in heights of the first face or half edges, whichever is longer."""
MEAN_GAIN, LINE_GAIN = 1.2, 4.2
"""Standard deviation of the normal that a section finds at the edge, as the mean of its faces or by a line through
them, for heights of deviation 1 over its length."""
MAX_PIECES = 7
"""Faces with normals of their own that a section looks at: those are enough for a line."""
MAX_FACES = 60
"""Faces a section runs through at most, coplanar ones included."""
COPLANAR = 0.9999
"""Cosine of the angle up to which two faces of a section count as one piece."""
PASS, END_STRAIGHT, END = 0, 1, 2
"""What an edge does to sections: nothing, it ends those that were straight up to it, or all."""
STRAIGHT_FACES, STRAIGHT_SHARE = 3, 0.25
"""Faces of a section that can be called straight, two of them may be the facet of a round, and how far it may have
turned before an edge, as a share of the turning there."""
TINY = 1e-300
"""Smallest length that is divided by."""
FLAT_DESIGN = 1e-3
"""Share of the second moment that must be left about the mean for a slope to be determined."""


@kernel
def cross(a, b):
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@kernel
def dot(a, b):
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def minus(a, b):
    """Difference of two vectors."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@kernel
def along(p, t, d):
    """The point p + t d."""
    return p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]


@kernel
def unit(a):
    """Unit vector of a; 0 for a vector without direction."""
    length = math.sqrt(dot(a, a))
    if not length > 0.0 or not np.isfinite(length):
        return 0.0, 0.0, 0.0
    return a[0] / length, a[1] / length, a[2] / length


@kernel
def row(array, i):
    """Row i of an (n, 3) array."""
    return array[i, 0], array[i, 1], array[i, 2]


@kernel
def halfedge(h, vertices, faces):
    """Start point and unit direction of a half-edge."""
    a = row(vertices, faces[h // 3, h % 3])
    g = next_corner(h)
    return a, unit(minus(row(vertices, faces[g // 3, g % 3]), a))


@parallel_kernel
def face_normals(vertices, faces, out):
    """Write the unit normals of the faces as their corners are listed; 0 without an area."""
    for f in prange(faces.shape[0]):
        a, b, c = row(vertices, faces[f, 0]), row(vertices, faces[f, 1]), row(vertices, faces[f, 2])
        out[f, 0], out[f, 1], out[f, 2] = unit(cross(minus(b, a), minus(c, a)))


@kernel
def turn(first, second, axis):
    """Signed angle from one vector to another about an axis."""
    return math.atan2(dot(cross(first, second), axis), dot(first, second))


@parallel_kernel
def edge_turnings(vertices, faces, flip, normals, partners, edge_halfedges, out):
    """Write the angle by which the normal turns across each edge, convex positive; nan without exactly two faces."""
    for e in prange(edge_halfedges.shape[0]):
        h = edge_halfedges[e]
        g = partners[h]
        out[e] = np.nan
        if g >= 0:
            n, m = row(normals, h // 3), row(normals, g // 3)
            if dot(n, n) > 0.0 and dot(m, m) > 0.0:
                _, u = halfedge(h, vertices, faces)
                _, w = halfedge(g, vertices, faces)
                if dot(u, w) > 0.0:
                    m = (-m[0], -m[1], -m[2])
                angle = turn(n, m, u)
                out[e] = -angle if flip[h // 3] else angle


@kernel
def foot_and_height(h, vertices, faces):
    """Where the opposite corner of the half-edge h stands over it, from 0 to 1, its height, and the length of h."""
    a, u = halfedge(h, vertices, faces)
    b = next_corner(h)
    to_next = minus(row(vertices, faces[b // 3, b % 3]), a)
    b = next_corner(b)
    to_apex = minus(row(vertices, faces[b // 3, b % 3]), a)
    length, offset = math.sqrt(dot(to_next, to_next)), cross(u, to_apex)
    return dot(u, to_apex) / max(length, TINY), max(math.sqrt(dot(offset, offset)), TINY), max(length, TINY)


@kernel
def exit_of(p, d, entry, n, vertices, faces):
    """The half-edge through which the ray from p in direction d leaves the face entered by `entry`, and its length."""
    best, way = -1, np.inf
    h = entry
    for _ in range(2):
        h = next_corner(h)
        a, u = halfedge(h, vertices, faces)
        outward = cross(u, n)
        speed = dot(d, outward)
        if speed > 0.0:
            t = max(dot(minus(a, p), outward) / speed, 0.0)
            if t < way:
                best, way = h, t
    return best, way


@kernel
def across(d, h, g, n, m, vertices, faces):
    """The direction d continued straight over the edge of h into the face of g, and whether its orientation agrees."""
    _, u = halfedge(h, vertices, faces)
    _, w = halfedge(g, vertices, faces)
    c, s = dot(d, u), max(dot(d, cross(u, n)), 0.0)
    inward = cross(m, w)
    turned = (c * u[0] + s * inward[0], c * u[1] + s * inward[1], c * u[2] + s * inward[2])
    return turned, dot(u, w) < 0.0


@kernel
def add_piece(s, length, n, sums):
    """Add a piece of a section: its length at distance s, with normal n, to the moments of the line n(s)."""
    sums[0] += length
    sums[1] += length * s
    sums[2] += length * s * s
    for i in range(3):
        sums[3 + i] += length * n[i]
        sums[6 + i] += length * s * n[i]


@kernel
def follow_section(start, h, sign, reach, ends, edge_of, vertices, faces, normals, partners, sums):
    """Add to `sums` the pieces of the section that leaves the half-edge h at `start` into its own face."""
    a, u = halfedge(h, vertices, faces)
    n = row(normals, h // 3)
    b = next_corner(h)
    p = along(a, start, minus(row(vertices, faces[b // 3, b % 3]), a))
    d = cross(n, u)
    first, entry, done, begin, pieces = (sign * n[0], sign * n[1], sign * n[2]), h, 0.0, 0.0, 1
    for passed in range(1, MAX_FACES + 1):
        out, way = exit_of(p, d, entry, n, vertices, faces)
        if out < 0 or done + way >= reach:
            done = reach if out >= 0 else done
            break
        p, done = along(p, way, d), done + way
        g = partners[out]
        if g < 0 or ends[edge_of[out]] == END:
            break
        m = row(normals, g // 3)
        if not dot(m, m) > 0.0:
            break
        d, agrees = across(d, out, g, n, m, vertices, faces)
        turned = sign if agrees else -sign
        cosine = sign * turned * dot(n, m)
        if passed >= STRAIGHT_FACES and ends[edge_of[out]] == END_STRAIGHT:
            if 1.0 - sign * dot(first, n) < STRAIGHT_SHARE**2 * (1.0 - cosine):
                break
        if cosine < COPLANAR:
            add_piece(0.5 * (begin + done), done - begin, (sign * n[0], sign * n[1], sign * n[2]), sums)
            begin, pieces = done, pieces + 1
            if pieces > MAX_PIECES:
                return
        entry, n, sign = g, m, turned
    add_piece(0.5 * (begin + done), done - begin, (sign * n[0], sign * n[1], sign * n[2]), sums)


@kernel
def line_at_edge(sums):
    """The normal at distance 0 by the line through the pieces, the squared deviation from it, and its gain of noise.

    One facet has no slope: its normal is taken as it is.
    """
    s0, s1, s2 = sums[0], sums[1], sums[2]
    t0, t1 = (sums[3], sums[4], sums[5]), (sums[6], sums[7], sums[8])
    det = s0 * s2 - s1 * s1
    if not det > FLAT_DESIGN * s0 * s2:
        return unit(t0), max(1.0 - dot(t0, t0) / (s0 * s0), 0.0), MEAN_GAIN
    a = ((s2 * t0[0] - s1 * t1[0]) / det, (s2 * t0[1] - s1 * t1[1]) / det, (s2 * t0[2] - s1 * t1[2]) / det)
    b = ((s0 * t1[0] - s1 * t0[0]) / det, (s0 * t1[1] - s1 * t0[1]) / det, (s0 * t1[2] - s1 * t0[2]) / det)
    return unit(a), max(1.0 - (dot(a, t0) + dot(b, t1)) / s0, 0.0), LINE_GAIN


@kernel
def side_normal(h, sign, reach, ends, edge_of, vertices, faces, normals, partners, sums):
    """Normal beside the half-edge h as its own side sees it, squared deviation from the line, and gain of noise.

    Sections that end at a crease are short, and their normals worse.
    """
    sums[:] = 0.0
    for start in STARTS:
        follow_section(start, h, sign, reach, ends, edge_of, vertices, faces, normals, partners, sums)
    if not sums[0] > 0.0:
        n = row(normals, h // 3)
        return (sign * n[0], sign * n[1], sign * n[2]), 0.0, LINE_GAIN / reach
    normal, deviation, gain = line_at_edge(sums)
    return normal, deviation, gain * len(STARTS) / sums[0]


@kernel
def reach_of(h, vertices, faces):
    """Length of a section: `REACH` times the height over the half-edge, or half its length if that is longer."""
    _, height, length = foot_and_height(h, vertices, faces)
    return REACH * max(height, 0.5 * length)


@parallel_kernel
def least_errors(vertices, faces, partners, edge_halfedges, noise, out):
    """Write what the noise (n_edges,) of heights adds to the standard error of jumps, for sections of full length."""
    for e in prange(edge_halfedges.shape[0]):
        h = edge_halfedges[e]
        g = partners[h]
        out[e] = np.inf
        if g >= 0:
            mine, theirs = reach_of(h, vertices, faces), reach_of(g, vertices, faces)
            out[e] = LINE_GAIN * noise[e] * math.sqrt(1.0 / mine**2 + 1.0 / theirs**2)


@parallel_kernel
def edge_jumps(
    edges, vertices, faces, flip, normals, partners, edge_halfedges, edge_of, ends, noise, n_blocks, jumps, errors
):
    """Write to jumps[e] the turning at each listed edge that neither side explains, to errors[e] its standard error.

    The error is the deviation of the pieces from their lines and what the noise (n_edges,) of heights does to these.
    """
    for block in prange(n_blocks):
        sums = np.empty(9)
        for i in range(edges.shape[0] * block // n_blocks, edges.shape[0] * (block + 1) // n_blocks):
            e = edges[i]
            h = edge_halfedges[e]
            g = partners[h]
            _, u = halfedge(h, vertices, faces)
            _, w = halfedge(g, vertices, faces)
            other = -1.0 if dot(u, w) > 0.0 else 1.0
            mine, theirs = reach_of(h, vertices, faces), reach_of(g, vertices, faces)
            n, x, p = side_normal(h, 1.0, mine, ends, edge_of, vertices, faces, normals, partners, sums)
            m, y, q = side_normal(g, other, theirs, ends, edge_of, vertices, faces, normals, partners, sums)
            angle = turn(n, m, u)
            jumps[e] = -angle if flip[h // 3] else angle
            errors[e] = math.sqrt(x + y + noise[e] ** 2 * (p * p + q * q))
