"""Euclidean triangles from their side lengths, and sums of their angles at the vertices of a mesh."""

import math

import numpy as np

from rinow.kernels._jit import lean, parallel_kernel, prange


@lean
def excesses(a, b, c):
    """Products (a+b+c), (b+c-a), (a+c-b), (a+b-c), none negative, without cancellation (Kahan 2014)."""
    if a < b:
        a, b = b, a
    if b < c:
        b, c = c, b
        if a < b:
            a, b = b, a
    return a + (b + c), max(c - (a - b), 0.0), max(c + (a - b), 0.0), max(a + (b - c), 0.0)


@lean
def triangle_area(a, b, c):
    """Area by Heron's formula in Kahan's order; 0 for a triple that fails the triangle inequality."""
    p, q, r, s = excesses(a, b, c)
    return 0.25 * math.sqrt(p * q) * math.sqrt(r * s)


@lean
def triangle_angle(a, b, c):
    """Angle opposite a, in [0, pi]: tan^2(angle/2) = (s-b)(s-c) / (s (s-a)).

    A side of length 0 leaves the limit of isosceles triangles: 0 opposite it, pi/2 at its ends, pi/3 if all are 0.
    """
    if a == 0.0 and b == 0.0 and c == 0.0:
        return math.pi / 3.0
    if b == 0.0 or c == 0.0:
        return math.pi / 2.0
    s_b = max(excess(b, a, c), 0.0)
    s_c = max(excess(c, a, b), 0.0)
    s_a = max(excess(a, b, c), 0.0)
    return 2.0 * math.atan2(math.sqrt(s_b) * math.sqrt(s_c), math.sqrt(a + (b + c)) * math.sqrt(s_a))


@lean
def excess(a, b, c):
    """Excess b + c - a, with the two closest lengths subtracted first."""
    return c - (a - b) if b >= c else b - (a - c)


@lean
def triangle_angles(a, b, c):
    """Angles opposite a, b, c; the largest is pi minus the others, so that the sum is pi whatever the rounding."""
    if a >= b and a >= c:
        beta, gamma = triangle_angle(b, c, a), triangle_angle(c, a, b)
        return math.pi - beta - gamma, beta, gamma
    if b >= c:
        gamma, alpha = triangle_angle(c, a, b), triangle_angle(a, b, c)
        return alpha, math.pi - gamma - alpha, gamma
    alpha, beta = triangle_angle(a, b, c), triangle_angle(b, c, a)
    return alpha, beta, math.pi - alpha - beta


@lean
def difference(vertices, i, j):
    """Vector from vertex j to vertex i."""
    return vertices[i, 0] - vertices[j, 0], vertices[i, 1] - vertices[j, 1], vertices[i, 2] - vertices[j, 2]


@lean
def distance(vertices, i, j):
    """Euclidean distance of vertices i and j."""
    x, y, z = difference(vertices, i, j)
    return math.sqrt(x * x + y * y + z * z)


@parallel_kernel
def linear_faces(lengths, share, out):
    """Write to out[f] whether sides longer than 0 exceed twice the longest by no more than a share of it."""
    for f in prange(lengths.shape[0]):
        a, b, c = lengths[f, 0], lengths[f, 1], lengths[f, 2]
        longest = max(max(a, b), c)
        out[f] = min(min(a, b), c) > 0.0 and a + b + c - 2.0 * longest <= share * longest


@parallel_kernel
def face_edge_lengths(vertices, faces, out):
    """Write the three side lengths of each face, column k opposite corner k."""
    for f in prange(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        out[f, 0] = distance(vertices, j, k)
        out[f, 1] = distance(vertices, k, i)
        out[f, 2] = distance(vertices, i, j)


@parallel_kernel
def signed_volumes(vertices, faces, face_used, flip, origin, out):
    """Write six times the volume of the tetrahedra from a point to the faces, turned as `flip` says; 0 if unused."""
    for f in prange(faces.shape[0]):
        out[f] = 0.0
        if face_used[f]:
            i, j, k = faces[f, 0], faces[f, 2 if flip[f] else 1], faces[f, 1 if flip[f] else 2]
            ax, ay, az = vertices[i, 0] - origin[0], vertices[i, 1] - origin[1], vertices[i, 2] - origin[2]
            bx, by, bz = vertices[j, 0] - origin[0], vertices[j, 1] - origin[1], vertices[j, 2] - origin[2]
            cx, cy, cz = vertices[k, 0] - origin[0], vertices[k, 1] - origin[1], vertices[k, 2] - origin[2]
            out[f] = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)


@parallel_kernel
def face_angles(edge_lengths, angles):
    """Write the three corner angles of each face."""
    for f in prange(edge_lengths.shape[0]):
        a, b, c = edge_lengths[f, 0], edge_lengths[f, 1], edge_lengths[f, 2]
        angles[f, 0], angles[f, 1], angles[f, 2] = triangle_angles(a, b, c)


@parallel_kernel
def face_areas(edge_lengths, areas):
    """Write the area of each face."""
    for f in prange(edge_lengths.shape[0]):
        areas[f] = triangle_area(edge_lengths[f, 0], edge_lengths[f, 1], edge_lengths[f, 2])


@parallel_kernel
def vertex_sums_of_corners(values, offsets, corners, out):
    """Write to out[v] the sum of values (n_faces, 3) over the corners at v."""
    flat = values.reshape(-1)
    for v in prange(offsets.shape[0] - 1):
        total = 0.0
        for i in range(offsets[v], offsets[v + 1]):
            total += flat[corners[i]]
        out[v] = total


@parallel_kernel
def vertex_sums_of_faces(values, offsets, corners, out):
    """Write to out[v] the sum of values (n_faces,) over the faces at v."""
    for v in prange(offsets.shape[0] - 1):
        total = 0.0
        for i in range(offsets[v], offsets[v + 1]):
            total += values[corners[i] // 3]
        out[v] = total


@parallel_kernel
def vertex_normals(vertices, faces, flip, offsets, corners, out):
    """Write unit normals: the mean of the face normals, each weighted by sin / (|a| |b|) at the corner.

    These weights give the exact normal wherever the vertices lie on a sphere (N. Max, 1999).  The normal is 0
    where the faces cancel.
    """
    for v in prange(offsets.shape[0] - 1):
        x = y = z = 0.0
        for i in range(offsets[v], offsets[v + 1]):
            f, k = corners[i] // 3, corners[i] % 3
            p, q = faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
            ax, ay, az = difference(vertices, p, v)
            bx, by, bz = difference(vertices, q, v)
            weight = (ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz)
            if weight > 0.0:
                weight = (-1.0 if flip[f] else 1.0) / weight
                x += weight * (ay * bz - az * by)
                y += weight * (az * bx - ax * bz)
                z += weight * (ax * by - ay * bx)
        length = math.sqrt(x * x + y * y + z * z)
        if length == 0.0 or not np.isfinite(length):
            length = 1.0
            x = y = z = 0.0
        out[v, 0], out[v, 1], out[v, 2] = x / length, y / length, z / length


@parallel_kernel
def short_sides(edge_lengths, share, used, out):
    """Write whether the half-edges of used faces are no longer than a share of the shorter one of the other sides."""
    for f in prange(edge_lengths.shape[0]):
        a, b, c = edge_lengths[f, 0], edge_lengths[f, 1], edge_lengths[f, 2]
        out[f, 0] = used[f] and c <= share * min(a, b)
        out[f, 1] = used[f] and a <= share * min(b, c)
        out[f, 2] = used[f] and b <= share * min(c, a)
