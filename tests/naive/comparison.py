"""Bounds of curvature by drawing: the third triangle must close the figure of the two others in S_k."""

import itertools
import math

from naive import spaceform


def largest_k(fails, high, scale):
    """The k below which `fails` is false and above which it is true; -inf if it is true however small k is."""
    if not fails(high):
        return high
    low = high - 1 / scale**2
    while fails(low):
        low = high - 4 * (high - low)
        if low < -900 / scale**2:
            return -math.inf
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if fails(middle) else (middle, high)
    return low


def room(lengths):
    """Largest k for which a triangle fits into S_k."""
    return (2 * math.pi / sum(lengths)) ** 2


def does_not_close(v, i, j, m, k):
    """Two triangles side by side at v leave less than their third side, or nothing, to the third triangle."""
    (vi, vj, vm), (ij, jm, im) = v, (i, j, m)
    angle = spaceform.angle(ij, vi, vj, k) + spaceform.angle(jm, vj, vm, k)
    return angle > math.pi and im > spaceform.side(vi, vm, 2 * math.pi - angle, k)


def folds(side, diagonal, other, k):
    """The second diagonal is longer than the quadrilateral, convex at both ends of the first one, has room for."""
    (vi, vj), (oi, oj) = side
    at_v = spaceform.angle(oi, vi, diagonal, k) + spaceform.angle(oj, vj, diagonal, k)
    at_o = spaceform.angle(vi, oi, diagonal, k) + spaceform.angle(vj, oj, diagonal, k)
    return max(at_v, at_o) < math.pi and other > spaceform.side(vi, vj, at_v, k)


def bounds(D, rtol=0.0):
    """Largest k of which no four points contradict curvature >= k, and smallest of which none contradict <= k."""
    longer, shorter, n = 1 + rtol, 1 - rtol, len(D)
    lower, upper = math.inf, -math.inf
    for triple in itertools.combinations(range(n), 3):
        lower = min(lower, room(shorter * D[i][j] for i, j in itertools.combinations(triple, 2)))
    for Q in itertools.combinations(range(n), 4):
        scale = max(D[i][j] for i in Q for j in Q)
        for v in Q:
            i, j, m = (p for p in Q if p != v)
            high = min(
                room([longer * D[v][a], longer * D[v][b], longer * D[a][b]]) for a, b in ((i, j), (j, m), (m, i))
            )
            rays = [longer * D[v][p] for p in (i, j, m)]
            far = [shorter * D[i][j], shorter * D[j][m], shorter * D[i][m]]
            k = largest_k(lambda k, rays=rays, far=far: does_not_close(rays, *far, k), high, scale)
            lower = min(lower, k if k < high else math.inf)
        high = min(
            room(longer * D[i][j] for i, j in itertools.combinations(t, 2)) for t in itertools.combinations(Q, 3)
        )
        for o in Q[1:]:
            v = Q[0]
            i, j = (p for p in Q if p not in (v, o))
            sides = [(longer * D[p][i], longer * D[p][j]) for p in (v, o)]
            for d, e, s in ((D[v][o], D[i][j], sides), (D[i][j], D[v][o], list(zip(*sides, strict=True)))):
                holds = lambda k, d=d, e=e, s=s: not folds(s, shorter * d, shorter * e, k)  # noqa: E731
                upper = max(upper, largest_k(holds, high, scale))
    return lower, upper
