"""Curvatures of single stars, from the lengths and turnings of their edges and the angles of their faces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.creases import EdgeTurnings
from rinow.kernels import triangles
from rinow.mesh import TriangleMesh

__all__ = ["circumcentric_areas", "steiner_curvatures"]

Floats = NDArray[np.float64]


def steiner_curvatures(mesh: TriangleMesh) -> tuple[Floats, Floats]:
    r"""Gaussian and mean curvature by Steiner's formula, over the area that is nearest to each vertex.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    gaussian, mean : (n_vertices,) ndarray of float
        In 1/length² and 1/length, convex positive; nan where the star is not one closed fan of proper faces.  Without
        a consistent orientation there is no mean curvature.

    Notes
    -----
    The parallel surface of a convex polyhedron at distance ε has the area
    :math:`A + ε \sum_e l_e θ_e + ε^2 \sum_i δ_i`, for lengths l and turnings θ of its edges and angle defects δ; that
    of a smooth one is :math:`A + 2ε \int H + ε^2 \int K`.  Half of each edge belongs to each of its ends:
    :math:`K_i = δ_i / A_i` and :math:`H_i = \sum_{e \ni i} l_e θ_e / (4 A_i)`.  No other estimate looks at less of the
    surface, so none smooths less of its detail.  Noise and irregular stars disturb it more than fits.
    """
    t, edges = mesh.topology, mesh.topology.edges
    bends = EdgeTurnings(mesh).turnings * np.linalg.norm(np.subtract(*mesh.vertices[edges.T]), axis=1)
    total = 0.25 * np.bincount(edges.ravel(), np.repeat(bends, 2), mesh.n_vertices)
    areas = circumcentric_areas(mesh)
    is_closed = t.vertex_is_manifold & ~t.vertex_is_boundary & (areas > 0.0)
    gaussian, mean = np.full(mesh.n_vertices, np.nan), np.full(mesh.n_vertices, np.nan)
    np.divide(mesh.vertex_angle_defects, areas, out=gaussian, where=is_closed)
    if t.is_orientable:
        np.divide(total, areas, out=mean, where=is_closed)
    return gaussian, mean


def circumcentric_areas(mesh: TriangleMesh) -> Floats:
    r"""(n_vertices,): area of the faces that is nearest to each vertex; half and quarters of an obtuse face.

    Notes
    -----
    Of a triangle without obtuse angle :math:`(b^2 \cot β + c^2 \cot γ)/8` is nearest to the corner opposite side a.
    """
    angles, areas = mesh.corner_angles, mesh.face_areas[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = mesh.edge_lengths**2 / np.tan(angles)
        shares = (shares.sum(axis=1, keepdims=True) - shares) / 8.0
    is_obtuse = angles > 0.5 * np.pi
    shares = np.where(is_obtuse.any(axis=1, keepdims=True), np.where(is_obtuse, 0.5, 0.25) * areas, shares)
    out, t = np.empty(mesh.n_vertices), mesh.topology
    triangles.vertex_sums_of_corners(np.ascontiguousarray(shares), t.corner_offsets, t.vertex_corners, out)
    return out
