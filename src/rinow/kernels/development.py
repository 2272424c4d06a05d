"""The neighbourhood of a vertex unrolled into the plane, by edge lengths alone."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels._jit import inlined, kernel
from rinow.kernels.adjacency import corner_across, next_corner, previous_corner

HUB = 100
"""Developments grow through no vertex with more corners than this, such as the centre of a fan: it is near too many."""


GROWTH = 0.75
"""Share of the radius within which members carry the growth on: their stars reach the radius."""


SLIM, SLIVERS = 0.01, 4
"""Shares of a spacing that errors of places reach, and faces in a row that are looked at beyond one so slim."""


class Metric(NamedTuple):
    """Faces (n, 3), their side lengths, angles and areas, compressed rows of corners, and partners of half-edges."""

    faces: np.ndarray
    lengths: np.ndarray
    angles: np.ndarray
    areas: np.ndarray
    offsets: np.ndarray
    corners: np.ndarray
    partners: np.ndarray


@kernel
def is_member(v, n, members, slots):
    """Whether v is among the first n members; `slots` need not be cleared between uses."""
    s = slots[v]
    return 0 <= s < n and members[s] == v


@kernel
def place(v, x, y, n, members, slots, points):
    """Append v at (x, y) unless it is a member; the new number of members."""
    if is_member(v, n, members, slots) or n == members.shape[0]:
        return n
    members[n], slots[v] = v, n
    points[n, 0], points[n, 1] = x, y
    return n + 1


@kernel
def end_beside(c, side, faces):
    """Vertex at the end of the edge after (side 0) or before (side 1) the vertex of corner c, and the edge's column."""
    f, k = c // 3, c % 3
    return (faces[f, (k + 1) % 3], (k + 2) % 3) if side == 0 else (faces[f, (k + 2) % 3], (k + 1) % 3)


@kernel
def fan_angle(v, metric):
    """Sum of the angles at v."""
    total = 0.0
    for i in range(metric.offsets[v], metric.offsets[v + 1]):
        total += metric.angles[metric.corners[i] // 3, metric.corners[i] % 3]
    return total


@kernel
def lay_out_fan(v, stretch, metric, members, slots, points):
    """Place v at the origin and its neighbours around it, one after the other, the angles times `stretch`; how many."""
    start = metric.corners[metric.offsets[v]]
    n = place(v, 0.0, 0.0, 0, members, slots, points)
    w, column = end_beside(start, 1, metric.faces)
    n = place(w, metric.lengths[start // 3, column], 0.0, n, members, slots, points)
    for side in range(2):
        c, s, turn, phi = start, side, stretch if side == 0 else -stretch, 0.0
        for i in range(metric.offsets[v + 1] - metric.offsets[v]):
            if i > 0 or side == 0:
                phi += turn * metric.angles[c // 3, c % 3]
                w, column = end_beside(c, s, metric.faces)
                length = metric.lengths[c // 3, column]
                n = place(w, length * math.cos(phi), length * math.sin(phi), n, members, slots, points)
            g = metric.partners[c if s == 0 else previous_corner(c)]
            c = corner_across(c, s, v, metric.faces, metric.partners)
            if c < 0 or c == start:
                break
            s = 1 if c == g else 0
        if c == start:
            break
    return n


@inlined
def beyond(c, points, p, q, n, metric, members, slots):
    """Place of the vertex of corner c beyond the opposite edge, whose ends are members p and q.

    It lies on the other side than the third vertex of the face across the edge, or than the origin if that is nowhere.
    Where that vertex is too near the edge to tell its side, that of the face beyond it does.
    """
    f, k = c // 3, c % 3
    l, to_p, to_q = metric.lengths[f, k], metric.lengths[f, (k + 1) % 3], metric.lengths[f, (k + 2) % 3]
    if metric.faces[f, (k + 1) % 3] == members[p]:
        to_p, to_q = to_q, to_p
    ex, ey = points[q, 0] - points[p, 0], points[q, 1] - points[p, 1]
    length = math.sqrt(ex * ex + ey * ey)
    mx, my = 0.5 * (points[p, 0] + points[q, 0]), 0.5 * (points[p, 1] + points[q, 1])
    if l == 0.0 or length == 0.0:
        return mx, my
    ex, ey = ex / length, ey / length
    aside = from_origin = ey * mx - ex * my
    g = metric.partners[next_corner(c)]
    for _ in range(SLIVERS):
        i = max(g // 3, 0)
        d = metric.faces[i, (g % 3 + 2) % 3]
        if g < 0 or not is_member(d, n, members, slots):
            aside = from_origin
            break
        s = slots[d]
        aside = ex * (points[s, 1] - my) - ey * (points[s, 0] - mx)
        if abs(aside) > SLIM * length:
            break
        a, b = next_corner(g), previous_corner(g)
        g = metric.partners[a if metric.lengths[i, (a % 3 + 2) % 3] > metric.lengths[i, (b % 3 + 2) % 3] else b]
    height = 2.0 * metric.areas[f] / l
    if aside > 0.0:
        height = -height
    along = 0.5 * (to_p - to_q) * (to_p + to_q) / l
    return mx + along * ex - height * ey, my + along * ey + height * ex


@kernel
def develop(v, radius, stretch, metric, members, slots, points, counts):
    """Unroll the faces around v as far as `radius`; the number of members, each with its place in `points`.

    Waves run out from the fan of v: a vertex with faces on two or more placed vertices gets the mean of the places
    they give it.  Nothing depends on the order of vertices or faces.
    """
    n = lay_out_fan(v, stretch, metric, members, slots, points)
    begin, end = 1, n
    while begin < end:
        for m in range(begin, end):
            w = members[m]
            first, last = metric.offsets[w], metric.offsets[w + 1]
            if last - first > HUB or points[m, 0] ** 2 + points[m, 1] ** 2 >= (GROWTH * radius) ** 2:
                continue
            for i in range(first, last):
                n = place_across(metric.corners[i], m, end, n, metric, members, slots, points, counts)
        for m in range(end, n):
            points[m, 0] /= counts[m]
            points[m, 1] /= counts[m]
        if n == members.shape[0]:
            break
        begin, end = end, n
    return n


@inlined
def place_across(c, m, end, n, metric, members, slots, points, counts):
    """Add a place for the vertex of the face of corner c that is no member yet, if the two others are; see `develop`.

    A face on two members of the last wave counts twice.
    """
    a, b = next_corner(c), previous_corner(c)
    p, q = metric.faces[a // 3, a % 3], metric.faces[b // 3, b % 3]
    is_placed = is_member(p, end, members, slots)
    if is_placed == is_member(q, end, members, slots):
        return n
    if not is_placed:
        b, p, q = a, q, p
    if metric.lengths[b // 3, b % 3] < SLIM * metric.lengths[b // 3, (b % 3 + 1) % 3]:
        return n  # the places of both ends do not tell its direction
    x, y = beyond(b, points, m, slots[p], end, metric, members, slots)
    if is_member(q, n, members, slots):
        s = slots[q]
        points[s, 0] += x
        points[s, 1] += y
        counts[s] += 1
    elif n < members.shape[0]:
        members[n], slots[q], counts[n] = q, n, 1
        points[n, 0], points[n, 1] = x, y
        n += 1
    return n
