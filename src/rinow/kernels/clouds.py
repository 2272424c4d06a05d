"""Points without a mesh: their tangent planes, and their neighbours in Delaunay triangulations over these."""

import math

import numpy as np

from rinow.kernels import monge
from rinow.kernels._jit import kernel, parallel_kernel, prange

FLAT = 1e-12
"""Share of the largest variance that the second one must have for a plane to be determined."""
ROW = 0.05
"""Share up to which the points are one row, along which a surface turns as it will."""
BOX = 4.0
"""Half side of the square that bounds a Voronoi cell, in distances of the farthest neighbour looked at."""
LEVEL = 0.3
"""Points nearer to the normal, by the square of the sine of the angle at the point, are those of another sheet."""
OUTSIDE = -1
"""Owner of the sides of that square."""


@kernel
def covariance(v, near, points, out):
    """Write the covariance of a point and its neighbours."""
    k = near.shape[0] + 1
    mean = np.empty(3)
    for a in range(3):
        mean[a] = points[v, a]
        for i in near:
            mean[a] += points[i, a]
        mean[a] /= k
    for a in range(3):
        for b in range(a, 3):
            total = (points[v, a] - mean[a]) * (points[v, b] - mean[b])
            for i in near:
                total += (points[i, a] - mean[a]) * (points[i, b] - mean[b])
            out[a, b] = out[b, a] = total / k


@parallel_kernel
def plane_normals(points, near, few, out):
    """Write the unit normal of the plane of least squares through each point's neighbours; 0 if they lie on a line.

    These are the first few of the row, or twice as many and so on as long as they are one row of points.  Nothing is
    said about the sign.
    """
    for v in prange(points.shape[0]):
        matrix, k = np.empty((3, 3)), min(few, near.shape[1])
        covariance(v, near[v, :k], points, matrix)
        values, vectors = np.linalg.eigh(matrix)
        while values[1] <= ROW * values[2] and k < near.shape[1]:
            k = min(2 * k, near.shape[1])
            covariance(v, near[v, :k], points, matrix)
            values, vectors = np.linalg.eigh(matrix)
        determined = values[1] > FLAT * values[2]
        for a in range(3):
            out[v, a] = vectors[a, 0] if determined else 0.0


@kernel
def clip(x, y, owner, n, px, py, who, cell, owners):
    """Keep the part of a convex polygon nearer to 0 than to (px, py); its new number of corners.

    Side j runs from corner j to the next one; the new side belongs to `who`.
    """
    limit, m = 0.5 * (px * px + py * py), 0
    for j in range(n):
        k = j + 1 if j + 1 < n else 0
        a, b = x[j] * px + y[j] * py - limit, x[k] * px + y[k] * py - limit
        if a <= 0.0:
            cell[0, m], cell[1, m], owners[m] = x[j], y[j], owner[j]
            m += 1
        if (a <= 0.0) != (b <= 0.0):
            t = a / (a - b)
            cell[0, m], cell[1, m] = x[j] + t * (x[k] - x[j]), y[j] + t * (y[k] - y[j])
            owners[m] = who if a <= 0.0 else owner[j]
            m += 1
    for j in range(m):
        x[j], y[j], owner[j] = cell[0, j], cell[1, j], owners[j]
    return m


