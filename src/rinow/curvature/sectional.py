"""Curvature from the normal curvatures of circles through a vertex and its neighbours."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import NDArray

from rinow._executor import Executor, SerialExecutor
from rinow.curvature.estimate import Estimate
from rinow.curvature.stencils import N_BLOCKS, empty_frames, local_spacing, stencil_surface
from rinow.kernels import jets, monge, stencils
from rinow.mesh import TriangleMesh

__all__ = ["sectional"]

SPACINGS = 4.0
"""Default radius in local spacings.  Smaller balls halve the error on exact vertices; larger ones bear more noise."""
VERTICES_PER_TASK = 1 << 16

Floats = NDArray[np.float64]
Progress = Callable[[int, int], object]


def sectional(
    mesh: TriangleMesh,
    *,
    radius: float | None = None,
    progress: Progress | None = None,
    executor: Executor | None = None,
) -> Estimate:
    r"""Principal curvatures from the circles that touch the surface at a vertex and run through its neighbours.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    radius : float, optional
        Radius of the balls, in the unit of length; by default four times the local spacing of the vertices.
    progress : callable, optional
        Called with the number of vertices done and their total.
    executor : Executor, optional
        Where the tasks of 65,536 vertices run.

    Returns
    -------
    estimate : Estimate
        Everything; at a boundary one-sided.  nan where fewer than three neighbours, or neighbours on a line,
        determine nothing.  `spread` is the standard error of the regression: the scatter of the circles about
        the jet, carried over to K.  It covers noise, not what the jet leaves out; nan without a spare neighbour.

    Notes
    -----
    A neighbour q of p at distance d and height z over the tangent plane gives the normal curvature 2z/d²: Menger's
    curvature of p, p, q.  Euler's formula is the leading term of these numbers; the others are the slopes of the
    plane and the third and fourth derivatives of the surface, and all are found together by least squares,

    .. math:: \min \sum_q \Bigl(\frac{2 z_q}{d_q^2}
        - \frac{2}{d_q^2} \sum_{1 \le a+b \le 4} c_{ab} x_q^a y_q^b\Bigr)^2 .

    The neighbours are those in a ball, reached along edges and not beyond a fold.  The order 4 falls to 3 and 2 with
    fewer than 1.25 neighbours for each unknown or where they lie on too few lines, then to Euler's formula alone.
    The cost is about 10 μs for each vertex.

    See Also
    --------
    lifted : Faster, from two rings of neighbours.
    """
    surface = stencil_surface(mesh)
    n = mesh.n_vertices
    radii = SPACINGS * local_spacing(mesh) if radius is None else np.full(n, float(radius))
    starts = range(0, n, VERTICES_PER_TASK)
    parts: list[tuple[monge.PrincipalFrames, Floats]] = []
    for part in (executor or SerialExecutor()).map(partial(_jets, surface, radii), starts):
        parts.append(part)
        if progress is not None:
            progress(min(len(parts) * VERTICES_PER_TASK, n), n)
    k1, k2, direction1, direction2 = (np.concatenate([frames[i] for frames, _ in parts]) for i in range(4))
    spread = np.concatenate([spread for _, spread in parts])
    return Estimate(k1 * k2, spread, radii, 0.5 * (k1 + k2), k1, k2, direction1, direction2)


def _jets(surface: stencils.Surface, radii: Floats, start: int) -> tuple[monge.PrincipalFrames, Floats]:
    """Principal frames and standard errors of one task."""
    stop = min(start + VERTICES_PER_TASK, len(radii))
    frames, spread = empty_frames(stop - start), np.empty(stop - start)
    jets.ball_jets(start, stop, radii, jets.MAX_ORDER, surface, N_BLOCKS, frames, spread)
    return frames, spread
