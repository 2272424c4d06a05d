"""Whether an edge is one of the rows along which a coarse mesh of a round bends.

Beyond a row there is a flat strip, and then the next row, which turns about as much: the jump of the normal at a row is
that of a crease at all scales below the width of the strips.
"""

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.adjacency import next_corner
from rinow.kernels.creases import STARTS, across, along, cross, dot, exit_of, halfedge, minus, row, turn

__all__ = ["bends_of_rounds"]

AS_MUCH = 0.6
"""Share of the turning of an edge by which the surface turns again at the next row, or before."""
AT_ONCE = 0.4
"""Largest turning at one edge there, in the same unit, of the side that has the larger one.  Beside a crease of smooth
sides it is 0.25 at most, with triangles of a tenth of the radius; beside a row the median is 0.8 and more."""
MOST = 24
"""Edges that a section passes at most."""
ALIKE = 3.0
"""Ratio of the distances on both sides up to which the surface bends alike there."""


@kernel
def next_bend(h, start, sign, axis, theta, vertices, faces, normals, partners):
    """Distance from the half-edge h at which its side has turned nearly by theta, -1 without, and most at one edge."""
    a, u = halfedge(h, vertices, faces)
    n = row(normals, h // 3)
    b = next_corner(h)
    p = along(a, start, minus(row(vertices, faces[b // 3, b % 3]), a))
    d = cross(n, u)
    first, entry, done, before, most = (sign * n[0], sign * n[1], sign * n[2]), h, 0.0, 0.0, 0.0
    for _ in range(MOST):
        out, way = exit_of(p, d, entry, n, vertices, faces)
        if out < 0 or partners[out] < 0:
            return -1.0, 0.0
        p, done, g = along(p, way, d), done + way, partners[out]
        m = row(normals, g // 3)
        if not dot(m, m) > 0.0:
            return -1.0, 0.0
        d, agrees = across(d, out, g, n, m, vertices, faces)
        sign = sign if agrees else -sign
        turned = turn(first, (sign * m[0], sign * m[1], sign * m[2]), axis) / theta
        most = max(most, turned - before)
        if turned >= AS_MUCH:
            return done, most
        before, entry, n = turned, g, m
    return -1.0, 0.0


@parallel_kernel
def bends_of_rounds(edges, vertices, faces, normals, partners, edge_halfedges, n_blocks, votes):
    """Write to votes[i] the share of the sections across edges[i] by which it is a row of a round.

    Both sides turn on as much at alike distances, one of them mostly at one edge.
    """
    for block in prange(n_blocks):
        for i in range(edges.shape[0] * block // n_blocks, edges.shape[0] * (block + 1) // n_blocks):
            h = edge_halfedges[edges[i]]
            g = partners[h]
            votes[i] = 0.0
            if g < 0:
                continue
            _, u = halfedge(h, vertices, faces)
            _, w = halfedge(g, vertices, faces)
            other = -1.0 if dot(u, w) > 0.0 else 1.0
            n, m = row(normals, h // 3), row(normals, g // 3)
            theta = turn(n, (other * m[0], other * m[1], other * m[2]), u)
            if theta == 0.0:
                continue
            for start in STARTS:
                mine, here = next_bend(h, start, 1.0, u, -theta, vertices, faces, normals, partners)
                theirs, there = next_bend(g, start, other, u, theta, vertices, faces, normals, partners)
                if max(here, there) >= AT_ONCE and 0.0 < max(mine, theirs) <= ALIKE * min(mine, theirs):
                    votes[i] += 1.0 / len(STARTS)
