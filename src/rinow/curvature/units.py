"""Units of length in which the powers of lengths that curvature needs neither overflow nor underflow."""

from __future__ import annotations

import numpy as np

from rinow.errors import InvalidMeshError
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["LARGEST_SCALE", "with_safe_lengths"]

SAFE_SCALE, LARGEST_SCALE = 2.0**100, 2.0**505
"""Lengths between the first and its inverse are computed as they are, others after a change of the unit; beyond the
second one curvature is no number."""


def with_safe_lengths(mesh: TriangleMesh | IntrinsicMesh) -> tuple[TriangleMesh | IntrinsicMesh, float]:
    """A mesh in a unit that is safe, a power of two that changes no digit, and its lengths over the given ones.

    Raises
    ------
    InvalidMeshError
        If its curvature is no number in the unit given.
    """
    longest = float(np.fmax.reduce(mesh.edge_lengths, axis=None))
    if not longest > 0.0 or 1.0 / SAFE_SCALE < longest < SAFE_SCALE:
        return mesh, 1.0
    if not 1.0 / LARGEST_SCALE < longest < LARGEST_SCALE:
        raise InvalidMeshError(f"mesh has edges of length {longest:.3g}, and its curvature no number; scale the mesh.")
    unit = 2.0 ** -np.floor(np.log2(longest))
    if isinstance(mesh, IntrinsicMesh):
        return IntrinsicMesh(mesh.faces, mesh.edge_lengths * unit, mesh.n_vertices), unit
    with np.errstate(over="ignore"):
        return TriangleMesh(mesh.vertices * unit, mesh.faces), unit
