"""Regular disks by their definition: try radii."""

import itertools
import math


def is_regular(distances, curvature, radius):
    """Whether every quadruple in the open disk around point 0 has a curvature of modulus below π²/(16 radius²).

    `curvature` returns the smaller modulus of the embedding curvatures of four points, inf for none, 0 on a line.
    """
    inside = [p for p, d in enumerate(distances[0]) if d < radius]
    bound = math.pi**2 / (16 * radius**2)
    return all(curvature(Q) < bound for Q in itertools.combinations(inside, 4))


def regular_radius(distances, curvature):
    """The largest regular radius, by bisection in the bracket from 0 to four times the largest distance."""
    low, high = 0.0, 4 * max(distances[0])
    if is_regular(distances, curvature, high):
        return math.inf
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_regular(distances, curvature, middle) else (low, middle)
    return low
