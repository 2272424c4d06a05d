"""Neighbourhoods of a vertex, grown over the edges of a mesh, and their coordinates over its tangent plane."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels import monge
from rinow.kernels._jit import kernel, lean, parallel_kernel, prange

SOFTENING = 0.01
"""Added to squared distances, in squared radii of the stencil: two vertices that nearly coincide tell no curvature."""
FACING = 0.2
"""Least cosine between the normals of a vertex and those of its second ring that are fitted with it: what is turned
further is no graph over the tangent plane."""
QUADRIC_POINTS = 7
"""Fewer points than this leave the tangent plane as it is: their circles are fitted by Euler's formula alone."""
HUB = 100
"""A vertex with more neighbours than this, such as the centre of a fan, joins the vertices around it to far too many:
stencils of others do not grow through it, or their total cost would be the square of its degree."""
CANCELLED = 0.1
"""A sum of vectors shorter than this share of the first one has no direction of its own."""
TINY = 1e-300
"""Smallest length a vector is divided by."""


class Surface(NamedTuple):
    """Positions (n, 3), unit normals (n, 3), compressed rows of neighbours, and whether the normals agree in sign."""

    vertices: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    neighbours: np.ndarray
    is_oriented: bool


@lean
def add_aligned(total, vector, align):
    """Add a vector to a total; with `align` its opposite where that makes the smaller angle."""
    if align and total[0] * vector[0] + total[1] * vector[1] + total[2] * vector[2] < 0.0:
        return total[0] - vector[0], total[1] - vector[1], total[2] - vector[2]
    return total[0] + vector[0], total[1] + vector[1], total[2] + vector[2]


@lean
def area_vector(vertices, v, p, q):
    """Doubled area vector of a triangle."""
    ax, ay, az = vertices[p, 0] - vertices[v, 0], vertices[p, 1] - vertices[v, 1], vertices[p, 2] - vertices[v, 2]
    bx, by, bz = vertices[q, 0] - vertices[v, 0], vertices[q, 1] - vertices[v, 1], vertices[q, 2] - vertices[v, 2]
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


@parallel_kernel
def vertex_area_vectors(vertices, faces, flip, align, offsets, corners, out):
    """Write the sum of the doubled area vectors of the faces at each vertex, turned as `flip` says."""
    for v in prange(offsets.shape[0] - 1):
        total = (0.0, 0.0, 0.0)
        for i in range(offsets[v], offsets[v + 1]):
            f, k = corners[i] // 3, corners[i] % 3
            p, q = faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
            vector = area_vector(vertices, v, q, p) if flip[f] else area_vector(vertices, v, p, q)
            total = add_aligned(total, vector, align)
        out[v, 0], out[v, 1], out[v, 2] = total


@parallel_kernel
def ring_directions(vectors, align, offsets, neighbours, out):
    """Write the direction of the sum of vectors (n, 3) over each vertex and its neighbours.

    Where they cancel, as over a tetrahedron, it is the direction of the vertex's own vector, or 0.
    """
    for v in prange(offsets.shape[0] - 1):
        own = (vectors[v, 0], vectors[v, 1], vectors[v, 2])
        total = own
        for i in range(offsets[v], offsets[v + 1]):
            w = neighbours[i]
            total = add_aligned(total, (vectors[w, 0], vectors[w, 1], vectors[w, 2]), align)
        if norm(total) < CANCELLED * norm(own):
            total = own
        length = max(norm(total), TINY)
        out[v, 0], out[v, 1], out[v, 2] = total[0] / length, total[1] / length, total[2] / length


@kernel
def norm(vector):
    """Length of a vector."""
    return math.sqrt(vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2])


@parallel_kernel
def longest_links(vertices, offsets, neighbours, out):
    """Write the distance of the farthest neighbour of each vertex; 0 without any."""
    for i in prange(len(out)):
        longest = 0.0
        for k in range(offsets[i], offsets[i + 1]):
            square = 0.0
            for c in range(3):
                d = vertices[neighbours[k], c] - vertices[i, c]
                square += d * d
            longest = max(longest, square)
        out[i] = math.sqrt(longest)


