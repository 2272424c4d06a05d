"""What may be said about the curvature at each vertex of a mesh."""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from rinow.kernels import stars
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["VertexStatus", "vertex_status"]


class VertexStatus(IntEnum):
    """Why a vertex has a curvature or has none; stored as uint8."""

    OK = 0
    """The value is defined and finite."""
    BOUNDARY = 1
    """A one-sided estimate, at a boundary or on a crease, or nan where the method has none."""
    ISOLATED = 2
    """nan: no face has the vertex."""
    DEGENERATE = 3
    """nan: every face around the vertex is degenerate."""
    NONMANIFOLD = 4
    """The faces around are not one fan: the value of the sheet that goes on beyond, or the largest; nan without one."""
    NONFINITE = 5
    """nan: the position is nan or inf."""
    UNRESOLVED = 6
    """nan: the data around the vertex do not determine a value."""


def vertex_status(mesh: TriangleMesh | IntrinsicMesh) -> NDArray[np.uint8]:
    """Status of each vertex as far as the mesh alone decides it.

    Where several apply, the first of NONFINITE, ISOLATED, DEGENERATE, NONMANIFOLD, BOUNDARY wins.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface.  A face with an undefined length is as if it were absent.

    Returns
    -------
    status : (n_vertices,) ndarray of uint8
        Values of `VertexStatus`, never UNRESOLVED.

    Examples
    --------
    >>> from rinow import TriangleMesh
    >>> mesh = TriangleMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]], [[0, 1, 2]])
    >>> [VertexStatus(s).name for s in vertex_status(mesh)]
    ['BOUNDARY', 'BOUNDARY', 'BOUNDARY', 'ISOLATED']
    """
    topology = mesh.topology
    status = np.zeros(mesh.n_vertices, np.uint8)
    status[topology.vertex_is_boundary] = VertexStatus.BOUNDARY
    status[~topology.vertex_is_manifold] = VertexStatus.NONMANIFOLD
    proper = np.empty(mesh.n_vertices, np.bool_)
    stars.proper_stars(mesh.edge_lengths, topology.corner_offsets, topology.vertex_corners, proper)
    status[~proper] = VertexStatus.DEGENERATE
    status[~(topology.vertex_is_used | _in_face_with_repeated_vertex(mesh))] = VertexStatus.ISOLATED
    if isinstance(mesh, TriangleMesh):
        status[~mesh.vertex_is_finite] = VertexStatus.NONFINITE
    return status


def _in_face_with_repeated_vertex(mesh: TriangleMesh | IntrinsicMesh) -> NDArray[np.bool_]:
    """(n_vertices,): some face has the vertex, but takes no part since one of its vertices is there twice."""
    touched = np.zeros(mesh.n_vertices, np.bool_)
    left_out = np.flatnonzero(~mesh.topology.face_used)
    finite = np.isfinite(mesh.edge_lengths[left_out]).all(axis=1)
    touched[mesh.faces[left_out[finite]].ravel()] = True
    return touched
