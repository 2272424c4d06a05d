"""Jets of surfaces in plain loops: neighbourhoods as sets, least squares by orthogonalisation of the columns."""

import math

from naive.stars import ring


def subtract(p, q):
    return [x - y for x, y in zip(p, q, strict=True)]


def dot(p, q):
    return sum(x * y for x, y in zip(p, q, strict=True))


def cross(p, q):
    return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]


def unit(p):
    return [x / math.sqrt(dot(p, p)) for x in p]


def rings(faces, v, n):
    """Vertices at most n edges away, v left out."""
    found = {v}
    for _ in range(n):
        found |= {x for w in found for x in ring(faces, w)}
    return found - {v}


def local_frame(normal):
    """Two unit vectors orthogonal to the normal and to each other."""
    axis = min(([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]), key=lambda e: abs(dot(e, normal)))
    first = unit(cross(axis, normal))
    return first, cross(normal, first)


def least_squares(columns, target):
    """Coefficients of the columns, by Gram-Schmidt done twice for each column."""
    basis, rows = [], []
    for column in columns:
        rest, row = list(column), [0.0] * len(basis)
        for _ in range(2):
            for i, q in enumerate(basis):
                factor = dot(q, rest)
                row[i] += factor
                rest = [x - factor * y for x, y in zip(rest, q, strict=True)]
        row.append(math.sqrt(dot(rest, rest)))
        basis.append([x / row[-1] for x in rest])
        rows.append(row)
    coefficients = [dot(q, target) for q in basis]
    for i in reversed(range(len(rows))):
        coefficients[i] /= rows[i][i]
        for k in range(i):
            coefficients[k] -= rows[i][k] * coefficients[i]
    return coefficients


def design(points, order, softening, lowest=1):
    """Columns and target of the fit of a polynomial through 0: each height is divided by its squared distance."""
    powers = [(d - e, e) for d in range(lowest, order + 1) for e in range(d + 1)]
    weights = [1 / (x * x + y * y + z * z + softening) for x, y, z in points]
    columns = [[w * x**a * y**b for w, (x, y, _) in zip(weights, points, strict=True)] for a, b in powers]
    return weights, columns, [w * z for w, (_, _, z) in zip(weights, points, strict=True)]


def curvatures(f1, f2, f11, f12, f22):
    """Gaussian and mean curvature of a graph from its fundamental forms; convex upwards is negative."""
    E, F, G = 1 + f1 * f1, f1 * f2, 1 + f2 * f2
    w = math.sqrt(1 + f1 * f1 + f2 * f2)
    L, M, N = f11 / w, f12 / w, f22 / w
    det = E * G - F * F
    return (L * N - M * M) / det, -(E * N - 2 * F * M + G * L) / (2 * det)


def places(vertices, normal, members, v, size):
    """Tangential coordinates and heights of the members seen from v, over size."""
    a, b = local_frame(normal)
    shifts = [[x / size for x in subtract(vertices[w], vertices[v])] for w in members]
    return [[dot(a, d), dot(b, d), dot(normal, d)] for d in shifts]


def jet_curvatures(vertices, normal, members, v, size, order, softening):
    """K and H at v from the members around it."""
    _, columns, target = design(places(vertices, normal, members, v, size), order, softening)
    c = least_squares(columns, target)
    K, H = curvatures(c[0], c[1], 2 * c[2], c[3], 2 * c[4])
    return K / size**2, H / size


def jet_with_centre(vertices, normal, members, v, size, order, softening):
    """K, H and the unit normal at v from the members around it and v itself, which need not lie on the polynomial."""
    a, b = local_frame(normal)
    points = [*places(vertices, normal, members, v, size), [0.0, 0.0, 0.0]]
    _, columns, target = design(points, order, softening, 0)
    _, f1, f2, c11, f12, c22, *_ = least_squares(columns, target)
    K, H = curvatures(f1, f2, 2 * c11, f12, 2 * c22)
    found = unit([n - f1 * x - f2 * y for n, x, y in zip(normal, a, b, strict=True)])
    return K / size**2, H / size, found
