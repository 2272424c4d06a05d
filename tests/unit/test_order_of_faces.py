"""The order in which faces are listed, and the corner each begins with, change values by rounding only."""

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from rinow import surface_curvature


def stretched_ellipsoid(seed):
    """Random points of an ellipsoid with axes 4, 1 and ½, joined as on the sphere: faces are long and thin."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(700, 3))
    points /= np.linalg.norm(points, axis=1)[:, None]
    faces = ConvexHull(points).simplices
    normals = np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    inward = np.sum(normals * points[faces[:, 0]], axis=1) < 0
    faces[inward] = faces[inward][:, ::-1]
    return points * (4.0, 1.0, 0.5) * (1 + 0.02 * rng.normal(size=(700, 1))), faces


@pytest.mark.parametrize("quality", ["best", "fast"])
@pytest.mark.parametrize("seed", [21, 22, 23])
def test_thin_faces_in_any_order(seed, quality):
    """Vertices of a core may be reached over farther ones only; order does not say which of them count."""
    V, F = stretched_ellipsoid(seed)
    c = surface_curvature((V, F), quality=quality)
    rng = np.random.default_rng(24)
    for k in range(3):
        again = surface_curvature((V, np.roll(F, k, axis=1)[rng.permutation(len(F))]), quality=quality)
        scale = np.abs(c.gaussian).max()
        # Nearly singular fits amplify the rounding of 1e-16 by up to 1e7; another vertex in a core is worth 1e-5.
        assert np.abs(again.gaussian - c.gaussian).max() < 1e-7 * scale
        assert np.abs(again.mean - c.mean).max() < 1e-7 * np.abs(c.mean).max()
