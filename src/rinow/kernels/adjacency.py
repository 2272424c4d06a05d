"""Who touches whom in a list of triangles, in linear time.

Corner c = 3 f + k is corner k of face f.  The same number names the half-edge from corner k to corner k + 1.
"""

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange

BOUNDARY = -1
"""Partner of a half-edge whose edge has one face."""
NONMANIFOLD = -2
"""Partner of a half-edge whose edge has three or more faces."""
UNUSED = -3
"""Partner of a half-edge of a face that takes no part."""


@kernel
def next_corner(c):
    """The corner after c in its face."""
    return c + 1 if c % 3 < 2 else c - 2


@kernel
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


@kernel
def edge_of_halfedge(h, faces, offsets, corners):
    """Partner of half-edge h (or BOUNDARY, NONMANIFOLD) and the first half-edge of its edge.

    Only the end with fewer corners is searched, so that a vertex of high degree costs no more than others.
    """
    a, b = faces[h // 3, h % 3], faces[h // 3, next_corner(h) % 3]
    if offsets[b + 1] - offsets[b] < offsets[a + 1] - offsets[a]:
        a, b = b, a
    partner, first, count = BOUNDARY, h, 0
    for i in range(offsets[a], offsets[a + 1]):
        c = corners[i]
        f = c // 3
        if faces[f, next_corner(c) % 3] == b:
            g = c
        elif faces[f, previous_corner(c) % 3] == b:
            g = previous_corner(c)
        else:
            continue
        count += 1
        first = min(first, g)
        if g != h:
            partner = g
    return (partner if count <= 2 else NONMANIFOLD), first


@parallel_kernel
def edges_of_halfedges(faces, face_used, offsets, corners, partners, first):
    """Write the partner and the first half-edge of the edge of every half-edge."""
    for f in prange(faces.shape[0]):
        for k in range(3):
            h = 3 * f + k
            if face_used[f]:
                partners[h], first[h] = edge_of_halfedge(h, faces, offsets, corners)
            else:
                partners[h], first[h] = UNUSED, UNUSED


@kernel
def corner_across(c, side, v, faces, partners):
    """The corner at vertex v in the face across the edge after (side 0) or before (side 1) corner c, or -1."""
    h = c if side == 0 else previous_corner(c)
    g = partners[h]
    if g < 0:
        return -1
    return g if faces[g // 3, g % 3] == v else next_corner(g)


@kernel
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


@kernel
def _root(parent, v):
    """Representative of v, halving the path to it."""
    while parent[v] != v:
        parent[v] = parent[parent[v]]
        v = parent[v]
    return v


@kernel
def face_orientations(faces, face_used, partners):
    """Which faces to turn so that neighbours agree (the minority in each patch), and whether all then agree."""
    n_faces = faces.shape[0]
    flip = np.zeros(n_faces, np.bool_)
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


@kernel
def neighbours_of_vertices(faces, offsets, corners):
    """Compressed rows: vertices that share a face with v, each once, in the order of their corners."""
    n = offsets.shape[0] - 1
    starts = np.zeros(n + 1, np.intp)
    mark = np.full(n, -1, np.intp)
    for v in range(n):
        count = 0
        for i in range(offsets[v], offsets[v + 1]):
            c = corners[i]
            for d in (next_corner(c), previous_corner(c)):
                w = faces[d // 3, d % 3]
                if mark[w] != v:
                    mark[w] = v
                    count += 1
        starts[v + 1] = starts[v] + count
    neighbours = np.empty(starts[n], np.intp)
    mark[:] = -1
    for v in range(n):
        at = starts[v]
        for i in range(offsets[v], offsets[v + 1]):
            c = corners[i]
            for d in (next_corner(c), previous_corner(c)):
                w = faces[d // 3, d % 3]
                if mark[w] != v:
                    mark[w] = v
                    neighbours[at] = w
                    at += 1
    return starts, neighbours
