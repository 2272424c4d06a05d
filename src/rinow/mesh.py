"""Triangle meshes as values: by edge lengths (`IntrinsicMesh`) and by positions (`TriangleMesh`)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow import tolerances
from rinow._arrays import (
    as_faces,
    as_floats,
    as_points,
    bounding_box,
    in_safe_unit,
    in_unit,
    read_only,
    rows_are_finite,
)
from rinow.errors import InvalidInputError, InvalidMeshError
from rinow.kernels import triangles
from rinow.polyhedral_surface import PolyhedralSurface
from rinow.topology import clusters

__all__ = ["IntrinsicMesh", "TriangleMesh", "as_mesh", "as_triangle_mesh", "is_mesh_like"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


@dataclass(frozen=True, eq=False, init=False, repr=False)
class IntrinsicMesh(PolyhedralSurface):
    """A triangulated surface known by its edge lengths only.

    Parameters
    ----------
    faces : (n_faces, 3) array_like of int
        Vertex indices of each triangle.
    edge_lengths : (n_faces, 3) array_like of float
        Side lengths, column k opposite corner k, in any unit; a face with a nan or inf takes no part.
    n_vertices : int, optional
        Number of vertices; by default the largest index plus one.

    Raises
    ------
    InvalidMeshError
        If there is no face, a length is negative, the sides of a face fail the triangle inequality, or
        two faces disagree about the length of their common edge.
    InvalidInputError
        If a shape, a type or an index range is wrong.

    Examples
    --------
    A regular tetrahedron of edge 1 has the angle 3π/3 at each vertex:

    >>> mesh = IntrinsicMesh([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], np.ones((4, 3)))
    >>> (mesh.vertex_angle_defects / np.pi).round(9)
    array([1., 1., 1., 1.])
    """

    faces: Indices
    edge_lengths: Floats  # pyright: ignore[reportIncompatibleVariableOverride]
    n_vertices: int

    def __init__(self, faces: ArrayLike, edge_lengths: ArrayLike, n_vertices: int | None = None) -> None:
        F = as_faces(faces, n_vertices)
        L = as_floats(edge_lengths, "edge_lengths").copy()
        if L.shape != F.shape:
            raise InvalidMeshError(f"edge_lengths has shape {L.shape} but faces {F.shape}; give one length per side.")
        negative = np.argwhere(L < 0)
        if len(negative):
            f, k = negative[0]
            raise InvalidMeshError(f"edge_lengths[{f}, {k}] = {L[f, k]:.17g} is negative; lengths are not.")
        L[~np.isfinite(L)] = np.nan
        longest = L.max(axis=1)
        bad = np.flatnonzero(2 * longest - L.sum(axis=1) > tolerances.TRIANGLE_INEQUALITY * longest)
        if len(bad):
            raise InvalidMeshError(
                f"edge_lengths[{bad[0]}] = {L[bad[0]].tolist()} fails the triangle inequality; "
                "no triangle has these sides."
            )
        object.__setattr__(self, "faces", F)
        object.__setattr__(self, "edge_lengths", read_only(L))
        object.__setattr__(self, "n_vertices", int(F.max()) + 1 if n_vertices is None else int(n_vertices))
        self._check_shared_edges()

    def _check_shared_edges(self) -> None:
        partners = self.topology.partners
        h = np.flatnonzero(partners > np.arange(len(partners)))
        sides = self.edge_lengths[:, [2, 0, 1]].ravel()  # in the order of the half-edges
        a, b = sides[h], sides[partners[h]]
        bad = np.flatnonzero(np.abs(a - b) > tolerances.SHARED_EDGE_LENGTH * np.maximum(a, b))
        if len(bad):
            i = bad[0]
            f, g = h[i] // 3, partners[h[i]] // 3
            raise InvalidMeshError(
                f"faces {f} and {g} give their common edge the lengths {a[i]:.17g} and {b[i]:.17g}; "
                "an edge has one length."
            )


@dataclass(frozen=True, eq=False, init=False, repr=False)
class TriangleMesh(PolyhedralSurface):
    """A triangulated surface with a position for every vertex.

    Parameters
    ----------
    vertices : (n_vertices, 3) array_like of float
        Positions, in any unit of length.  Rows with nan or inf are allowed; faces that use them take no part.
    faces : (n_faces, 3) array_like of int
        Vertex indices of each triangle, counter-clockwise seen from outside.
    vertex_data : mapping of str to (n_vertices, ...) array_like, optional
        Fields carried along, such as the scalars found in a file.
    notes : tuple of str, optional
        What a reader had to do to make the mesh, one sentence each.

    Raises
    ------
    InvalidMeshError
        If there is no vertex or no face.
    InvalidInputError
        If a shape, a type or an index range is wrong.

    Examples
    --------
    >>> square = TriangleMesh([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    >>> square.n_vertices, square.face_areas.sum(), square.euler_characteristic
    (4, np.float64(1.0), 1)
    """

    vertices: Floats
    faces: Indices
    vertex_data: Mapping[str, NDArray[Any]]
    notes: tuple[str, ...]

    def __init__(
        self,
        vertices: ArrayLike,
        faces: ArrayLike,
        vertex_data: Mapping[str, ArrayLike] | None = None,
        notes: Sequence[str] = (),
    ) -> None:
        V = as_points(vertices, "vertices", 3).copy()
        if len(V) == 0:
            raise InvalidMeshError("vertices is empty; a mesh has at least one vertex.")
        data = {str(name): np.asarray(values) for name, values in _as_mapping(vertex_data).items()}
        for name, values in data.items():
            if values.shape[:1] != (len(V),):
                raise InvalidInputError(
                    f"vertex_data[{name!r}] has shape {values.shape}; its first length must be n_vertices = {len(V)}."
                )
        object.__setattr__(self, "vertices", read_only(V))
        object.__setattr__(self, "faces", as_faces(faces, len(V)))
        object.__setattr__(self, "vertex_data", MappingProxyType(data))
        object.__setattr__(self, "notes", tuple(notes))

    @property
    def n_vertices(self) -> int:  # type: ignore[override]
        """Number of vertices, those without a face included."""
        return len(self.vertices)

    @cached_property
    def edge_lengths(self) -> Floats:
        """(n_faces, 3): column k is the side opposite corner k; nan where a position is not finite."""
        L = np.empty((self.n_faces, 3))
        V, exponent = self._safe_vertices
        triangles.face_edge_lengths(V, self.faces, L)
        L = in_unit(L, exponent)
        L[~np.isfinite(L)] = np.nan
        return read_only(L)

    @cached_property
    def _safe_vertices(self) -> tuple[Floats, int]:
        """The same of the positions."""
        return in_safe_unit(self.vertices)

    @cached_property
    def vertex_is_finite(self) -> NDArray[np.bool_]:
        """(n_vertices,): all three coordinates are finite."""
        return read_only(rows_are_finite(self.vertices))

    @cached_property
    def outward_flips(self) -> NDArray[np.bool_]:
        """(n_faces,): faces to turn so that neighbours agree and a closed surface has its normals outward."""
        flip = self.topology.face_flips
        if self.topology.is_closed and self.topology.is_orientable:
            used, volumes = self.topology.face_used, np.empty(self.n_faces)
            V, _ = self._safe_vertices
            origin = V[self.faces[np.argmax(used), 0]]
            triangles.signed_volumes(V, self.faces, used, flip, origin, volumes)
            if volumes.sum() < 0:
                flip = ~flip
        return read_only(np.asarray(flip))

    @cached_property
    def vertex_normals(self) -> Floats:
        """(n_vertices, 3): unit normals, outward on a closed surface; 0 where the faces around cancel or are absent."""
        t = self.topology
        normals = np.empty_like(self.vertices)
        triangles.vertex_normals(
            self._safe_vertices[0], self.faces, self.outward_flips, t.corner_offsets, t.vertex_corners, normals
        )
        return read_only(normals)

    @cached_property
    def diagonal(self) -> float:
        """Length of the diagonal of the bounding box of the finite vertices; 0 without any."""
        V, exponent = self._safe_vertices
        if not self.vertex_is_finite.all():
            V = V[self.vertex_is_finite]
        low, high = bounding_box(V)
        return float(in_unit(np.linalg.norm(high - low), exponent)) if len(V) else 0.0

    def intrinsic(self) -> IntrinsicMesh:
        """The same surface, its positions forgotten."""
        return IntrinsicMesh(self.faces, self.edge_lengths, self.n_vertices)

    @property
    def is_soup(self) -> bool:
        """Whether no two faces share an edge although several could: every face is separate."""
        t = self.topology
        return bool(t.partners.max() < 0 and t.face_used.sum() > 1 and t.edge_is_manifold.all())

    def welded(self, *, rtol: float = tolerances.WELD_DISTANCE) -> tuple[TriangleMesh, Indices]:
        """Merge vertices closer than a share `rtol` of the diagonal of the bounding box.

        Returns
        -------
        mesh : TriangleMesh
            One vertex for each cluster, in the order of first appearance, with the position of its first vertex.
        vertex_map : (n_vertices,) ndarray of intp
            New index of each old vertex.  Vertices that are not finite stay apart.
        """
        from scipy.spatial import KDTree

        finite = np.flatnonzero(self.vertex_is_finite)
        pairs = finite[KDTree(self.vertices[finite]).query_pairs(rtol * self.diagonal, output_type="ndarray")]
        first, vertex_map = clusters(self.n_vertices, pairs)
        return TriangleMesh(self.vertices[first], vertex_map[self.faces]), vertex_map


def _as_mapping(vertex_data: Any) -> Mapping[str, ArrayLike]:
    if isinstance(vertex_data, Mapping | None):
        return vertex_data or {}
    raise InvalidInputError(f"vertex_data is of type {type(vertex_data).__name__}; give a mapping of names to arrays.")


def is_mesh_like(value: Any) -> bool:
    """Whether `as_mesh` is meant: a mesh, an object with faces, or a pair of two tables."""
    if any(hasattr(value, name) for name in ("faces", "regular_faces")):
        return True
    return isinstance(value, tuple | list) and len(value) == 2 and all(np.ndim(part) == 2 for part in value)


def as_mesh(mesh: Any) -> TriangleMesh | IntrinsicMesh:
    """The mesh meant by a mesh, a ``(V, F)`` pair, or an object with vertices and faces.

    Objects have ``.vertices`` (trimesh) or ``.coordinates`` (nilearn) and ``.faces``, or ``.points`` and
    ``.regular_faces`` (pyvista, triangulated).

    Raises
    ------
    InvalidMeshError
        If `mesh` is none of these.
    """
    if isinstance(mesh, TriangleMesh | IntrinsicMesh):
        return mesh
    if isinstance(mesh, tuple | list):
        if len(mesh) == 2:
            return TriangleMesh(mesh[0], mesh[1])
        raise InvalidMeshError(f"mesh is a {type(mesh).__name__} of {len(mesh)} items; give the pair (V, F).")
    for name in ("vertices", "coordinates"):
        if hasattr(mesh, name) and hasattr(mesh, "faces"):
            return TriangleMesh(np.asarray(getattr(mesh, name)), np.asarray(mesh.faces))
    if hasattr(mesh, "points") and hasattr(mesh, "regular_faces"):
        if not mesh.is_all_triangles:
            raise InvalidMeshError("mesh is a PolyData with polygons; call its triangulate() first.")
        return TriangleMesh(np.asarray(mesh.points), np.asarray(mesh.regular_faces))
    raise InvalidMeshError(
        f"mesh is a {type(mesh).__name__}; give a TriangleMesh, an IntrinsicMesh, a (V, F) pair or an object with "
        "vertices and faces (files are read by read_mesh; a scene of trimesh has to_mesh())."
    )


def as_triangle_mesh(mesh: Any) -> TriangleMesh:
    """`as_mesh`, for functions that need positions.

    Raises
    ------
    InvalidMeshError
        If `mesh` has edge lengths only.
    """
    if isinstance(result := as_mesh(mesh), IntrinsicMesh):
        raise InvalidMeshError("mesh is an IntrinsicMesh, but positions are needed; give a TriangleMesh.")
    return result