@parallel_kernel
def ring_sums(values, offsets, neighbours, out):
    """Write the sum of values (n,) over each vertex and its neighbours."""
    for v in prange(offsets.shape[0] - 1):
        total = values[v]
        for i in range(offsets[v], offsets[v + 1]):
            total += values[neighbours[i]]
        out[v] = total


@parallel_kernel
def ring_averages(values, itself, offsets, neighbours, out):
    """Write the mean of values (n,) over the neighbours of each vertex, and over itself or not; 0 over none."""
    for v in prange(offsets.shape[0] - 1):
        total = values[v]
        for i in range(offsets[v], offsets[v + 1]):
            total += values[neighbours[i]]
        count = offsets[v + 1] - offsets[v]
        out[v] = total / (count + 1) if itself else (total - values[v]) / max(count, 1)


@parallel_kernel
def heights_over_rings(vertices, normals, offsets, neighbours, out):
    """Write the height of each vertex over the mean of its neighbours."""
    for v in prange(offsets.shape[0] - 1):
        count = max(offsets[v + 1] - offsets[v], 1)
        height = 0.0
        for axis in range(3):
            total = vertices[v, axis]
            for i in range(offsets[v], offsets[v + 1]):
                total += vertices[neighbours[i], axis]
            height += normals[v, axis] * (vertices[v, axis] - (total - vertices[v, axis]) / count)
        out[v] = height


@parallel_kernel
def stand_out(heights, least, ratio, offsets, neighbours, out):
    """Write whether the height of a vertex exceeds a least one, and its square that of its neighbours by a ratio."""
    for v in prange(offsets.shape[0] - 1):
        out[v] = abs(heights[v]) > least[v]
        if out[v]:
            own = heights[v] * heights[v]
            total = own
            for i in range(offsets[v], offsets[v + 1]):
                total += heights[neighbours[i]] * heights[neighbours[i]]
            out[v] = own > ratio * ((total - own) / max(offsets[v + 1] - offsets[v], 1))


@parallel_kernel
def mean_edge_lengths(vertices, offsets, neighbours, out):
    """Write the mean distance from each vertex to its neighbours; 0 without any."""
    for v in prange(offsets.shape[0] - 1):
        total = 0.0
        for i in range(offsets[v], offsets[v + 1]):
            total += math.sqrt(squared_distance(vertices, v, neighbours[i]))
        out[v] = total / max(offsets[v + 1] - offsets[v], 1)


@lean
def normal_at(v, surface):
    """The normal at a vertex."""
    return surface.normals[v, 0], surface.normals[v, 1], surface.normals[v, 2]


@lean
def squared_distance(vertices, i, j):
    """Squared Euclidean distance of vertices i and j."""
    x, y, z = vertices[j, 0] - vertices[i, 0], vertices[j, 1] - vertices[i, 1], vertices[j, 2] - vertices[i, 2]
    return x * x + y * y + z * z


@parallel_kernel
def between_neighbours(vertices, rows, around, share, out):
    """Write whether vertices are on the way between two of their neighbours, for all pairs of them in order.

    The way is longer than the distance by no more than a share of it.
    """
    for i in prange(len(rows)):
        pair = 0
        for j in range(around.shape[1]):
            for k in range(j + 1, around.shape[1]):
                whole = math.sqrt(squared_distance(vertices, around[i, j], around[i, k]))
                way = math.sqrt(squared_distance(vertices, rows[i], around[i, j]))
                way += math.sqrt(squared_distance(vertices, rows[i], around[i, k]))
                out[pair, i] = way - whole <= share * whole
                pair += 1


@lean
def spokes(w, is_centre, offsets):
    """Rows of the neighbours of w that a stencil grows to: all of them, but none through a hub."""
    first, last = offsets[w], offsets[w + 1]
    return first, (last if is_centre or last - first <= HUB else first)


