"""The star of a vertex in plain loops: angles by the laws of cosines, curvature by bisection."""

import math
import statistics


def angle(a, b, c, k):
    """Angle opposite a in the surface of curvature k, by the law of cosines of that geometry."""
    if k == 0:
        cosine = (b * b + c * c - a * a) / (2 * b * c)
    elif k > 0:
        m = math.sqrt(k)
        cosine = (math.cos(m * a) - math.cos(m * b) * math.cos(m * c)) / (math.sin(m * b) * math.sin(m * c))
    else:
        m = math.sqrt(-k)
        cosine = (math.cosh(m * b) * math.cosh(m * c) - math.cosh(m * a)) / (math.sinh(m * b) * math.sinh(m * c))
    return math.acos(min(1.0, max(-1.0, cosine)))


def star_curvature(triangles):
    """The k at which the angles opposite the first sides sum to 2 pi, by halving between too small and too large."""
    perimeter = max(map(sum, triangles))
    low, high = -400 / perimeter**2, (2 * math.pi / perimeter) ** 2 * (1 - 1e-12)
    for _ in range(200):
        middle = (low + high) / 2
        if sum(angle(*sides, middle) for sides in triangles) < 2 * math.pi:
            low = middle
        else:
            high = middle
    return (low + high) / 2


def faces_at(faces, v):
    """Faces with the vertex v, each turned to begin with it."""
    return [(*f[f.index(v) :], *f[: f.index(v)]) for f in faces if v in f]


def ring(faces, v):
    """Neighbours of v."""
    return sorted({w for f in faces_at(faces, v) for w in f[1:]})


def ring_deviation(values, faces, v):
    """Standard deviation of the values at v and its neighbours, for a closed star."""
    return statistics.stdev([values[v], *(values[w] for w in ring(faces, v))])


def gauss_defect(curvatures, areas, faces, v):
    """The defect that curvatures varying linearly over each face give the vertex v."""
    total = 0.0
    for face, area in zip(faces, areas, strict=True):
        if v in face:
            total += area * (curvatures[v] + sum(curvatures[w] for w in face)) / 12
    return total
