"""Triangles of constant curvature by the laws of cosines, points by inner products: right, but with lost digits."""

import math


def sine(x, k):
    if k > 0:
        return math.sin(math.sqrt(k) * x) / math.sqrt(k)
    return math.sinh(math.sqrt(-k) * x) / math.sqrt(-k) if k < 0 else x


def cosine(x, k):
    return math.cos(math.sqrt(k) * x) if k > 0 else math.cosh(math.sqrt(-k) * x)


def clip(x):
    return max(-1.0, min(1.0, x))


def angle(a, b, c, k):
    if k == 0:
        return math.acos(clip((b * b + c * c - a * a) / (2 * b * c)))
    over = (cosine(a, k) - cosine(b, k) * cosine(c, k)) / k
    return math.acos(clip(over / (sine(b, k) * sine(c, k))))


def side(b, c, alpha, k):
    if k == 0:
        return math.sqrt(b * b + c * c - 2 * b * c * math.cos(alpha))
    return arc_cosine(cosine(b, k) * cosine(c, k) + k * sine(b, k) * sine(c, k) * math.cos(alpha), k)


def arc_cosine(x, k):
    return math.acos(clip(x)) / math.sqrt(k) if k > 0 else math.acosh(max(x, 1.0)) / math.sqrt(-k)


def area(a, b, c, k):
    if k == 0:
        return 0.5 * b * c * math.sin(angle(a, b, c, k))
    return (angle(a, b, c, k) + angle(b, c, a, k) + angle(c, a, b, k) - math.pi) / k


def distance(p, q, k):
    if k == 0:
        return math.hypot(p[0] - q[0], p[1] - q[1])
    return arc_cosine(k * (p[0] * q[0] + p[1] * q[1]) + (1 - k * p[2]) * (1 - k * q[2]), k)
