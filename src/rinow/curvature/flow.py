"""Angle defects, averaged over growing balls of the developed metric by repeating one small local regression."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.stencils import N_BLOCKS, NEEDLES
from rinow.kernels import smoothing, stencils
from rinow.kernels.development import Metric
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["CurvatureFlow"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

REACH = 2.1
"""Radius of the small regression in local spacings: the first ring of a regular mesh and a little of the second."""
BALANCE_SWEEPS = 3
"""Corrections of the weights that make S keep the total curvature; the error at the scale of a few vertices, which is
what matters, falls by more than half with each."""


@dataclass(frozen=True)
class CurvatureFlow:
    """A local linear regression S of angle defect over area, which averages over larger balls when it is repeated.

    Attributes
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface; only edge lengths are used.
    """

    mesh: TriangleMesh | IntrinsicMesh

    @cached_property
    def has_data(self) -> NDArray[np.bool_]:
        """(n_vertices,): the vertex is interior, manifold, and has an area."""
        t = self.mesh.topology
        return t.vertex_is_manifold & ~t.vertex_is_boundary & (self.mesh.vertex_areas > 0.0)

    @cached_property
    def areas(self) -> Floats:
        """(n_vertices,): one third of the area around a vertex with data, else 0."""
        return np.where(self.has_data, self.mesh.vertex_areas, 0.0)

    @cached_property
    def metric(self) -> Metric:
        """The mesh as kernels see it."""
        mesh, t = self.mesh, self.mesh.topology
        sides = mesh.edge_lengths, mesh.corner_angles, mesh.face_areas
        return Metric(t.faces, *sides, t.corner_offsets, t.vertex_corners, t.partners)

    @cached_property
    def spacing(self) -> Floats:
        """(n_vertices,): distance of neighbours, averaged around each vertex: see `stencils.local_spacing`."""
        edges, even = np.empty(self.mesh.n_vertices), self.even_spacing
        smoothing.mean_sides(self.metric, edges)
        return np.clip(self.means(edges, 1), even, NEEDLES * even)

    @property
    def even_spacing(self) -> Floats:
        """(n_vertices,): the same of as many vertices if their triangles were equilateral.  It is not kept."""
        shares = np.where(self.mesh.topology.vertex_is_boundary, 0.5, 1.0)
        with np.errstate(all="ignore"):
            areas = self._ring_sums(self._ring_sums(self.mesh.vertex_areas)) / self._ring_sums(self._ring_sums(shares))
        return np.sqrt(2.0 / np.sqrt(3.0) * areas)

    def _ring_sums(self, values: Floats) -> Floats:
        sums = np.empty(self.mesh.n_vertices)
        stencils.ring_sums(values, self.mesh.topology.neighbour_offsets, self.mesh.topology.neighbours, sums)
        return sums

    @cached_property
    def _rows(self) -> tuple[Indices, NDArray[np.int32], Floats, Floats]:
        """S by rows: offsets, columns and values, and the mean square along an axis of the distance of the data."""
        t, n = self.mesh.topology, self.mesh.n_vertices
        radii = REACH * self.spacing
        weights = self.areas.copy()
        ball = (radii, self.areas, self.has_data, self.metric, N_BLOCKS)
        starts = np.zeros(n + 1, np.int64)
        smoothing.count_rows(t.vertex_is_manifold, *ball, starts[1:])
        np.cumsum(starts, out=starts)
        columns, values, variances = np.empty(starts[-1], np.int32), np.empty(starts[-1]), np.empty(n)
        places, has_gap, sums = np.empty((starts[-1], 2)), np.empty(n, np.bool_), np.empty(n)
        smoothing.row_places(*ball, starts, columns, places, has_gap)
        regression = (radii, weights, starts, columns, places, has_gap, values, variances)
        for _ in range(BALANCE_SWEEPS):
            smoothing.regression_rows(*regression)
            smoothing.column_sums(starts, columns, values, self.areas, sums)
            is_seen = self.has_data & (sums > 0.1 * self.areas)
            np.multiply(weights, np.divide(self.areas, sums, out=sums, where=is_seen), out=weights, where=is_seen)
        smoothing.regression_rows(*regression)
        return starts, columns, values, variances

    @property
    def step_variances(self) -> Floats:
        """(n_vertices,): mean square along an axis of the distance that one step averages over; nan without data."""
        return self._rows[3]

    @cached_property
    def defect_densities(self) -> Floats:
        """(n_vertices,): angle defect over area, 0 without data."""
        return np.divide(self.mesh.vertex_angle_defects, self.areas, out=np.zeros(len(self.areas)), where=self.has_data)

    def step(self, values: Floats) -> Floats:
        """The values after one more regression; nan for a vertex without data around it."""
        out = np.empty_like(values)
        smoothing.apply_rows(*self._rows[:3], values, out)
        return out

    def means(self, values: Floats, passes: int) -> Floats:
        """Means over the ring of each vertex, repeated; of finite values, column by column."""
        t = self.mesh.topology
        current = values.reshape(len(values), -1).copy()
        other = np.empty_like(current)
        for _ in range(passes):
            smoothing.ring_means(current, t.neighbour_offsets, t.neighbours, other)
            current, other = other, current
        return current.reshape(values.shape)
