"""Shortest paths on any complex of triangles: all straight segments between vertices, then Floyd and Warshall.

A shortest path is a chain of straight segments between vertices, each through a strip of different faces.  All strips
are laid out in the plane by their side lengths; no segment is left out for being long, no wedge for being in the light.
"""

import math


def _cross(p, q):
    return p[0] * q[1] - p[1] * q[0]


def _apex(p, q, pr, qr):
    """The point at the distances pr, qr from p and q, on the right of the way from p to q."""
    x, y = q[0] - p[0], q[1] - p[1]
    pq = math.hypot(x, y)
    along = (pq * pq + pr * pr - qr * qr) / (2 * pq)
    height = math.sqrt(max(pr * pr - along * along, 0.0))
    return p[0] + (along * x + height * y) / pq, p[1] + (along * y - height * x) / pq


def segments_from(faces, length, source, tolerance=1e-9):
    """Least length of a straight segment from the source to each vertex that sees it, as a dict."""
    least = {}

    def see(vertex, distance):
        least[vertex] = min(distance, least.get(vertex, math.inf))

    def follow(strip, a, b, p, q, right, left):
        """Continue behind the edge from a at p to b at q, between the rays through `right` and `left`."""
        for f, face in enumerate(faces):
            if f in strip or a not in face or b not in face:
                continue
            c = next(v for v in face if v not in (a, b))
            r = _apex(p, q, length(a, c), length(b, c))
            size = math.hypot(*r)
            from_right, from_left = _cross(right, r) / math.hypot(*right), _cross(left, r) / math.hypot(*left)
            if from_right >= -tolerance * size and from_left <= tolerance * size:
                see(c, size)
            if from_right > 0:
                follow({*strip, f}, a, c, p, r, right, r if from_left < 0 else left)
            if from_left < 0:
                follow({*strip, f}, c, b, r, q, r if from_right > 0 else right, left)

    for f, face in enumerate(faces):
        if source in face:
            i = face.index(source)
            a, b = face[(i + 1) % 3], face[(i + 2) % 3]
            p = length(source, a), 0.0
            q = _apex((0.0, 0.0), p, length(source, b), length(a, b))
            q = q[0], -q[1]
            see(a, length(source, a))
            see(b, length(source, b))
            follow({f}, a, b, p, q, p, q)
    return least


def geodesic_distances(n_vertices, faces, length):
    """Square list of distances; inf where no path leads."""
    d = [[0.0 if i == j else math.inf for j in range(n_vertices)] for i in range(n_vertices)]
    for source in range(n_vertices):
        for vertex, distance in segments_from(faces, length, source).items():
            d[source][vertex] = min(distance, d[source][vertex])
    for k in range(n_vertices):
        for i in range(n_vertices):
            for j in range(n_vertices):
                d[i][j] = min(d[i][j], d[i][k] + d[k][j])
    return d
