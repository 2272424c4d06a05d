"""A neighbourhood unrolled into the plane, and a local linear regression over it, in plain loops.

Angles and places by the law of cosines, the regression by the normal equations.
"""

import math

from naive.stars import faces_at

GROWTH = 0.75


def angle(opposite, b, c):
    return math.acos(min(1.0, max(-1.0, (b * b + c * c - opposite * opposite) / (2 * b * c))))


def fan(faces, v):
    """Neighbours of an interior vertex in cyclic order."""
    successor = {f[1]: f[2] for f in faces_at(faces, v)}
    order = [next(iter(successor))]
    while len(order) < len(successor):
        order.append(successor[order[-1]])
    return order


def beyond(p, q, along, height, inside):
    """The point at a height over the line pq, `along` from the middle of pq, on the other side than a third one."""
    d = math.hypot(q[0] - p[0], q[1] - p[1])
    u, w = (q[0] - p[0]) / d, (q[1] - p[1]) / d
    middle = (p[0] + q[0]) / 2, (p[1] + q[1]) / 2
    if u * (inside[1] - middle[1]) - w * (inside[0] - middle[0]) > 0:
        height = -height
    return middle[0] + along * u - height * w, middle[1] + along * w + height * u


def place(faces, length, places, w, p, new):
    """Place of `new` beyond the edge wp: its foot is as far from the middle of the edge as by the true lengths."""
    edge, a, b = length(w, p), length(w, new), length(p, new)
    cosine = math.cos(angle(b, edge, a))
    along, height = a * cosine - edge / 2, a * math.sqrt(max(1 - cosine * cosine, 0.0))
    thirds = [x for f in faces if w in f and p in f for x in f if x not in (w, p, new)]
    known = [places[x] for x in thirds if x in places]
    return beyond(places[w], places[p], along, height, known[0] if known else (0.0, 0.0))


def develop(faces, length, v, radius):
    """Places of the vertices around an interior vertex, whose angles are scaled to 2π, as a dict."""
    ring = fan(faces, v)
    turns = [angle(length(a, b), length(v, a), length(v, b)) for a, b in zip(ring, ring[1:] + ring[:1], strict=True)]
    places, phi = {v: (0.0, 0.0)}, 0.0
    for w, turn in zip(ring, turns, strict=True):
        places[w] = length(v, w) * math.cos(phi), length(v, w) * math.sin(phi)
        phi += turn * 2 * math.pi / sum(turns)
    wave = ring
    while wave:
        found = {}
        for w in wave:
            if math.hypot(*places[w]) >= GROWTH * radius:
                continue
            for _, a, b in faces_at(faces, w):
                for p, new in ((a, b), (b, a)):
                    if p in places and new not in places:
                        found.setdefault(new, []).append(place(faces, length, places, w, p, new))
        for new, all_places in found.items():
            places[new] = tuple(sum(x) / len(all_places) for x in zip(*all_places, strict=True))
        wave = list(found)
    return places


def regression_row(places, areas, radius):
    """Weights of the values at the vertices in the linear regression at the origin, as a dict."""
    rows = {}
    for w, (x, y) in places.items():
        s = 1 - (x * x + y * y) / radius**2
        if s > 0 and areas[w] > 0:
            rows[w] = areas[w] * s**3, (1.0, x, y)
    normal = [[sum(m * t[i] * t[j] for m, t in rows.values()) for j in range(3)] for i in range(3)]
    solution = solve(normal, [1.0, 0.0, 0.0])
    return {w: m * sum(c * x for c, x in zip(solution, t, strict=True)) for w, (m, t) in rows.items()}


def solve(A, b):
    """Cramer's rule for three unknowns."""

    def determinant(M):
        (a, b, c), (d, e, f), (g, h, i) = M
        return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)

    whole = determinant(A)
    columns = []
    for k in range(3):
        columns.append(determinant([[b[i] if j == k else A[i][j] for j in range(3)] for i in range(3)]) / whole)
    return columns
