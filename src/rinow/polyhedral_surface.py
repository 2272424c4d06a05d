"""Polyhedral surfaces: what the edge lengths of a triangulation tell, without a position."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from functools import cached_property
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from rinow import tolerances
from rinow._arrays import in_safe_unit, in_unit, read_only, rows_are_finite
from rinow._printing import OneLine
from rinow.kernels import triangles
from rinow.topology import Topology

__all__ = ["PolyhedralSurface"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


class PolyhedralSurface(OneLine):
    """Flat triangles glued along their sides; both kinds of mesh are one."""

    faces: Indices
    n_vertices: int

    def __reduce__(self) -> tuple[type[PolyhedralSurface], tuple[Any, ...]]:
        """Copies, also those in other processes, are made of the same arguments, and are as frozen."""
        values = (getattr(self, field.name) for field in fields(cast(Any, self)))
        return type(self), tuple(dict(cast(Any, v)) if isinstance(v, Mapping) else v for v in values)

    @cached_property
    def edge_lengths(self) -> Floats:
        """(n_faces, 3): column k is the side opposite corner k; nan where a position is not finite."""
        raise NotImplementedError

    @cached_property
    def topology(self) -> Topology:
        """Adjacency of the faces that take part."""
        F = self.faces
        distinct = (F[:, 0] != F[:, 1]) & (F[:, 1] != F[:, 2]) & (F[:, 2] != F[:, 0])
        return Topology(F, self.n_vertices, read_only(distinct & rows_are_finite(self.edge_lengths)))

    @property
    def n_faces(self) -> int:
        """Number of faces, those that take no part included."""
        return len(self.faces)

    @cached_property
    def _safe_lengths(self) -> tuple[Floats, int]:
        """The lengths divided by a power of two where their squares would overflow or vanish, and its exponent."""
        return in_safe_unit(self.edge_lengths)

    @cached_property
    def corner_angles(self) -> Floats:
        """(n_faces, 3): Euclidean angle at each corner, in [0, pi]; the three sum to pi."""
        return read_only(self._face_angles())

    def _face_angles(self) -> Floats:
        angles = np.empty((self.n_faces, 3))
        triangles.face_angles(self._safe_lengths[0], angles)
        return angles

    @cached_property
    def _scaled_areas(self) -> Floats:
        areas = np.empty(self.n_faces)
        triangles.face_areas(self._safe_lengths[0], areas)
        return read_only(areas)

    @property
    def face_areas(self) -> Floats:
        """(n_faces,): Euclidean area; nan for a face with an undefined length.

        Below 1e-308 and above 1e308 there is no number but 0 and inf.
        """
        return in_unit(self._scaled_areas, 2 * self._safe_lengths[1])

    @cached_property
    def face_is_degenerate(self) -> NDArray[np.bool_]:
        """(n_faces,): the face takes no part, or its area is 0 within rounding."""
        longest = self._safe_lengths[0].max(axis=1)
        proper = self._scaled_areas > tolerances.DEGENERATE_AREA * longest * longest
        return read_only(~(proper & self.topology.face_used))

    @cached_property
    def vertex_areas(self) -> Floats:
        """(n_vertices,): one third of the incident area; 0 without a face.

        Below 1e-308 and above 1e308 there is no number but 0 and inf.
        """
        return read_only(in_unit(self.scaled_vertex_areas, 2 * self._safe_lengths[1]))

    @cached_property
    def scaled_vertex_areas(self) -> Floats:
        """(n_vertices,): the same in a unit in which meshes of any size have numbers."""
        t, total = self.topology, np.empty(self.n_vertices)
        triangles.vertex_sums_of_faces(self._scaled_areas, t.corner_offsets, t.vertex_corners, total)
        return read_only(total / 3.0)

    @cached_property
    def vertex_angle_defects(self) -> Floats:
        r"""(n_vertices,): integrated curvature in radians; the sum is exactly :math:`2\pi\chi` on every mesh.

        It is 2π minus the angles at an interior vertex, π minus the angles at a boundary vertex (the turning of
        the boundary), 0 without a face, and in general 2π − π (edges − faces at the vertex) − angles.
        """
        t = self.topology
        angles = np.empty(self.n_vertices)
        at_corners = self.__dict__.get("corner_angles", None)
        if at_corners is None:
            at_corners = self._face_angles()  # not kept: they are three times as many as the faces
        triangles.vertex_sums_of_corners(at_corners, t.corner_offsets, t.vertex_corners, angles)
        defects = 2.0 * np.pi - angles
        # Edges minus faces at a vertex; only boundary and non-manifold edges make it differ from 0.
        irregular = np.flatnonzero(t.vertex_is_boundary | t.vertex_is_on_nonmanifold_edge)
        if len(irregular):
            surplus = np.diff(t.neighbour_offsets) - np.diff(t.corner_offsets)
            defects[irregular] -= np.pi * surplus[irregular]
        defects[~t.vertex_is_used] = 0.0
        return read_only(defects)

    @property
    def euler_characteristic(self) -> int:
        """Vertices minus edges plus faces, of the part that has faces."""
        return self.topology.euler_characteristic

    @cached_property
    def boundary_vertices(self) -> Indices:
        """Indices of the vertices on the boundary, ascending."""
        return read_only(np.flatnonzero(self.topology.vertex_is_boundary))

    @property
    def components(self) -> Indices:
        """(n_vertices,): number of the connected component; -1 for a vertex without a face."""
        return self.topology.components

    @cached_property
    def mean_edge_length(self) -> float:
        """Mean length of the edges; nan without any."""
        f, k = np.divmod(self.topology.edge_halfedges, 3)
        return float(self.edge_lengths[f, (k + 2) % 3].mean()) if len(f) else float("nan")
