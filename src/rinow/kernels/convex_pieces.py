"""Convex pieces of a triangle in space, and how planes cut them."""

import math

from rinow.kernels._jit import kernel
from rinow.kernels.box_trees import triangle_gap

ROOM, CORNERS, FEW = 256, 32, 8
"""Pieces that wait at most, corners of a piece at most, and before three cuts: a cut adds at most half of them."""


@kernel
def centre(piece, n):
    """Mean of the corners of a piece."""
    x, y, z = 0.0, 0.0, 0.0
    for i in range(n):
        x, y, z = x + piece[i, 0], y + piece[i, 1], z + piece[i, 2]
    return x / n, y / n, z / n


@kernel
def area(piece, n):
    """Area of a flat piece."""
    x, y, z = 0.0, 0.0, 0.0
    for i in range(2, n):
        ax, ay, az = piece[i - 1, 0] - piece[0, 0], piece[i - 1, 1] - piece[0, 1], piece[i - 1, 2] - piece[0, 2]
        bx, by, bz = piece[i, 0] - piece[0, 0], piece[i, 1] - piece[0, 1], piece[i, 2] - piece[0, 2]
        x, y, z = x + ay * bz - az * by, y + az * bx - ax * bz, z + ax * by - ay * bx
    return 0.5 * math.sqrt(x * x + y * y + z * z)


@kernel
def reach(piece, n, corners, t, error):
    """Greatest distance of a piece from one triangle: at a corner, since the distance from a convex set is convex.

    The bound includes the error of rounding, except where a corner of the piece is a corner of the triangle.
    """
    greatest = 0.0
    for i in range(n):
        x, y, z = piece[i, 0], piece[i, 1], piece[i, 2]
        if not _is_corner(corners, t, x, y, z):
            greatest = max(greatest, math.sqrt(triangle_gap(corners, t, x, y, z)) + error)
    return greatest


@kernel
def _is_corner(corners, t, x, y, z):
    """Whether a point is exactly a corner of a triangle."""
    for k in range(0, 9, 3):
        if corners[t, k] == x and corners[t, k + 1] == y and corners[t, k + 2] == z:
            return True
    return False


@kernel
def cut(piece, n, plane, below, above):
    """Cut a piece by the plane a x + b y + c z = d into two with m_below and m_above corners; 0 corners: nothing.

    Both halves get the same new corners, so nothing of the piece is lost.
    """
    m_below, m_above, lowest, highest = 0, 0, 0.0, 0.0
    before = _height(piece, n - 1, plane)
    for i in range(n):
        here, j = _height(piece, i, plane), i - 1 if i > 0 else n - 1
        lowest, highest = min(lowest, here), max(highest, here)
        if (before < 0.0 and here > 0.0) or (before > 0.0 and here < 0.0):
            s = before / (before - here)
            for axis in range(3):
                x = piece[j, axis] + s * (piece[i, axis] - piece[j, axis])
                below[m_below, axis], above[m_above, axis] = x, x
            m_below, m_above = m_below + 1, m_above + 1
        if here <= 0.0:
            _copy(piece, i, below, m_below)
            m_below += 1
        if here >= 0.0:
            _copy(piece, i, above, m_above)
            m_above += 1
        before = here
    if highest == 0.0:
        return m_below, 0
    return (m_below, m_above) if lowest < 0.0 else (0, m_above)


@kernel
def _copy(piece, i, other, j):
    """Make corner j of another piece corner i of this one."""
    other[j, 0], other[j, 1], other[j, 2] = piece[i, 0], piece[i, 1], piece[i, 2]


@kernel
def copy(piece, n, other):
    """Make another piece equal to this one."""
    for i in range(n):
        _copy(piece, i, other, i)


@kernel
def _height(piece, i, plane):
    """Signed height of a corner above a plane, in units of the length of the normal."""
    return plane[0] * piece[i, 0] + plane[1] * piece[i, 1] + plane[2] * piece[i, 2] - plane[3]


@kernel
def halve(piece, n, plane, below, above):
    """Cut a piece across its longest diagonal, or along a diagonal when it has many corners."""
    if n > FEW:
        half = n // 2
        copy(piece, half + 1, below)
        for i in range(half, n):
            _copy(piece, i, above, i - half)
        _copy(piece, 0, above, n - half)
        return half + 1, n - half + 1
    p, q, longest = 0, 0, -1.0
    for i in range(n):
        for j in range(i):
            length = 0.0
            for axis in range(3):
                length += (piece[i, axis] - piece[j, axis]) ** 2
            if length > longest:
                p, q, longest = i, j, length
    plane[3] = 0.0
    for axis in range(3):
        plane[axis] = piece[p, axis] - piece[q, axis]
        plane[3] += 0.5 * plane[axis] * (piece[p, axis] + piece[q, axis])
    return cut(piece, n, plane, below, above)


@kernel
def side_plane(corners, t, k, plane):
    """Write the plane upright on side k of a triangle, its unit normal outwards; False where there is none."""
    a, b, c = 3 * k, 3 * ((k + 1) % 3), 3 * ((k + 2) % 3)
    square, dot, length = 0.0, 0.0, 0.0
    for axis in range(3):
        along = corners[t, b + axis] - corners[t, a + axis]
        square += along * along
        dot += along * (corners[t, c + axis] - corners[t, a + axis])
    if square == 0.0:
        return False
    for axis in range(3):
        along = corners[t, b + axis] - corners[t, a + axis]
        plane[axis] = (dot / square) * along - (corners[t, c + axis] - corners[t, a + axis])
        length += plane[axis] * plane[axis]
    if length == 0.0:
        return False
    length, plane[3] = math.sqrt(length), 0.0
    for axis in range(3):
        plane[axis] /= length
        plane[3] += plane[axis] * corners[t, a + axis]
    return True