@lean
def rings(v, n_rings, surface, members, marks):
    """Write v and all vertices at most so many edges away to `members`; how many, and the largest squared distance."""
    offsets, neighbours = surface.offsets, surface.neighbours
    members[0] = v
    marks[v] = v + 1
    begin, n = 0, 1
    for _ in range(n_rings):
        end = n
        for m in range(begin, end):
            for i in range(*spokes(members[m], m == 0, offsets)):
                w = neighbours[i]
                members[n] = w
                n += marks[w] != v + 1  # without a branch: half of these are new, in no order
                marks[w] = v + 1
        begin = end
    reach = 0.0
    for m in range(1, n):
        reach = max(reach, squared_distance(surface.vertices, v, members[m]))
    return n, reach


@lean
def facing(members, n, normal, surface):
    """Move v, its neighbours and the members whose normals are turned little from a normal to the front; how many."""
    x, y, z = normal
    kept = min(n, 1 + surface.offsets[members[0] + 1] - surface.offsets[members[0]])
    for m in range(kept, n):
        nx, ny, nz = surface.normals[members[m]]
        cosine = x * nx + y * ny + z * nz
        if cosine > FACING or (not surface.is_oriented and cosine < -FACING):
            members[kept], members[m] = members[m], members[kept]
            kept += 1
    return kept


@lean
def local_coordinates(members, n, unit, normal, vertices, points):
    """Write to points[i] the tangential coordinates and the height of member i + 1 seen from member 0, over `unit`.

    Returned is the tangent that x is measured along.
    """
    tangent = monge.some_tangent(normal)
    (ax, ay, az), (nx, ny, nz) = tangent, normal
    bx, by, bz = monge.cross(normal, tangent)
    v = members[0]
    for i in range(n - 1):
        w = members[i + 1]
        x, y, z = vertices[w, 0] - vertices[v, 0], vertices[w, 1] - vertices[v, 1], vertices[w, 2] - vertices[v, 2]
        x, y, z = x / unit, y / unit, z / unit
        points[i, 0] = ax * x + ay * y + az * z
        points[i, 1] = bx * x + by * y + bz * z
        points[i, 2] = nx * x + ny * y + nz * z
    cos, sin = turn_to_long_axis(points, n - 1)
    return monge.combination(cos, tangent, sin, monge.cross(normal, tangent))


@lean
def turn_to_long_axis(points, n):
    """Turn the points about the normal until x is the direction of their largest spread; cosine and sine of the turn.

    What a fit leaves out for lack of points then depends on the points, not on the axes of space.
    """
    xx = xy = yy = 0.0
    for i in range(n):
        xx += points[i, 0] * points[i, 0]
        xy += points[i, 0] * points[i, 1]
        yy += points[i, 1] * points[i, 1]
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    cos, sin = math.cos(angle), math.sin(angle)
    for i in range(n):
        x, y = points[i, 0], points[i, 1]
        points[i, 0], points[i, 1] = cos * x + sin * y, cos * y - sin * x
    return cos, sin


@lean
def stretch_to_chords(points, n):
    """Move the points outwards over the plane until the tangential distance is the distance d.

    The quadratic terms of a jet then are Euler's formula for the curvatures 2 z / d^2, exact on a sphere.
    """
    for i in range(n):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        rho2 = x * x + y * y
        stretch = math.sqrt((rho2 + z * z) / rho2) if rho2 > 0.0 else 0.0
        points[i, 0], points[i, 1] = x * stretch, y * stretch


@parallel_kernel
def count_ranked(offsets, neighbours, index, rank, counts):
    """Write the number of neighbours of index[i] that have a rank."""
    for i in prange(len(index)):
        count = 0
        for k in range(offsets[index[i]], offsets[index[i] + 1]):
            count += rank[neighbours[k]] >= 0
        counts[i] = count


@parallel_kernel
def renumbered_rows(offsets, neighbours, index, rank, new_offsets, out):
    """Write the ranks of the neighbours of index[i] that have one."""
    for i in prange(len(index)):
        m = new_offsets[i]
        for k in range(offsets[index[i]], offsets[index[i] + 1]):
            if rank[neighbours[k]] >= 0:
                out[m] = rank[neighbours[k]]
                m += 1
