"""Robinson's curvature by the angles of Euclidean triangles, the exact one by bisection of the straight angle."""

import math

from naive.spaceform import angle


def curvature(d):
    """6 (cos A + cos A') / (d24 (d12 sin² A + d23 sin² A'))."""
    a, _, e, c, b, f = d
    A, B = angle(e, a, b, 0.0), angle(f, c, b, 0.0)
    return 6 * (math.cos(A) + math.cos(B)) / (b * (a * math.sin(A) ** 2 + c * math.sin(B) ** 2))


def exact_curvature(d, low, high):
    """The k in [low, high] at which the two angles at the second point make up a straight one."""
    a, _, e, c, b, f = d
    for _ in range(60):
        k = (low + high) / 2
        if angle(e, a, b, k) + angle(f, c, b, k) < math.pi:
            low = k
        else:
            high = k
    return (low + high) / 2
