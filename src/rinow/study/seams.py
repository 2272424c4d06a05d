"""Seams of a mesh: vertices at one place that are several, as textures and sharp edges make them in GLB files."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow import tolerances
from rinow.mesh import TriangleMesh

__all__ = ["without_seams"]

Indices = NDArray[np.intp]


def without_seams(mesh: TriangleMesh) -> tuple[TriangleMesh, Indices, tuple[str, ...]]:
    """The mesh with one vertex at each place.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    mesh : TriangleMesh
        The same faces; vertices in the order of the first at each place.
    index : (n_vertices,) ndarray of intp
        For each vertex of the given mesh the one that stands for it.
    notes : tuple of str
        How many there were, in one sentence, if any.
    """
    welded, index = mesh.welded()
    if welded.n_vertices == mesh.n_vertices:
        return mesh, index, ()
    note = (
        f"{mesh.n_vertices} vertices were taken as {welded.n_vertices}: those closer than {tolerances.WELD_DISTANCE:g} "
        "of the diagonal are one, and each has its value."
    )
    return welded, index, (note,)
