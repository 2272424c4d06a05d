"""How approximations of a space converge to it: all distances of Section 2 of the paper against refinement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.correspondence import distortion
from rinow.comparison.gromov_hausdorff import gromov_hausdorff
from rinow.comparison.hausdorff import hausdorff_distance
from rinow.comparison.lipschitz import lipschitz_distance
from rinow.comparison.surface_points import insert_points
from rinow.errors import InvalidInputError, InvalidMeshError
from rinow.geodesics.distances import geodesic_space
from rinow.geodesics.exact import SOURCES_AT_ONCE, ExactGeodesics
from rinow.mesh import TriangleMesh, as_triangle_mesh, is_mesh_like
from rinow.metric_space import MetricSpace, as_metric_space, trusted_metric_space
from rinow.nets.balls import surface_radius_of
from rinow.nets.farthest_point import farthest_point_net

__all__ = ["ConvergenceStudy", "study_meshes", "study_nets"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


COLUMNS = {
    "hausdorff": "Hausdorff distance of the surfaces",
    "gromov_hausdorff": "Gromov-Hausdorff distance of the surfaces",
    "net_gromov_hausdorff": "Gromov-Hausdorff distance of the nets",
    "net_lipschitz": "Lipschitz distance of the nets",
}


@dataclass(frozen=True, slots=True, eq=False)
class ConvergenceStudy:
    """Distances of a sequence of approximations from their limit; each is an interval that contains it.

    Attributes
    ----------
    n_points : (k,) ndarray of intp
        Vertices of each mesh, or points of each net.
    scale : (k,) ndarray of float
        Longest edge of each mesh, or covering radius of each net, in the unit of length.
    hausdorff : (k, 2) ndarray of float
        Bounds of the Hausdorff distance from the limit, in the unit of length.
    gromov_hausdorff : (k, 2) ndarray of float
        Bounds of the Gromov-Hausdorff distance from the limit, with geodesic distances, in the unit of length.
    net_gromov_hausdorff : (k, 2) ndarray of float
        The same for two nets of one size, one in the approximation and one in the limit.
    net_lipschitz : (k, 2) ndarray of float
        Bounds of the Lipschitz distance of these nets, a pure number; inf where two points of a net coincide.
    """

    n_points: Indices
    scale: Floats
    hausdorff: Floats
    gromov_hausdorff: Floats
    net_gromov_hausdorff: Floats
    net_lipschitz: Floats

    def table(self) -> list[dict[str, float]]:
        """One row for each approximation, with lower and upper bounds under ``name_lower`` and ``name_upper``."""
        rows: list[dict[str, float]] = []
        for i, (n, scale) in enumerate(zip(self.n_points, self.scale, strict=True)):
            row = {"n_points": float(n), "scale": float(scale)}
            for name in COLUMNS:
                lower, upper = getattr(self, name)[i]
                row |= {f"{name}_lower": float(lower), f"{name}_upper": float(upper)}
            rows.append(row)
        return rows

    def orders(self) -> dict[str, float]:
        """Order of convergence of each upper bound: slope of its logarithm against that of the scale."""
        result: dict[str, float] = {}
        for name in COLUMNS:
            upper = getattr(self, name)[:, 1]
            use = np.isfinite(upper) & (upper > 0.0) & (self.scale > 0.0)
            enough = use.sum() > 1
            result[name] = float(np.polyfit(np.log(self.scale[use]), np.log(upper[use]), 1)[0]) if enough else np.nan
        return result

    def _repr_html_(self) -> str:
        """A table of the intervals."""
        head = "".join(f"<th>{text}</th>" for text in ("points", "scale", *COLUMNS.values()))
        body = ""
        for i, (n, scale) in enumerate(zip(self.n_points, self.scale, strict=True)):
            cells = [f"{n:,}", f"{scale:.4g}"]
            cells += ["[{:.4g}, {:.4g}]".format(*getattr(self, name)[i]) for name in COLUMNS]
            body += "<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"
        return f"<table><tr>{head}</tr>{body}</table>"


def study_meshes(
    meshes: Sequence[Any],
    limit: Any,
    *,
    net_size: int = 20,
    max_points: int = 500,
    tolerance: float = 1e-4,
    time_limit: float = 5.0,
) -> ConvergenceStudy:
    r"""Distances of meshes from the surface that they approximate.

    Parameters
    ----------
    meshes : sequence of meshes
        Approximations in one unit of length, as a rule from coarse to fine, placed where the limit is.
    limit : mesh
        The surface, as a rule a much finer mesh; connected, as the others are.
    net_size : int, default 20
        Points of the nets, vertices of the first mesh carried to the nearest points of the other surfaces.
    max_points : int, default 500
        Vertices of each mesh, spread by farthest points, whose geodesic distances enter the bound of the surfaces: more
        give a better bound, at the cost of a geodesic computation on the mesh and on the limit each.
    tolerance : float, default 1e-4
        Width of the Hausdorff intervals relative to the diagonal.
    time_limit : float, default 5
        Seconds for each Gromov-Hausdorff or Lipschitz distance of nets.

    Returns
    -------
    study : ConvergenceStudy
        One interval of each distance for each mesh.

    Raises
    ------
    InvalidInputError
        If there is no mesh, or a mesh has fewer vertices than `net_size`.
    InvalidMeshError
        If a mesh is not connected.

    Notes
    -----
    With R the pairs of `max_points` vertices of a mesh and their nearest points of the limit, and r, s the distances
    within which these reach every point of the surfaces,

    .. math:: d_{GH} \le \tfrac12 \mathrm{dis} R + \max(r, s).

    For let every point of a surface have the partner of the nearest chosen point of that surface.  By the triangle
    inequality two points of the mesh and their partners differ in distance by at most dis R + 2r, two of the limit by
    dis R + 2s, and one of each by dis R + r + s.  From below the difference of the diameters counts.

    The nets illustrate Proposition 2.44 of the paper: meshes converge exactly if nets of one size do for every ε.  For
    finite nets this is the same as convergence in the Lipschitz distance.

    Examples
    --------
    Polygons become a disk: pyramids of height 0 over regular polygons.

    >>> def polygon(n):
    ...     t = 2 * np.pi * np.arange(n) / n
    ...     rim = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    ...     return np.vstack([[0, 0, 0], rim]), [[0, 1 + i, 1 + (i + 1) % n] for i in range(n)]
    >>> study = study_meshes([polygon(6), polygon(12)], polygon(96), net_size=4)
    >>> bool((study.hausdorff[:, 0] <= 1 - np.cos(np.pi / np.array([6, 12]))).all())
    True
    """
    surfaces = [as_triangle_mesh(mesh) for mesh in meshes]
    if not surfaces:
        raise InvalidInputError("meshes is empty; give at least one approximation.")
    target = as_triangle_mesh(limit)
    marks = surfaces[0].vertices[farthest_point_net(surfaces[0], size=net_size, start=_start(surfaces[0])).indices]
    limit_net = geodesic_space(*insert_points(target, marks))
    rows: list[tuple[float, ...]] = []
    for surface in surfaces:
        d = hausdorff_distance(surface, target, tolerance=tolerance)
        net = geodesic_space(*insert_points(surface, marks))
        rows.append(
            (
                float(surface.edge_lengths[surface.topology.face_used].max()),
                *(d.lower, d.upper),
                *_between_surfaces(surface, target, max_points),
                *_between_nets(net, limit_net, time_limit),
            )
        )
    return _study(np.array([surface.n_vertices for surface in surfaces]), rows)


def study_nets(space_or_mesh: Any, sizes: Sequence[int], *, time_limit: float = 5.0) -> ConvergenceStudy:
    r"""Distances of ever larger farthest-point nets from the space they are in.

    Parameters
    ----------
    space_or_mesh : MetricSpace, (n, n) array_like of float, or mesh
        The limit; of a mesh its vertices with their geodesic distances.
    sizes : sequence of int
        Numbers of points.
    time_limit : float, default 5
        Seconds for each Gromov-Hausdorff distance.

    Returns
    -------
    study : ConvergenceStudy
        The Hausdorff distance is the covering radius, exactly.  Nets of unequal size are not compared with each other:
        `net_gromov_hausdorff` repeats `gromov_hausdorff`, and `net_lipschitz` is inf up to the whole space.

    Raises
    ------
    InvalidInputError
        If a size is not between 1 and the number of points.

    Notes
    -----
    :math:`d_{GH}(S, X) \le d_H(S, X)` for a subset S of X (Example 2.28 of the paper); the lower bound is that of
    `gromov_hausdorff` in the time given.

    Examples
    --------
    >>> study = study_nets(abs(np.arange(9.0)[:, None] - np.arange(9.0)), [2, 3, 5, 9])
    >>> study.hausdorff[:, 1]
    array([4., 2., 1., 0.])
    """
    if not len(sizes):
        raise InvalidInputError("sizes is empty; give at least one number of points.")
    space = geodesic_space(space_or_mesh) if is_mesh_like(space_or_mesh) else as_metric_space(space_or_mesh)
    rows: list[tuple[float, ...]] = []
    for size in sizes:
        net = farthest_point_net(space, size=size)
        subspace, r = space.subspace(net.indices), net.covering_radius
        d = gromov_hausdorff(subspace, space, time_limit=time_limit)
        pair = d.lower, min(d.upper, r)
        lipschitz = lipschitz_distance(subspace, space, time_limit=time_limit)
        rows.append((r, r, r, *pair, *pair, lipschitz.lower, lipschitz.upper))
    return _study(np.array(sizes), rows)


def _study(n_points: Indices, rows: list[tuple[float, ...]]) -> ConvergenceStudy:
    """The columns of a table as intervals."""
    table = np.array(rows)
    return ConvergenceStudy(n_points, table[:, 0], *(table[:, i : i + 2] for i in (1, 3, 5, 7)))


def _start(mesh: TriangleMesh) -> int:
    """The first vertex on the surface."""
    return int(np.argmax(mesh.topology.vertex_is_used))


def _between_surfaces(surface: TriangleMesh, target: TriangleMesh, max_points: int) -> tuple[float, float]:
    """Bounds of the Gromov-Hausdorff distance of two surfaces from a correspondence of some of their points."""
    size = min(max_points, int(surface.topology.vertex_is_used.sum()))
    chosen = farthest_point_net(surface, size=size, start=_start(surface)).indices
    X, r = _net_in(surface, chosen)
    Y, s = _net_in(*insert_points(target, surface.vertices[chosen]))
    upper = 0.5 * distortion(np.arange(size), X, Y) + max(r, s)
    gap = max(X.diameter - Y.diameter - 2.0 * s, Y.diameter - X.diameter - 2.0 * r)
    return max(0.5 * gap, 0.0), upper


def _net_in(mesh: TriangleMesh, indices: Indices) -> tuple[MetricSpace, float]:
    """Vertices of a mesh as a space, and the distance within which they reach every point of its surface."""
    geodesics, k = ExactGeodesics(mesh), len(indices)
    D, nearest = np.empty((k, k)), np.full(mesh.n_vertices, np.inf)
    for first in range(0, k, SOURCES_AT_ONCE):
        block = slice(first, first + SOURCES_AT_ONCE)
        rows = np.asarray(geodesics.distances(indices[block]))
        D[block] = rows[:, indices]
        nearest = np.minimum(nearest, rows.min(axis=0))
    if not np.isfinite(D).all():
        raise InvalidMeshError("a mesh of the sequence, or its limit, is not connected; take one component of each.")
    return trusted_metric_space(np.minimum(D, D.T)), surface_radius_of(mesh, nearest)


def _between_nets(X: MetricSpace, Y: MetricSpace, time_limit: float) -> tuple[float, float, float, float]:
    """Bounds of the Gromov-Hausdorff and the Lipschitz distance of two nets of one size."""
    a = gromov_hausdorff(X, Y, time_limit=time_limit)
    b = lipschitz_distance(X, Y, time_limit=time_limit)
    natural = 0.5 * distortion(np.arange(len(X)), X, Y)
    return a.lower, min(a.upper, natural), b.lower, b.upper
