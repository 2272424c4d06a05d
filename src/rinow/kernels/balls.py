"""Balls of a surface, grown over the edges of its mesh, with the coordinates of their points over a torus."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels import monge
from rinow.kernels._jit import inner, lean, parallel_kernel, prange
from rinow.kernels.osculating_torus import LARGEST_TURN, torus_coordinates

HUB = 100
"""A vertex with more neighbours than this, such as the centre of a fan, joins points that are far from each other."""
OVERHANG = 0.3
"""A ball stops where the normal of the surface and that of the torus have a smaller cosine."""
RISE, STEP = 0.8, 1.0
"""It also stops where the offset exceeds STEP spacings plus RISE times the distance: another sheet lies there."""

LANES = 8
"""Candidates are judged so many at a time, as vector code does; what the last ones lack is made up by old ones."""


class Sheet(NamedTuple):
    """A surface as the fits see it, its vertices in an order that keeps neighbours together.

    Positions and unit normals (n, 3); compressed rows of neighbours (int32); spacing (n,); and
    whether the normals agree in sign.
    """

    vertices: np.ndarray
    normals: np.ndarray
    offsets: np.ndarray
    neighbours: np.ndarray
    spacing: np.ndarray
    is_oriented: bool


class Ball(NamedTuple):
    """Work space of one thread: marks, members, candidates, and columns x, y, z, normal, u1, u2, w, u1^2+u2^2+w^2."""

    marks: np.ndarray
    members: np.ndarray
    candidates: np.ndarray
    raw: np.ndarray
    points: np.ndarray


@inner
def ball(n_vertices, most):
    """Work space for a surface with n vertices and balls of at most so many points."""
    return Ball(
        np.zeros(n_vertices, np.int32),
        np.empty(most, np.int32),
        np.empty(most + 1, np.int32),
        np.zeros((6, most + LANES)),
        np.empty((4, most)),
    )


@lean
def find_unseen(members, first, last, epoch, offsets, neighbours, marks, candidates):
    """Write the unseen neighbours of some members to the candidates; how many.

    Whether a neighbour was seen is as good as random: no branch here depends on it.
    """
    most, count = len(candidates) - 1, 0
    for i in range(first, last):
        p = members[i]
        begin, end = offsets[p], offsets[p + 1]
        if i > 0 and end - begin > HUB:
            continue
        for q in neighbours[begin : min(end, begin + most - count)]:
            candidates[count] = q
            count += marks[q] != epoch
            marks[q] = epoch
    return count


@lean
def keep_near(count, v, spacing, reach, vertices, normals, candidates, raw):
    """Keep the candidates not farther than `reach` from v, and write positions and normals; how many."""
    px, py, pz = vertices[v, 0], vertices[v, 1], vertices[v, 2]
    scale, far = 1.0 / spacing, reach * reach * spacing * spacing
    kept = 0
    for i in range(count):
        q = candidates[i]
        x, y, z = vertices[q, 0] - px, vertices[q, 1] - py, vertices[q, 2] - pz
        candidates[kept] = q
        raw[0, kept], raw[1, kept], raw[2, kept] = x * scale, y * scale, z * scale
        raw[3, kept], raw[4, kept], raw[5, kept] = normals[q, 0], normals[q, 1], normals[q, 2]
        kept += x * x + y * y + z * z < far
    return kept


@lean
def judge(count, frame, spacing, is_oriented, raw):
    """Replace the candidates' positions by torus coordinates; the squared distance, or inf for another sheet."""
    nx, ny, nz = frame[0], frame[1], frame[2]
    ax, ay, az = frame[3], frame[4], frame[5]
    bx, by, bz = frame[6], frame[7], frame[8]
    k1, k2 = frame[9] * spacing, frame[10] * spacing
    for i in range((count + LANES - 1) // LANES * LANES):
        x, y, z = raw[0, i], raw[1, i], raw[2, i]
        mx, my, mz = raw[3, i], raw[4, i], raw[5, i]
        u, v, w, c1, s1, c2, s2 = torus_coordinates(
            ax * x + ay * y + az * z, bx * x + by * y + bz * z, nx * x + ny * y + nz * z, k1, k2
        )
        cosine = c1 * c2 * (nx * mx + ny * my + nz * mz)
        cosine -= s1 * c2 * (ax * mx + ay * my + az * mz) + s2 * (bx * mx + by * my + bz * mz)
        cosine = cosine if is_oriented else abs(cosine)
        rho2 = u * u + v * v
        inside = (min(c1, c2) > LARGEST_TURN) & (cosine > OVERHANG) & (abs(w) < STEP + RISE * math.sqrt(rho2))
        raw[0, i], raw[1, i], raw[2, i], raw[3, i] = u, v, w, (rho2 + w * w if inside else np.inf)


@lean
def grow(v, frame, reach, epoch, sheet, work):
    """Write the members of the ball of `reach` spacings about v and their coordinates in spacings; how many.

    The set does not depend on the order of vertices: a vertex belongs to it if its own coordinates admit it and a path
    of admitted vertices leads to it.
    """
    members, points, raw, candidates, spacing = work.members, work.points, work.raw, work.candidates, sheet.spacing[v]
    members[0] = v
    points[:, 0] = 0.0
    work.marks[v] = epoch
    first, last = 0, 1
    while first < last:
        count = find_unseen(members, first, last, epoch, sheet.offsets, sheet.neighbours, work.marks, candidates)
        count = keep_near(count, v, spacing, reach, sheet.vertices, sheet.normals, candidates, raw)
        judge(count, frame, spacing, sheet.is_oriented, raw)
        n = last
        for i in range(count):
            if raw[3, i] < reach * reach and n < len(members):
                members[n] = candidates[i]
                points[0, n], points[1, n], points[2, n], points[3, n] = raw[0, i], raw[1, i], raw[2, i], raw[3, i]
                n += 1
        first, last = last, n
    return last


@parallel_kernel
def flat_frames(rows, sheet, frames):
    """Write the normal of each vertex and, as tangents, the long and the short axis of its star.

    What a fit leaves out for lack of points then depends on the points, not on the axes of space.
    """
    vertices = sheet.vertices
    for i in prange(len(rows)):
        v = rows[i]
        n = (sheet.normals[v, 0], sheet.normals[v, 1], sheet.normals[v, 2])
        t = monge.some_tangent(n)
        b = monge.cross(n, t)
        xx = xy = yy = 0.0
        for k in range(sheet.offsets[v], sheet.offsets[v + 1]):
            q = sheet.neighbours[k]
            d = (vertices[q, 0] - vertices[v, 0], vertices[q, 1] - vertices[v, 1], vertices[q, 2] - vertices[v, 2])
            x, y = d[0] * t[0] + d[1] * t[1] + d[2] * t[2], d[0] * b[0] + d[1] * b[1] + d[2] * b[2]
            xx, xy, yy = xx + x * x, xy + x * y, yy + y * y
        angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
        cos, sin = math.cos(angle), math.sin(angle)
        first, second = monge.combination(cos, t, sin, b), monge.combination(cos, b, -sin, t)
        for k in range(3):
            frames[i, k], frames[i, 3 + k], frames[i, 6 + k] = n[k], first[k], second[k]
        frames[i, 9], frames[i, 10] = 0.0, 0.0
