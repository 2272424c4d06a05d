"""Hausdorff distances by plain loops: the neighbourhood form, and triangles by quadratic minimisation."""

import math


def by_neighbourhoods(A, B, distance):
    """Least r among the distances for which each set lies in the closed r-neighbourhood of the other one."""
    values = sorted({distance(a, b) for a in A for b in B})

    def inside(r):
        return all(any(distance(a, b) <= r for b in B) for a in A) and all(
            any(distance(a, b) <= r for a in A) for b in B
        )

    return next(r for r in values if inside(r))


def distance_to_triangle(p, triangle):
    """Distance of a point from a triangle: the least over the foots on its plane, its sides and its corners."""
    a, b, c = triangle
    u, v, w = _minus(b, a), _minus(c, a), _minus(p, a)
    uu, uv, vv, uw, vw = _dot(u, u), _dot(u, v), _dot(v, v), _dot(u, w), _dot(v, w)
    candidates = [a, b, c]
    determinant = uu * vv - uv * uv
    if determinant > 0.0:
        s, t = (vv * uw - uv * vw) / determinant, (uu * vw - uv * uw) / determinant
        if s >= 0.0 and t >= 0.0 and s + t <= 1.0:
            candidates.append([a[k] + s * u[k] + t * v[k] for k in range(3)])
    for x, y in ((a, b), (b, c), (c, a)):
        e = _minus(y, x)
        if _dot(e, e) > 0.0:
            s = min(max(_dot(_minus(p, x), e) / _dot(e, e), 0.0), 1.0)
            candidates.append([x[k] + s * e[k] for k in range(3)])
    return min(math.dist(p, q) for q in candidates)


def distance_to_surface(p, triangles):
    """Distance of a point from a list of triangles."""
    return min(distance_to_triangle(p, triangle) for triangle in triangles)


def samples(triangle, k):
    """Points of a triangle at the barycentric coordinates that are multiples of 1/k."""
    a, b, c = triangle
    for i in range(k + 1):
        for j in range(k + 1 - i):
            yield [(i * a[m] + j * b[m] + (k - i - j) * c[m]) / k for m in range(3)]


def enclosure(A, B, k):
    """Bounds of the Hausdorff distance of two lists of triangles from samples: the distance is 1-Lipschitz."""
    lower, spacing = 0.0, 0.0
    for X, Y in ((A, B), (B, A)):
        for triangle in X:
            sides = [math.dist(triangle[i], triangle[i - 1]) for i in range(3)]
            spacing = max(spacing, max(sides) / k)
            lower = max(lower, max(distance_to_surface(p, Y) for p in samples(triangle, k)))
    return lower, lower + spacing


def _minus(p, q):
    return [x - y for x, y in zip(p, q, strict=True)]


def _dot(p, q):
    return sum(x * y for x, y in zip(p, q, strict=True))
