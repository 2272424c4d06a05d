"""Totals of one surface: area, Euler characteristic, and the total curvature by Gauss and Bonnet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from rinow.curvature.repairs import repaired
from rinow.mesh import TriangleMesh, as_triangle_mesh

__all__ = ["SurfaceTotals", "surface_totals"]


@dataclass(frozen=True, slots=True)
class SurfaceTotals:
    """Numbers that belong to a whole surface.

    Attributes
    ----------
    area : float
        Area of all faces that take part.
    euler_characteristic : int
        Vertices minus edges plus faces.
    components : int
        Connected components of the surface.
    boundary_edges : int
        Edges with one face.
    boundary_curves : int
        Connected components of the boundary; a boundary that touches itself counts once.
    inner_defects : float
        Sum of the angle defects of the vertices off the boundary, in radians: their curvature.
    boundary_turning : float
        Sum of the angle defects on the boundary, in radians: how much it turns; 0 for a closed surface.
    gaussian_integral : float
        Sum of the Gaussian curvature times the area of each vertex, where it is defined; inf and nan are left out.
    area_with_value : float
        Area of the vertices that have a Gaussian curvature.
    """

    area: float
    euler_characteristic: int
    components: int
    boundary_edges: int
    boundary_curves: int
    inner_defects: float
    boundary_turning: float
    gaussian_integral: float
    area_with_value: float


def surface_totals(mesh: TriangleMesh, gaussian: NDArray[np.float64]) -> SurfaceTotals:
    """Totals of a surface and of its Gaussian curvature.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface; it is welded, and each face counts once, as for its curvature.
    gaussian : (n_vertices,) ndarray of float
        Gaussian curvature at its vertices, in 1/length²; nan where undefined.

    Returns
    -------
    totals : SurfaceTotals
        `inner_defects` and `boundary_turning` add up to 2π times the Euler characteristic on every mesh;
        `gaussian_integral` agrees with `inner_defects` on a smooth surface, as far as the curvature is right.

    Examples
    --------
    >>> from rinow import TriangleMesh
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> totals = surface_totals(square, np.zeros(4))
    >>> totals.area, totals.boundary_curves, round(totals.boundary_turning / np.pi, 12)
    (1.0, 1, 2.0)
    """
    surface, index, _ = repaired(mesh)
    mesh = as_triangle_mesh(surface)
    if index is not None:
        values, gaussian = gaussian, np.full(mesh.n_vertices, np.nan)
        gaussian[index] = values
    topology, defects = mesh.topology, mesh.vertex_angle_defects
    on_boundary = topology.vertex_is_boundary
    known = np.isfinite(gaussian)
    return SurfaceTotals(
        area=float(mesh.face_areas[topology.face_used].sum()),
        euler_characteristic=topology.euler_characteristic,
        components=topology.n_components,
        boundary_edges=int(topology.edge_is_boundary.sum()),
        boundary_curves=_boundary_curves(mesh),
        inner_defects=float(defects[~on_boundary].sum()),
        boundary_turning=float(defects[on_boundary].sum()),
        gaussian_integral=float((gaussian[known] * mesh.vertex_areas[known]).sum()),
        area_with_value=float(mesh.vertex_areas[known].sum()),
    )


def _boundary_curves(mesh: TriangleMesh) -> int:
    """Connected components of the graph of boundary edges."""
    topology = mesh.topology
    ends = topology.edges[topology.edge_is_boundary]
    vertices, ends = np.unique(ends, return_inverse=True)
    a, b = ends.reshape(-1, 2).T
    n = len(vertices)
    links = coo_array((np.ones(len(a), np.bool_), (a, b)), shape=(n, n))
    return int(connected_components(links, directed=False)[0]) if n else 0
