"""Combinatorics of triangles with sets and dictionaries."""

from collections import defaultdict
from math import acos, pi, sqrt


def edge_faces(faces):
    """Faces of each undirected edge."""
    found = defaultdict(list)
    for f, (a, b, c) in enumerate(faces):
        for edge in ((a, b), (b, c), (c, a)):
            found[frozenset(edge)].append(f)
    return dict(found)


def euler_characteristic(faces):
    """Vertices minus edges plus faces of the part that has faces."""
    return len({v for face in faces for v in face}) - len(edge_faces(faces)) + len(faces)


def components(faces, n_vertices):
    """Label of each vertex by flooding, in the order of first appearance; -1 without a face."""
    neighbours = defaultdict(set)
    for face in faces:
        for v in face:
            neighbours[v].update(face)
    labels, count = [-1] * n_vertices, 0
    for start in range(n_vertices):
        if labels[start] >= 0 or start not in neighbours:
            continue
        stack = [start]
        while stack:
            v = stack.pop()
            if labels[v] < 0:
                labels[v] = count
                stack.extend(neighbours[v])
        count += 1
    return labels


def vertex_is_manifold(faces, v):
    """The link of v, two faces over one pair of edges counted twice, is one path or one cycle."""
    link = defaultdict(list)
    for face in faces:
        if v in face:
            a, b = (w for w in face if w != v)
            link[a].append(b)
            link[b].append(a)
    if not link or any(len(w) > 2 for w in link.values()):
        return False
    seen, stack = set(), [next(iter(link))]
    while stack:
        w = stack.pop()
        if w not in seen:
            seen.add(w)
            stack.extend(link[w])
    return len(seen) == len(link)


def angle(a, b, c):
    """Angle opposite a by the law of cosines."""
    return acos(max(-1.0, min(1.0, (b * b + c * c - a * a) / (2 * b * c))))


def area(a, b, c):
    """Heron's formula."""
    s = (a + b + c) / 2
    return sqrt(max(s * (s - a) * (s - b) * (s - c), 0.0))


def angle_defects(faces, edge_lengths, n_vertices):
    """2 pi, or pi at the boundary, minus the angles."""
    boundary = {v for edge, found in edge_faces(faces).items() if len(found) == 1 for v in edge}
    used = {v for face in faces for v in face}
    defects = [0.0 if v not in used else pi if v in boundary else 2 * pi for v in range(n_vertices)]
    for face, lengths in zip(faces, edge_lengths, strict=True):
        for k in range(3):
            defects[face[k]] -= angle(lengths[k], lengths[(k + 1) % 3], lengths[(k + 2) % 3])
    return defects
