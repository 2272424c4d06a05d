"""Cutting a mesh open along edges: the corners at a vertex fall into the sectors that cut edges leave."""

from rinow.kernels._jit import kernel
from rinow.kernels.adjacency import corner_across


@kernel
def sectors(faces, offsets, corners, partners, is_cut, labels):
    """Write to labels[c], for each corner c, the first corner of its sector, in the order of its vertex's row."""
    for v in range(offsets.shape[0] - 1):
        for i in range(offsets[v], offsets[v + 1]):
            labels[corners[i]] = -1
        for i in range(offsets[v], offsets[v + 1]):
            if labels[corners[i]] < 0:
                label_sector(v, corners[i], faces, partners, is_cut, labels)


@kernel
def label_sector(v, start, faces, partners, is_cut, labels):
    """Label the corners that are joined to `start` at v without crossing a cut edge."""
    labels[start] = start
    for side in range(2):
        c, s = start, side
        while True:
            h = c if s == 0 else (c - 1 if c % 3 > 0 else c + 2)
            if partners[h] < 0 or is_cut[h]:
                break
            g = partners[h]
            c = corner_across(c, s, v, faces, partners)
            if c < 0 or labels[c] >= 0:
                break
            labels[c] = start
            s = 1 if c == g else 0


@kernel
def number_sectors(n_vertices, offsets, corners, labels, new_faces, origin, numbers):
    """Number the sectors: the first one of each vertex keeps its number, the others follow; how many there are."""
    n = n_vertices
    for v in range(n_vertices):
        for i in range(offsets[v], offsets[v + 1]):
            c = corners[i]
            if labels[c] == c:
                if i == offsets[v]:
                    numbers[c] = v
                else:
                    numbers[c] = n
                    origin[n] = v
                    n += 1
        for i in range(offsets[v], offsets[v + 1]):
            c = corners[i]
            new_faces[c // 3, c % 3] = numbers[labels[c]]
    return n
