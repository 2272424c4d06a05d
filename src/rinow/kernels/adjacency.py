"""Who touches whom in a list of triangles, in linear time.

Corner c = 3 f + k is corner k of face f.  The same number names the half-edge from corner k to corner k + 1.
"""

import numpy as np

from rinow.kernels._jit import inner, kernel, lean, parallel_kernel, prange

BOUNDARY = -1
"""Partner of a half-edge whose edge has one face."""
NONMANIFOLD = -2
"""Partner of a half-edge whose edge has three or more faces."""
UNUSED = -3
"""Partner of a half-edge of a face that takes no part."""
MANY_CORNERS = 48
"""Above this number of corners at a vertex, sorting them is faster than comparing all pairs."""


@lean
def next_corner(c):
    """The corner after c in its face."""
    return c + 1 if c % 3 < 2 else c - 2


@lean
def previous_corner(c):
    """The corner before c in its face."""
    return c - 1 if c % 3 > 0 else c + 2


@kernel
def corners_of_vertices(faces, face_used, n_vertices):
    """Compressed rows: the corners at vertex v are corners[offsets[v]:offsets[v + 1]], ascending."""
    offsets = np.zeros(n_vertices + 1, np.intp)
    for f in range(faces.shape[0]):
        if face_used[f]:
            for k in range(3):
                offsets[faces[f, k] + 1] += 1
    for v in range(n_vertices):
        offsets[v + 1] += offsets[v]
    corners = np.empty(offsets[n_vertices], np.intp)
    fill = offsets[:-1].copy()
    for f in range(faces.shape[0]):
        if face_used[f]:
            for k in range(3):
                v = faces[f, k]
                corners[fill[v]] = 3 * f + k
                fill[v] += 1
    return offsets, corners


@parallel_kernel
def neighbours_of_corners(faces, corners, after, before):
    """Write the vertices after and before each corner of the rows, so that a row is read without jumps."""
    for i in prange(corners.shape[0]):
        f, k = corners[i] // 3, corners[i] % 3
        after[i], before[i] = faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]


@parallel_kernel
def edges_of_halfedges(offsets, corners, after, before, partners, first):
    """Write the partner and the first half-edge of the edge of every half-edge; each edge at its smaller vertex."""
    for v in prange(offsets.shape[0] - 1):
        start, stop = offsets[v], offsets[v + 1]
        if stop - start > MANY_CORNERS:
            join_sorted(v, corners[start:stop], after[start:stop], before[start:stop], partners, first)
        else:
            join_few(v, corners[start:stop], after[start:stop], before[start:stop], partners, first)


@lean
def join_few(v, corners, after, before, partners, first):
    """Join the half-edges between v and each greater vertex w by looking through all corners at v."""
    for i in range(2 * corners.shape[0]):
        w, h = end_of(i, corners, after, before)
        if w < v:
            continue
        partner, least, count = BOUNDARY, h, 0
        for j in range(corners.shape[0]):
            if after[j] == w or before[j] == w:
                g = corners[j] if after[j] == w else previous_corner(corners[j])
                count += 1
                least = min(least, g)
                if g != h:
                    partner = g
        partners[h], first[h] = (partner if count <= 2 else NONMANIFOLD), least


@inner
def join_sorted(v, corners, after, before, partners, first):
    """The same for a vertex with many corners, in the order of the other vertex."""
    order = ends_in_order(after, before) % (2 * corners.shape[0])
    i = 0
    while i < order.shape[0]:
        w, h = end_of(order[i], corners, after, before)
        stop, least = i, h
        while stop < order.shape[0] and end_of(order[stop], corners, after, before)[0] == w:
            least = min(least, end_of(order[stop], corners, after, before)[1])
            stop += 1
        for j in range(i, stop):
            g = end_of(order[j], corners, after, before)[1]
            other = end_of(order[i + stop - 1 - j], corners, after, before)[1]
            if w > v:
                partners[g] = BOUNDARY if stop - i == 1 else other if stop - i == 2 else NONMANIFOLD
                first[g] = least
        i = stop


@inner
def ends_in_order(after, before):
    """The numbers w 2n + i of the i-th half-edges to vertices w, in ascending order."""
    n = after.shape[0]
    keys = np.empty(2 * n, np.int64)
    for i in range(n):
        keys[i], keys[n + i] = after[i] * 2 * n + i, before[i] * 2 * n + n + i
    keys.sort()
    return keys


@lean
def end_of(i, corners, after, before):
    """Other vertex and number of the i-th half-edge at a vertex: first those that leave it, then those that arrive."""
    n = corners.shape[0]
    return (after[i], corners[i]) if i < n else (before[i - n], previous_corner(corners[i - n]))


