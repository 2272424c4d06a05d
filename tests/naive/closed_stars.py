"""Curvature of a closed star by bisection of the sum of its angles."""

import math

from naive.spaceform import angle


def curvature(radii, chords, low, high):
    """The k in [low, high] at which the angles at the centre sum to 2π."""
    n = len(radii)
    for _ in range(60):
        k = (low + high) / 2
        total = sum(angle(chords[i], radii[i], radii[(i + 1) % n], k) for i in range(n))
        if total < 2 * math.pi:
            low = k
        else:
            high = k
    return (low + high) / 2
