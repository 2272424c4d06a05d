"""Certified bounds of the greatest distance of one triangulated surface from another.

A triangle of the first surface is covered by convex pieces, each with one triangle of the second surface whose distance
from the piece is known exactly.  A piece that is too far from its triangle is carved: the part above the triangle is
kept, the rest is cut off along the sides and waits for its own nearest triangle.
"""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels import box_trees
from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.box_trees import nearest_triangle
from rinow.kernels.convex_pieces import CORNERS, FEW, ROOM, area, centre, copy, cut, halve, reach, side_plane

BLOCKS = 64
"""Shares of the work; more than threads, so that hard and easy ones mix."""


SHARE, AGE = 1.0 / 32.0, 6
"""A piece is carved when at least this share of it is settled thereby, and so many times in a row at most: pieces that
stand upright on their triangle would become ever narrower, but never shorter."""


class Pieces(NamedTuple):
    """Pieces that wait, on a stack, and room to work."""

    corners: np.ndarray  # (ROOM, CORNERS, 3)
    counts: np.ndarray  # (ROOM,): corners of each
    hints: np.ndarray  # (ROOM,): a triangle near each
    ages: np.ndarray  # (ROOM,): times that each was carved since it was last halved
    work: np.ndarray  # (3, CORNERS, 3)
    plane: np.ndarray  # (4,)
    stack: np.ndarray
    gaps: np.ndarray  # the two of `nearest_triangle`


@kernel
def room_for_pieces():
    """Memory for one thread."""
    return Pieces(
        np.empty((ROOM, CORNERS, 3)),
        np.empty(ROOM, np.intp),
        np.empty(ROOM, np.intp),
        np.empty(ROOM, np.intp),
        np.empty((3, CORNERS, 3)),
        np.empty(4),
        np.empty(box_trees.ROOM, np.intp),
        np.empty(box_trees.ROOM),
    )


@kernel
def carve(pieces, top, n, tree, t, slack):
    """Cut the piece ``work[0]`` by planes upright on the sides of triangle t, moved outwards by `slack`.

    What lies outside is pushed on the stack, what lies inside stays in ``work[0]``; returns its number of corners and
    the new height of the stack.
    """
    piece, inside, plane = pieces.work[0], pieces.work[1], pieces.plane
    x, y, z = centre(piece, n)
    for k in range(3):
        if not side_plane(tree.corners, t, k, plane):
            continue
        outside = plane[0] * x + plane[1] * y + plane[2] * z - plane[3]
        plane[3] += max(slack, outside)  # the centre stays inside: some share of the piece is settled
        m, rest = cut(piece, n, plane, inside, pieces.corners[top])
        if rest > 0:
            pieces.counts[top], pieces.hints[top] = rest, t
            top += 1
        if m > 0:
            copy(inside, m, piece)
            n = m
    return n, top


@kernel
def settle(pieces, top, tree, t, goal, gap, error):
    """Settle the topmost piece, or part of it, by triangle t; returns the new height and the distance of that part.

    Where triangle t is not enough the piece is halved and the distance is 0, for nothing was settled.
    """
    top -= 1
    n, age, work = pieces.counts[top], pieces.ages[top], pieces.work
    far = reach(pieces.corners[top], n, tree.corners, t, error)
    if far <= goal or top + 4 > ROOM:
        return top, far
    slack, least = 0.5 * math.sqrt(max(goal * goal - gap, 0.0)), SHARE * area(pieces.corners[top], n)
    for _ in range(2):
        if n > FEW or age >= AGE:
            break
        copy(pieces.corners[top], n, work[0])
        copy(pieces.corners[top], n, work[2])
        m, height = carve(pieces, top, n, tree, t, slack)
        far = reach(work[0], m, tree.corners, t, error)
        if far <= goal and area(work[0], m) > least:
            pieces.ages[top:height] = age + 1
            return height, far
        copy(work[2], n, pieces.corners[top])
        slack = 0.0
    below, above = halve(pieces.corners[top], n, pieces.plane, work[0], work[1])
    for m, half in ((below, work[0]), (above, work[1])):
        if m > 0:
            copy(half, m, pieces.corners[top])
            pieces.counts[top], pieces.hints[top], pieces.ages[top] = m, t, 0
            top += 1
    return top, 0.0


@kernel
def bound_triangle(corners, i, tree, hints, lower, tolerance, error, pieces, point):
    """Lower and upper bound of the greatest distance of a triangle from the surface, and how many pieces it took.

    The lower bound is at least `lower`; when it is more, the point that has this distance is written to `point`.  The
    upper bound exceeds the lower one by at most `tolerance`.
    """
    n = 3
    for k in range(9):
        pieces.corners[0, k // 3, k % 3] = corners[i, k]
    upper, top, count = np.inf, 1, 0
    for k in range(3):
        upper = min(upper, reach(pieces.corners[0], n, tree.corners, hints[k], error))
    if upper <= lower + tolerance:
        return lower, upper, 0
    pieces.counts[0], pieces.hints[0], pieces.ages[0], upper = n, hints[0], 0, 0.0
    while top > 0:
        x, y, z = centre(pieces.corners[top - 1], pieces.counts[top - 1])
        gap, t = nearest_triangle(tree, x, y, z, pieces.hints[top - 1], pieces.stack, pieces.gaps)
        if math.sqrt(gap) > lower:
            lower = math.sqrt(gap)
            point[0], point[1], point[2] = x, y, z
        top, far = settle(pieces, top, tree, t, lower + tolerance, gap, error)
        upper = max(upper, far)
        count += 1
    return lower, upper, count


@parallel_kernel
def bound_triangles(corners, chosen, tree, hints, lower, tolerance, error, bounds, points, counts):
    """Write the bounds of the chosen triangles, the points that attain the lower ones, and the numbers of pieces."""
    for block in prange(BLOCKS):
        pieces = room_for_pieces()
        for j in range(block, chosen.shape[0], BLOCKS):
            i = chosen[j]
            bounds[i, 0], bounds[i, 1], counts[i] = bound_triangle(
                corners, i, tree, hints[i], lower, tolerance, error, pieces, points[i]
            )