@lean
def corner_across(c, side, v, faces, partners):
    """The corner at vertex v in the face across the edge after (side 0) or before (side 1) corner c, or -1."""
    h = c if side == 0 else previous_corner(c)
    g = partners[h]
    if g < 0:
        return -1
    return g if faces[g // 3, g % 3] == v else next_corner(g)


@lean
def fan_size(v, faces, offsets, corners, partners):
    """Number of corners at v that are joined to its first one by edges with exactly two faces."""
    start = corners[offsets[v]]
    size = 1
    for side in range(2):
        c, s = start, side
        for _ in range(offsets[v + 1] - offsets[v]):
            h = c if s == 0 else previous_corner(c)
            g = partners[h]
            c = corner_across(c, s, v, faces, partners)
            if c < 0 or c == start:
                break
            size += 1
            s = 1 if c == g else 0
        if c == start:
            return size
    return size


@parallel_kernel
def vertex_manifoldness(faces, offsets, corners, partners, is_manifold, on_boundary, on_nonmanifold_edge):
    """Write whether the faces at a vertex form one fan, and what kinds of edges meet it."""
    for v in prange(offsets.shape[0] - 1):
        on_boundary[v] = False
        on_nonmanifold_edge[v] = False
        for i in range(offsets[v], offsets[v + 1]):
            c = corners[i]
            for h in (c, previous_corner(c)):
                on_boundary[v] |= partners[h] == BOUNDARY
                on_nonmanifold_edge[v] |= partners[h] == NONMANIFOLD
        n = offsets[v + 1] - offsets[v]
        is_manifold[v] = n > 0 and not on_nonmanifold_edge[v] and fan_size(v, faces, offsets, corners, partners) == n


@kernel
def vertex_components(faces, face_used, n_vertices):
    """Label of the connected component of each vertex, in the order of first appearance; -1 without a face."""
    parent = np.arange(n_vertices)
    touched = np.zeros(n_vertices, np.bool_)
    for f in range(faces.shape[0]):
        if not face_used[f]:
            continue
        for k in range(3):
            touched[faces[f, k]] = True
        a = _root(parent, faces[f, 0])
        for k in range(1, 3):
            b = _root(parent, faces[f, k])
            a, b = min(a, b), max(a, b)
            parent[b] = a
    labels = np.full(n_vertices, -1, np.intp)
    count = 0
    for v in range(n_vertices):
        if touched[v]:
            r = _root(parent, v)
            if r == v:
                labels[v] = count
                count += 1
            else:
                labels[v] = labels[r]
    return labels, count


@lean
def _root(parent, v):
    """Representative of v, halving the path to it."""
    while parent[v] != v:
        parent[v] = parent[parent[v]]
        v = parent[v]
    return v


@lean
def all_agree(faces, partners):
    """Whether the half-edges of each edge with two faces run against each other."""
    for h in range(partners.shape[0]):
        g = partners[h]
        if g >= 0 and faces[h // 3, h % 3] == faces[g // 3, g % 3]:
            return False
    return True


@kernel
def face_orientations(faces, face_used, partners):
    """Which faces to turn so that neighbours agree (the minority in each patch), and whether all then agree."""
    n_faces = faces.shape[0]
    flip = np.zeros(n_faces, np.bool_)
    if all_agree(faces, partners):
        return flip, True
    seen = np.zeros(n_faces, np.bool_)
    queue = np.empty(n_faces, np.intp)
    consistent = True
    for start in range(n_faces):
        if seen[start] or not face_used[start]:
            continue
        head, tail, n_flipped = 0, 1, 0
        queue[0] = start
        seen[start] = True
        while head < tail:
            f = queue[head]
            head += 1
            n_flipped += flip[f]
            for k in range(3):
                g = partners[3 * f + k]
                if g < 0:
                    continue
                other = g // 3
                same_direction = faces[f, k] == faces[other, g % 3]
                turn = flip[f] != same_direction
                if not seen[other]:
                    seen[other] = True
                    flip[other] = turn
                    queue[tail] = other
                    tail += 1
                elif flip[other] != turn:
                    consistent = False
        if 2 * n_flipped > tail:
            for i in range(tail):
                flip[queue[i]] = not flip[queue[i]]
    return flip, consistent


@inner
def distinct_neighbours(after, before, out):
    """Number of different vertices in a row of corners; with room in `out` they are written there."""
    n = after.shape[0]
    count = 0
    if n > MANY_CORNERS:
        ends = ends_in_order(after, before) // (2 * n)
        for i in range(2 * n):
            if i == 0 or ends[i] != ends[i - 1]:
                if out.shape[0] > 0:
                    out[count] = ends[i]
                count += 1
        return count
    for i in range(2 * n):
        w = after[i] if i < n else before[i - n]
        is_new = True
        for j in range(i):
            is_new &= (after[j] if j < n else before[j - n]) != w
        if is_new:
            if out.shape[0] > 0:
                out[count] = w
            count += 1
    return count


@parallel_kernel
def count_neighbours(offsets, after, before, counts):
    """Write the number of vertices that share a face with v to counts[v]."""
    nothing = np.empty(0, np.intp)
    for v in prange(offsets.shape[0] - 1):
        row = slice(offsets[v], offsets[v + 1])
        counts[v] = distinct_neighbours(after[row], before[row], nothing)


@parallel_kernel
def neighbours_of_vertices(offsets, after, before, starts, neighbours):
    """Write the vertices that share a face with v, each once, to neighbours[starts[v]:starts[v + 1]]."""
    for v in prange(offsets.shape[0] - 1):
        row = slice(offsets[v], offsets[v + 1])
        distinct_neighbours(after[row], before[row], neighbours[starts[v] : starts[v + 1]])
