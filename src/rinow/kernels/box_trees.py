"""Triangles in a balanced tree of boxes, and the nearest one to a point."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange

LEAF, BLOCK, ROOM = 4, 256, 64
"""Triangles in a leaf at most, points that one thread takes together, and the height of the stack of open boxes."""

BOX, FLAT, VIEW = 11, 256, 7
"""Numbers of a box, the triangles in the largest one that has a slab, and numbers of the view of a box.  Without slabs
and views a point near the centre of a sphere would look into most of its boxes."""

TINY = 1e-150
"""Doubled area below which squares lose digits, and with them a unit vector its length."""

NEEDLE = 1e-6
"""Squared sine of an angle below which the sides of a triangle are asked as well as its plane."""


class BoxTree(NamedTuple):
    """Triangles sorted into a binary tree; box i has the children 2 i and 2 i + 1, and the root is box 1.

    Box i of level l (2^l <= i < 2^(l + 1)) holds the triangles from ``(i - 2^l) n >> l`` to ``(i + 1 - 2^l) n >> l``.
    """

    corners: np.ndarray  # (n, 9), in the order of the tree
    order: np.ndarray  # (n,), number of each triangle before it was sorted
    boxes: np.ndarray  # (2 leaves, BOX): least and greatest coordinates; a unit vector, least and greatest height in it
    depth: int
    eye: np.ndarray  # (3,), a point from which the boxes were looked at
    views: np.ndarray  # (2 leaves, VIEW): least and greatest coordinates of the unit vectors to the eye, least height
    # of the eye in them; or (0, VIEW)
    clear: float  # distance of the triangles from the eye: points within it use the views; 0 without them


@kernel
def sort_into_tree(corners, depth, order):
    """Write the order of the triangles: each box is halved at the median of the centres along its longest side."""
    n = corners.shape[0]
    centres, keys = np.empty((n, 3)), np.empty(n)
    for t in range(n):
        order[t] = t
        for axis in range(3):
            centres[t, axis] = corners[t, axis] + corners[t, 3 + axis] + corners[t, 6 + axis]
    for level in range(depth):
        for j in range(1 << level):
            first, last = j * n >> level, (j + 1) * n >> level
            middle = (2 * j + 1) * n >> (level + 1)
            if first < middle < last:
                axis = _longest_axis(centres, order, first, last)
                for i in range(first, last):
                    keys[i] = centres[order[i], axis]
                _select(keys, order, first, last - 1, middle)


@kernel
def _longest_axis(centres, order, first, last):
    """Coordinate along which some points spread farthest."""
    best, longest = 0, -1.0
    for axis in range(3):
        least = greatest = centres[order[first], axis]
        for i in range(first, last):
            x = centres[order[i], axis]
            least, greatest = min(least, x), max(greatest, x)
        if greatest - least > longest:
            best, longest = axis, greatest - least
    return best


@kernel
def _select(keys, order, low, high, middle):
    """Move the smaller keys of low..high before place `middle` and the larger ones behind it (Hoare)."""
    while low < high:
        pivot, i, j = keys[(low + high) // 2], low, high
        while i <= j:
            while keys[i] < pivot:
                i += 1
            while keys[j] > pivot:
                j -= 1
            if i <= j:
                keys[i], keys[j] = keys[j], keys[i]
                order[i], order[j] = order[j], order[i]
                i, j = i + 1, j - 1
        if middle <= j:
            high = j
        elif middle >= i:
            low = i
        else:
            return


@kernel
def bound_boxes(corners, depth, boxes):
    """Write the boxes, leaves first; those of few triangles with a slab, too, as thin as the surface is flat there."""
    n, leaves = corners.shape[0], 1 << depth
    level, boxes[:, 6:] = depth, 0.0
    for i in range(2 * leaves - 1, 0, -1):
        if i < 1 << level:
            level -= 1
        first, last = (i - (1 << level)) * n >> level, (i + 1 - (1 << level)) * n >> level
        for axis in range(3):
            boxes[i, axis], boxes[i, 3 + axis] = np.inf, -np.inf
        if i < leaves:
            for axis in range(3):
                boxes[i, axis] = min(boxes[2 * i, axis], boxes[2 * i + 1, axis])
                boxes[i, 3 + axis] = max(boxes[2 * i, 3 + axis], boxes[2 * i + 1, 3 + axis])
        else:
            for t in range(first, last):
                for k in range(9):
                    boxes[i, k % 3] = min(boxes[i, k % 3], corners[t, k])
                    boxes[i, 3 + k % 3] = max(boxes[i, 3 + k % 3], corners[t, k])
        if last - first <= FLAT:
            _bound_slab(corners, first, last, boxes[i])


@kernel
def _bound_slab(corners, first, last, box):
    """Write the direction of the mean normal of some triangles, and their heights in it."""
    u, v, w = 0.0, 0.0, 0.0
    for t in range(first, last):
        x, y, z = doubled_area(corners, t)
        u, v, w = u + x, v + y, w + z
    size = math.sqrt(_square(u, v, w))
    if not size > TINY:
        return
    box[6], box[7], box[8], box[9], box[10] = u / size, v / size, w / size, np.inf, -np.inf
    for t in range(first, last):
        for k in range(0, 9, 3):
            height = box[6] * corners[t, k] + box[7] * corners[t, k + 1] + box[8] * corners[t, k + 2]
            box[9], box[10] = min(box[9], height), max(box[10], height)


@kernel
def bound_views(tree):
    """Write how the boxes look from the eye, leaves first.

    A unit vector u points to the eye from the nearest point of each triangle.  If all of the triangle lies at least h
    below the eye in this direction, then it is at least h + u · v away from the point at the offset v from the eye.
    """
    n, leaves, eye, views = tree.corners.shape[0], 1 << tree.depth, tree.eye, tree.views
    for i in range(2 * leaves - 1, 0, -1):
        views[i, :3], views[i, 3:6], views[i, 6] = np.inf, -np.inf, np.inf
        if i < leaves:
            for k in range(7):
                one, other = views[2 * i, k], views[2 * i + 1, k]
                views[i, k] = max(one, other) if 3 <= k < 6 else min(one, other)
            continue
        for t in range((i - leaves) * n >> tree.depth, (i + 1 - leaves) * n >> tree.depth):
            x, y, z = foot_on_triangle(tree.corners, t, eye[0], eye[1], eye[2])
            u, v, w = eye[0] - x, eye[1] - y, eye[2] - z
            size = max(math.sqrt(_square(u, v, w)), TINY)
            u, v, w, height = u / size, v / size, w / size, np.inf
            for k in range(0, 9, 3):
                x, y, z = eye[0] - tree.corners[t, k], eye[1] - tree.corners[t, k + 1], eye[2] - tree.corners[t, k + 2]
                height = min(height, u * x + v * y + w * z)
            for axis, value in enumerate((u, v, w)):
                views[i, axis], views[i, 3 + axis] = min(views[i, axis], value), max(views[i, 3 + axis], value)
            views[i, 6] = min(views[i, 6], height)


@kernel
def gap_of_view(tree, i, x, y, z):
    """Squared distance of a point from a box, as far as the view of the box tells."""
    u, v, w, view = x - tree.eye[0], y - tree.eye[1], z - tree.eye[2], tree.views[i]
    along = min(u * view[0], u * view[3]) + min(v * view[1], v * view[4]) + min(w * view[2], w * view[5])
    height = max(view[6] + along, 0.0)
    return height * height


@kernel
def is_surrounded(tree, x, y, z):
    """Whether a point is nearer to the eye than all triangles, so that the views tell much."""
    return _square(x - tree.eye[0], y - tree.eye[1], z - tree.eye[2]) < tree.clear * tree.clear


@kernel
def gap_of(tree, i, x, y, z, surrounded):
    """Lower bound of the squared distance of a point from the triangles in a box."""
    gap = box_gap(tree.boxes, i, x, y, z)
    return max(gap, gap_of_view(tree, i, x, y, z)) if surrounded else gap


@kernel
def doubled_area(corners, t):
    """Vector at right angles to a triangle, twice as long as its area."""
    bx, by, bz = corners[t, 3] - corners[t, 0], corners[t, 4] - corners[t, 1], corners[t, 5] - corners[t, 2]
    cx, cy, cz = corners[t, 6] - corners[t, 0], corners[t, 7] - corners[t, 1], corners[t, 8] - corners[t, 2]
    return by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx


@kernel
def box_gap(boxes, i, x, y, z):
    """Squared distance of a point from a box, or from its slab if that is farther."""
    u = max(max(boxes[i, 0] - x, x - boxes[i, 3]), 0.0)
    v = max(max(boxes[i, 1] - y, y - boxes[i, 4]), 0.0)
    w = max(max(boxes[i, 2] - z, z - boxes[i, 5]), 0.0)
    height = boxes[i, 6] * x + boxes[i, 7] * y + boxes[i, 8] * z
    above = max(max(boxes[i, 9] - height, height - boxes[i, 10]), 0.0)
    return max(u * u + v * v + w * w, above * above)


@kernel
def nearest_triangle(tree, x, y, z, hint, stack, gaps):
    """Nearest triangle to a point and its squared distance; `hint` is any triangle, the nearer the faster."""
    n, leaves, surrounded = tree.corners.shape[0], 1 << tree.depth, is_surrounded(tree, x, y, z)
    best, nearest = triangle_gap(tree.corners, hint, x, y, z), hint
    stack[0], gaps[0], top = 1, gap_of(tree, 1, x, y, z, surrounded), 1
    while top > 0:
        top -= 1
        i = stack[top]
        if gaps[top] >= best:
            continue
        if i >= leaves:
            for t in range((i - leaves) * n >> tree.depth, (i + 1 - leaves) * n >> tree.depth):
                gap = triangle_gap(tree.corners, t, x, y, z)
                if gap < best:
                    best, nearest = gap, t
            continue
        left, right = gap_of(tree, 2 * i, x, y, z, surrounded), gap_of(tree, 2 * i + 1, x, y, z, surrounded)
        near = 2 * i if left <= right else 2 * i + 1
        if max(left, right) < best:
            stack[top], gaps[top] = 4 * i + 1 - near, max(left, right)
            top += 1
        if min(left, right) < best:
            stack[top], gaps[top] = near, min(left, right)
            top += 1
    return best, nearest


@kernel
def triangle_gap(corners, t, x, y, z):
    """Squared distance of a point from a triangle."""
    u, v, w = foot_on_triangle(corners, t, x, y, z)
    return _square(x - u, y - v, z - w)


@kernel
def _square(x, y, z):
    """Squared length of a vector."""
    return x * x + y * y + z * z


@kernel
def foot_on_triangle(corners, t, x, y, z):
    """Point of a triangle that is nearest to (x, y, z); the triangle may be a segment or a point."""
    ax, ay, az = corners[t, 0], corners[t, 1], corners[t, 2]
    bx, by, bz = corners[t, 3] - ax, corners[t, 4] - ay, corners[t, 5] - az
    cx, cy, cz = corners[t, 6] - ax, corners[t, 7] - ay, corners[t, 8] - az
    px, py, pz = x - ax, y - ay, z - az
    nx, ny, nz = by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx
    square = nx * nx + ny * ny + nz * nz
    if square == 0.0:
        return _foot_on_sides(corners, t, x, y, z)
    beta = (nx * (py * cz - pz * cy) + ny * (pz * cx - px * cz) + nz * (px * cy - py * cx)) / square
    gamma = (nx * (by * pz - bz * py) + ny * (bz * px - bx * pz) + nz * (bx * py - by * px)) / square
    if not (beta >= 0.0 and gamma >= 0.0 and beta + gamma <= 1.0):
        return _foot_on_sides(corners, t, x, y, z)
    u, v, w = ax + beta * bx + gamma * cx, ay + beta * by + gamma * cy, az + beta * bz + gamma * cz
    if square > NEEDLE * (bx * bx + by * by + bz * bz) * (cx * cx + cy * cy + cz * cz):
        return u, v, w
    fx, fy, fz = _foot_on_sides(corners, t, x, y, z)  # the plane of a needle is vague: a side may be nearer
    gap, side = _square(x - u, y - v, z - w), _square(x - fx, y - fy, z - fz)
    return (u, v, w) if gap < side else (fx, fy, fz)


@kernel
def _foot_on_sides(corners, t, x, y, z):
    """Point of the three sides that is nearest to (x, y, z); end points are met exactly."""
    best, fx, fy, fz = np.inf, 0.0, 0.0, 0.0
    for k in range(3):
        i, j = 3 * k, 3 * ((k + 1) % 3)
        ax, ay, az = corners[t, i], corners[t, i + 1], corners[t, i + 2]
        ex, ey, ez = corners[t, j] - ax, corners[t, j + 1] - ay, corners[t, j + 2] - az
        dot, square = (x - ax) * ex + (y - ay) * ey + (z - az) * ez, ex * ex + ey * ey + ez * ez
        if dot <= 0.0 or square == 0.0:
            u, v, w = ax, ay, az
        elif dot >= square:
            u, v, w = corners[t, j], corners[t, j + 1], corners[t, j + 2]
        else:
            s = dot / square
            u, v, w = ax + s * ex, ay + s * ey, az + s * ez
        gap = _square(x - u, y - v, z - w)
        if gap < best:
            best, fx, fy, fz = gap, u, v, w
    return fx, fy, fz


@parallel_kernel
def nearest_triangles(tree, points, order, nearest, distances):
    """Write the nearest triangle of each point of a list, and its distance; neighbours in the list help each other."""
    for block in prange((order.shape[0] + BLOCK - 1) // BLOCK):
        stack, gaps, hint = np.empty(ROOM, np.intp), np.empty(ROOM), 0
        for i in range(block * BLOCK, min((block + 1) * BLOCK, order.shape[0])):
            p = order[i]
            gap, hint = nearest_triangle(tree, points[p, 0], points[p, 1], points[p, 2], hint, stack, gaps)
            nearest[p], distances[p] = hint, math.sqrt(gap)