@kernel
def star_of(v, near, points, normal, t, skew, plane, work):
    """Write the owners of the sides of the Voronoi cell of v, around the normal; how many.

    These are the neighbours in the Delaunay triangulation of the points over the tangent plane, sheared by `skew`
    along its unit vector t.
    """
    x, y, owner, cell, owners = work
    b = monge.cross(normal, t)
    far = 0.0
    for i in range(near.shape[0]):
        w = near[i]
        dx, dy, dz = points[w, 0] - points[v, 0], points[w, 1] - points[v, 1], points[w, 2] - points[v, 2]
        px, py = t[0] * dx + t[1] * dy + t[2] * dz, b[0] * dx + b[1] * dy + b[2] * dz
        distance2 = dx * dx + dy * dy + dz * dz
        if px * px + py * py < LEVEL * distance2:
            px = py = 0.0
        plane[i, 0], plane[i, 1] = px + skew * py, py
        far = max(far, distance2)
    size = BOX * math.sqrt(far)
    x[0], x[1], x[2], x[3] = -size, size, size, -size
    y[0], y[1], y[2], y[3] = -size, -size, size, size
    owner[:4] = OUTSIDE
    n = 4
    for i in range(near.shape[0]):
        if plane[i, 0] != 0.0 or plane[i, 1] != 0.0:
            n = clip(x, y, owner, n, plane[i, 0], plane[i, 1], i, cell, owners)
    return n


