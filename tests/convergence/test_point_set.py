"""The fitted curvature of shrinking sets on a paraboloid tends to the Gaussian curvature at its vertex."""

import numpy as np
import pytest

import rinow


def paraboloid_distances(points, a, b):
    """Lengths of lifted straight segments on z = (a x² + b y²)/2.

    They exceed the geodesic distances by a relative O(h⁴) in the size h of the set, and the curvature by O(h²).
    """
    n = len(points)
    nodes, weights = np.polynomial.legendre.leggauss(12)
    t, weights = (nodes + 1) / 2, weights / 2
    D = np.zeros((n, n))
    for i in range(n):
        for j in range(i):
            p, step = points[j], points[i] - points[j]
            x, y = p[:, None] + step[:, None] * t
            rise = a * x * step[0] + b * y * step[1]
            D[i, j] = D[j, i] = np.sqrt(step @ step + rise**2) @ weights
    return D


@pytest.mark.parametrize(("a", "b"), [(1.0, 0.5), (1.0, -0.7)])
def test_a_symmetric_set_converges_with_the_square_of_its_size(a, b):
    angles = np.arange(8) * np.pi / 4 + 0.2
    star = np.concatenate([[[0, 0]], np.stack([np.cos(angles), np.sin(angles)], axis=1)])
    errors = [abs(rinow.fit_curvature(paraboloid_distances(h * star, a, b)).value - a * b) for h in (0.1, 0.05, 0.025)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.05)
