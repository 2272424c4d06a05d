"""Gromov-Hausdorff and Lipschitz distance by trying all maps.

Kalton and Ostrovskii: 2 d_GH is the least max(dis f, dis g, codis(f, g)) over maps f: X → Y and g: Y → X.
"""

import math
from itertools import permutations, product


def least_distortion(DX, DY):
    """Twice the Gromov-Hausdorff distance: one image after the other is tried while it stays below the best."""
    n, m = len(DX), len(DY)
    places = [p for k in range(max(n, m)) for p in (("f", k), ("g", k)) if k < (n if p[0] == "f" else m)]
    best = max(max(map(max, DX)), max(map(max, DY)))

    def extend(i, pairs, worst):
        nonlocal best
        if worst >= best:
            return
        if i == len(places):
            best = worst
            return
        side, k = places[i]
        options = []
        for image in range(m if side == "f" else n):
            x, y = (k, image) if side == "f" else (image, k)
            value = max((abs(DX[x][a] - DY[y][b]) for a, b in pairs), default=0.0)
            options.append((max(worst, value), x, y))
        for value, x, y in sorted(options):
            extend(i + 1, [*pairs, (x, y)], value)

    extend(0, [], 0.0)
    return best


def lipschitz_distance(DX, DY):
    """Least log of the larger dilatation of a bijection and its inverse, over all permutations."""
    if len(DX) != len(DY):
        return math.inf
    return min(math.log(worst_ratio(DX, DY, f)) for f in permutations(range(len(DX))))


def worst_ratio(DX, DY, f):
    """Larger one of the dilatations of f and its inverse."""
    worst = 1.0
    for i in range(len(f)):
        for j in range(i):
            a, b = DX[i][j], DY[f[i]][f[j]]
            if a != b:
                worst = max(worst, math.inf if min(a, b) == 0 else max(a / b, b / a))
    return worst


def dilatation(DX, DY, f):
    """Largest ratio of the distance of two images to that of the points."""
    pairs = [(DX[i][j], DY[f[i]][f[j]]) for i in range(len(f)) for j in range(i)]
    return max((0.0 if b == 0 else math.inf if a == 0 else b / a for a, b in pairs), default=0.0)


def distortion(pairs, DX, DY):
    """Largest difference of the distances of two pairs."""
    return max(abs(DX[a][c] - DY[b][d]) for a, b in pairs for c, d in pairs)


def least_map_distortion(DX, DY):
    """Least distortion of a map X → Y, over all of them."""
    n = len(DX)
    return min(
        max((abs(DX[i][j] - DY[f[i]][f[j]]) for i in range(n) for j in range(i)), default=0.0)
        for f in product(range(len(DY)), repeat=n)
    )
