"""Osculating tori in plain loops: points of the torus by two rotations, curvatures by differences of positions."""

import math

from naive.jets import cross, dot


def torus_point(u1, u2, w, k1, k2):
    """The point at distance w from the torus, whose arcs through the origin are of length u1 and u2."""
    y, z = (math.sin(k2 * u2) / k2, (1 - math.cos(k2 * u2)) / k2) if k2 else (u2, 0.0)
    y, z = y - w * math.sin(k2 * u2), z + w * math.cos(k2 * u2)
    if not k1:
        return [u1, y, z]
    radius = 1 / k1 - z
    return [radius * math.sin(k1 * u1), y, 1 / k1 - radius * math.cos(k1 * u1)]


def offset_curvatures(f, u1, u2, k1, k2, step=1e-3):
    """K and H of the surface w = f(u1, u2) by central differences of sixth order."""
    weights = {-3: -1 / 60, -2: 9 / 60, -1: -45 / 60, 1: 45 / 60, 2: -9 / 60, 3: 1 / 60}

    def point(a, b):
        return torus_point(a, b, f(a, b), k1, k2)

    def derivative(g, axis):
        def slope(a, b):
            total = [0.0, 0.0, 0.0]
            for i, w in weights.items():
                p = g(a + i * step * (axis == 0), b + i * step * (axis == 1))
                total = [t + w * x / step for t, x in zip(total, p, strict=True)]
            return total

        return slope

    X1, X2 = derivative(point, 0), derivative(point, 1)
    a, b = X1(u1, u2), X2(u1, u2)
    aa, ab, bb = derivative(X1, 0)(u1, u2), derivative(X1, 1)(u1, u2), derivative(X2, 1)(u1, u2)
    n = cross(a, b)
    area2 = dot(n, n)
    L, M, N = (dot(x, n) / math.sqrt(area2) for x in (aa, ab, bb))
    E, F, G = dot(a, a), dot(a, b), dot(b, b)
    return (L * N - M * M) / area2, (G * L - 2 * F * M + E * N) / (2 * area2)


def polynomial_columns(points, order, reach):
    """Columns u^a v^b, lowest degrees first, of points (u, v, w) over `reach`."""
    powers = [(d - b, b) for d in range(order + 1) for b in range(d + 1)]
    return [[(u / reach) ** a * (v / reach) ** b for u, v, _ in points] for a, b in powers]


def ball(vertices, neighbours, v, admits):
    """The vertices that are admitted and joined to v by such vertices, v included."""
    found, new = {v}, {v}
    while new:
        new = {x for w in new for x in neighbours[w] if admits(x)} - found
        found |= new
    return found
