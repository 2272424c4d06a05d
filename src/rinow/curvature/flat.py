"""Where a surface is isometric to the plane: all angles sum to 2π, so that K = 0 exactly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.creases import EdgeTurnings
from rinow.curvature.estimate import Estimate
from rinow.curvature.levels import flat_stars
from rinow.curvature.stencils import rings_around
from rinow.mesh import TriangleMesh

__all__ = ["flat_vertices", "flatten"]

FLAT_RINGS = 3


def flat_vertices(mesh: TriangleMesh) -> NDArray[np.bool_]:
    """(n_vertices,): every interior vertex within three rings has the angle 2π, and that is no tread of steps."""
    curved = ~flat_stars(mesh)
    if curved.mean() > 0.99:
        return ~curved & False
    flat = ~rings_around(mesh.topology, curved, FLAT_RINGS)
    return flat & (not (flat.any() and EdgeTurnings(mesh).have_treads))


def flatten(estimate: Estimate, is_flat: NDArray[np.bool_]) -> None:
    """Take K = 0 at some vertices; the mean curvature stays."""
    rows = np.flatnonzero(is_flat & np.isfinite(estimate.gaussian))
    if estimate.mean is None or not len(rows):
        return
    estimate.gaussian[rows] = 0.0
    for name, limit in (("k1", np.maximum), ("k2", np.minimum)):
        getattr(estimate, name)[rows] = limit(2.0 * estimate.mean[rows], 0.0)