@parallel_kernel
def stars(points, normals, tangents, skews, near, n_blocks, out, counts, gaps):
    """Write to out[v] the neighbours of v around its normal, how many, and the widest angle between two of them."""
    k = near.shape[1]
    for block in prange(n_blocks):
        plane = np.empty((k, 2))
        x, y, cell = np.empty(k + 5), np.empty(k + 5), np.empty((2, k + 5))
        work = (x, y, np.empty(k + 5, np.intp), cell, np.empty(k + 5, np.intp))
        n_points = points.shape[0]
        for v in range(n_points * block // n_blocks, n_points * (block + 1) // n_blocks):
            normal = (normals[v, 0], normals[v, 1], normals[v, 2])
            t = (tangents[v, 0], tangents[v, 1], tangents[v, 2])
            n = star_of(v, near[v], points, normal, t, skews[v], plane, work) if normal != (0.0, 0.0, 0.0) else 0
            counts[v], gaps[v], before, first = 0, 0.0, 0.0, 0.0
            for j in range(n):
                i = work[2][j]
                if i != OUTSIDE:
                    angle = math.atan2(plane[i, 1], plane[i, 0])
                    if counts[v] == 0:
                        first = angle
                    else:
                        gaps[v] = max(gaps[v], (angle - before) % (2.0 * math.pi))
                    before = angle
                    out[v, counts[v]] = near[v, i]
                    counts[v] += 1
            gaps[v] = max(gaps[v], (first - before) % (2.0 * math.pi)) if counts[v] > 1 else 2.0 * math.pi


@parallel_kernel
def keep_ahead(normals, near, least, out):
    """Write near[v, j], or v where the cosine of their normals is not above the least one."""
    for v in prange(near.shape[0]):
        for j in range(near.shape[1]):
            w = near[v, j]
            cosine = normals[v, 0] * normals[w, 0] + normals[v, 1] * normals[w, 1] + normals[v, 2] * normals[w, 2]
            out[v, j] = w if cosine > least else v


@kernel
def is_side(star, count, p, q):
    """Whether p and q are next to each other in a star."""
    for j in range(count):
        if star[j] == p:
            return star[(j + 1) % count] == q or star[j - 1 if j > 0 else count - 1] == q
    return False


@parallel_kernel
def agreement(star, counts, out):
    """Write the share of the triangles of each star that are in the stars of all their corners; 0 for none."""
    for v in prange(star.shape[0]):
        agreed = 0
        for j in range(counts[v]):
            p, q = star[v, j], star[v, (j + 1) % counts[v]]
            agreed += is_side(star[p], counts[p], v, q) and is_side(star[q], counts[q], v, p)
        out[v] = agreed / max(counts[v], 1)


@parallel_kernel
def star_area_vectors(points, normals, star, counts, out):
    """Write the sum of the doubled area vectors of the triangles of each star that face the way of the normal."""
    for v in prange(points.shape[0]):
        nx, ny, nz = normals[v, 0], normals[v, 1], normals[v, 2]
        sx = sy = sz = 0.0
        for j in range(counts[v]):
            p, q = star[v, j], star[v, (j + 1) % counts[v]]
            ax, ay, az = points[p, 0] - points[v, 0], points[p, 1] - points[v, 1], points[p, 2] - points[v, 2]
            bx, by, bz = points[q, 0] - points[v, 0], points[q, 1] - points[v, 1], points[q, 2] - points[v, 2]
            cx, cy, cz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
            if cx * nx + cy * ny + cz * nz > 0.0:
                sx, sy, sz = sx + cx, sy + cy, sz + cz
        out[v, 0], out[v, 1], out[v, 2] = sx, sy, sz


@parallel_kernel
def long_axes(points, normals, star, counts, out):
    """Write the tangent along which the neighbours in each star are farthest, in the mean square; any for none."""
    for v in prange(points.shape[0]):
        n = (normals[v, 0], normals[v, 1], normals[v, 2])
        t = monge.some_tangent(n)
        b = monge.cross(n, t)
        xx = xy = yy = 0.0
        for j in range(counts[v]):
            p = star[v, j]
            dx, dy, dz = points[p, 0] - points[v, 0], points[p, 1] - points[v, 1], points[p, 2] - points[v, 2]
            x, y = t[0] * dx + t[1] * dy + t[2] * dz, b[0] * dx + b[1] * dy + b[2] * dz
            xx, xy, yy = xx + x * x, xy + x * y, yy + y * y
        angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
        axis = monge.combination(math.cos(angle), t, math.sin(angle), b)
        out[v, 0], out[v, 1], out[v, 2] = axis[0], axis[1], axis[2]


@parallel_kernel
def circle_diameters(points, triangles, out):
    """Write the diameters of the circles through three points each; inf if these are on a line."""
    for f in prange(triangles.shape[0]):
        p, q, r = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        a = (points[q, 0] - points[p, 0], points[q, 1] - points[p, 1], points[q, 2] - points[p, 2])
        b = (points[r, 0] - points[p, 0], points[r, 1] - points[p, 1], points[r, 2] - points[p, 2])
        c = monge.combination(1.0, b, -1.0, a)
        across = monge.cross(a, b)
        double_area = math.sqrt(across[0] ** 2 + across[1] ** 2 + across[2] ** 2)
        product = 1.0
        for side in (a, b, c):
            product *= math.sqrt(side[0] ** 2 + side[1] ** 2 + side[2] ** 2)
        out[f] = product / double_area if double_area > 0.0 else np.inf


@kernel
def take_triangles(triangles, sides, reverse, n_points, taken):
    """Take triangles in their order unless one before has a directed side of theirs, or those before close at a corner.

    `sides` numbers their directed sides, the i-th from corner i to the next one; `reverse` has the number of each in
    the other direction.
    """
    used = np.zeros(reverse.shape[0], np.bool_)
    n_taken, n_open = np.zeros(n_points, np.intp), np.zeros(n_points, np.intp)
    for f in range(sides.shape[0]):
        taken[f] = True
        for i in range(3):
            v = triangles[f, i]
            taken[f] &= not used[sides[f, i]] and (n_taken[v] == 0 or n_open[v] > 0)
        if taken[f]:
            for i in range(3):
                v, w = triangles[f, i], triangles[f, (i + 1) % 3]
                used[sides[f, i]] = True
                step = -1 if used[reverse[sides[f, i]]] else 1
                n_open[v], n_open[w] = n_open[v] + step, n_open[w] + step
                n_taken[v] += 1


@kernel
def carry_signs(order, parents, points, normals, signs):
    """Write the sign that each normal needs to be the mirror image of its parent's; 1 where the parent is no point.

    The mirror lies between the two points.
    """
    for v in order:
        p = parents[v]
        signs[v] = 1.0
        if p < signs.shape[0]:
            cosine = square = here = there = 0.0
            for a in range(3):
                step = points[v, a] - points[p, a]
                square += step * step
                here, there = here + step * normals[v, a], there + step * normals[p, a]
                cosine += normals[v, a] * normals[p, a]
            signs[v] = signs[p] if cosine * square >= 2.0 * here * there else -signs[p]
