"""Balls of a finite space or on a mesh, asked for one after the other or many at once."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator
from contextlib import contextmanager

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix

from rinow.geodesics.exact import SOURCES_AT_ONCE, ExactGeodesics
from rinow.kernels._parallel import number_of_threads
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["BallOf", "covers", "mesh_balls", "space_balls", "surface_radius_of", "surface_vertices"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

BallOf = Callable[[int, float], tuple[Indices | slice, Floats]]
"""Function of a point and a radius: the points of the ball at least, or all, and their distances from its centre."""


def surface_vertices(mesh: TriangleMesh | IntrinsicMesh) -> Indices:
    """Vertices that some face which takes part has."""
    return np.flatnonzero(mesh.topology.vertex_is_used)


def space_balls(distances: Floats) -> BallOf:
    """Rows of a distance matrix, whatever the radius."""
    return lambda point, radius: (slice(None), distances[point])


def mesh_balls(mesh: TriangleMesh | IntrinsicMesh) -> BallOf:
    """Balls of geodesic distance, each at the cost of the ball."""
    geodesics = ExactGeodesics(mesh)

    def ball(vertex: int, radius: float) -> tuple[Indices | slice, Floats]:
        with _one_thread():
            if math.isinf(radius):
                return slice(None), np.asarray(geodesics.distances(vertex))[0]
            row = csr_matrix(geodesics.distances(vertex, max_distance=radius))
        return np.asarray(row.indices, np.intp), np.asarray(row.data, np.float64)

    return ball


@contextmanager
def _one_thread() -> Generator[None]:
    """A single source is the work of one thread; the others would only be waited for."""
    before = number_of_threads()
    numba.set_num_threads(1)
    try:
        yield
    finally:
        numba.set_num_threads(before)


def covers(mesh: TriangleMesh | IntrinsicMesh, sources: Indices, radius: float) -> bool:
    """Whether the balls around some vertices cover all vertices of the surface."""
    geodesics, bare = ExactGeodesics(mesh), np.ones(mesh.n_vertices, np.bool_)
    for first in range(0, len(sources), SOURCES_AT_ONCE):
        rows = csr_matrix(geodesics.distances(sources[first : first + SOURCES_AT_ONCE], max_distance=radius))
        bare[rows.indices] = False
    return not bare[surface_vertices(mesh)].any()


def surface_radius_of(mesh: TriangleMesh | IntrinsicMesh, distances: Floats) -> float:
    """Bound of the distance of any point of a surface from a net, by the distances of the vertices from it.

    No point of a triangle is farther than its longest side / √3 from all three corners.
    """
    used = mesh.topology.face_used
    far = distances[mesh.faces[used]].max(axis=1) + mesh.edge_lengths[used].max(axis=1) / math.sqrt(3.0)
    return float(far.max(initial=0.0))
