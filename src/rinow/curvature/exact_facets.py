"""Ends of exactly flat facets: where many faces lie in one plane to rounding, no noise moves their vertices."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.rounding import file_rounding
from rinow.kernels import edge_noise
from rinow.mesh import TriangleMesh
from rinow.topology import clusters

__all__ = ["ends_of_facets"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

LARGE = 8
"""Faces of a facet that noise does not make flat by chance."""
SHARP, TURNED = np.radians(60.0), np.radians(30.0)
"""Least turning where a large facet ends, and of an edge that ends a step.  Between the voxels of a segmented volume
marching cubes turn by 55° at most."""
FEW, AT_ONCE = 100, 1 << 14
"""Most edges around a facet that is looked at as a step, and edges looked at together: memory is linear in both."""
ALONG = 0.7
"""Least cosine between two edges that run the same way."""


def ends_of_facets(mesh: TriangleMesh, turnings: Floats, gains: Floats, halfedges: Indices) -> Bools:
    """(n_edges,): edges where a large flat facet ends sharply and no step begins.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    turnings, gains : (n_edges,) ndarray of float
        Turning of the normal at each edge, nan without, and its deviation for heights of deviation 1.
    halfedges : (n_edges,) ndarray of intp
        A half-edge of each edge.

    Notes
    -----
    The smaller facet beside an edge is a step if it turns the other way at its far side.  Surfaces of voxels consist of
    steps, whose treads are flat facets of a surface that is none.
    """
    is_sharp, is_flat = np.empty((2, len(halfedges)), np.bool_)
    edge_noise.compare_turnings(turnings, gains, SHARP, file_rounding(mesh), is_sharp, is_flat)
    if not is_sharp.any() or np.count_nonzero(is_flat) < LARGE:
        return np.zeros(len(halfedges), np.bool_)
    beside = halfedges[is_flat]
    facet_of_face = _facets(mesh.n_faces, np.stack([beside, mesh.topology.partners[beside]], axis=1) // 3)
    if facet_of_face is None:
        return np.zeros(len(halfedges), np.bool_)
    is_large = (np.bincount(facet_of_face) >= LARGE)[facet_of_face]
    other = mesh.topology.partners[halfedges]
    sides = np.stack([halfedges // 3, np.where(other >= 0, other // 3, halfedges // 3)])
    angles = np.where(other >= 0, np.nan_to_num(turnings), 0.0)
    facets, is_large = facet_of_face[sides], is_large[sides]
    ends = is_sharp & is_large.any(axis=0)
    sharp = np.flatnonzero(ends)
    areas = np.bincount(facet_of_face, mesh.face_areas)[facets[:, sharp]]
    smaller = np.where(areas[0] < areas[1], facets[0, sharp], facets[1, sharp])
    ends[sharp] = ~_begin_steps(sharp, smaller, mesh, angles, facets)
    return ends


def _facets(n_faces: int, pairs: Indices) -> Indices | None:
    """(n_faces,): the first face of the facet of each face, for pairs of faces in one plane; None if all are small."""
    joined, places = np.unique(pairs, return_inverse=True)
    first, facet = clusters(len(joined), places.reshape(-1, 2))
    if np.bincount(facet).max(initial=0) < LARGE:
        return None
    facet_of_face = np.arange(n_faces)
    facet_of_face[joined] = joined[first[facet]]
    return facet_of_face


def _begin_steps(edges: Indices, beside: Indices, mesh: TriangleMesh, angles: Floats, facets: Indices) -> Bools:
    """Whether a facet beside each edge, with few borders, turns the other way at an edge that runs along it."""
    turned = np.flatnonzero(np.abs(angles) >= TURNED)
    order = np.argsort(facets[:, turned].ravel(), kind="stable")
    owners, borders = facets[:, turned].ravel()[order], np.tile(turned, 2)[order]
    first, last = (np.searchsorted(owners, beside, side) for side in ("left", "right"))
    counts = np.where(last - first <= FEW, last - first, 0)
    ends = mesh.vertices[mesh.topology.edges]
    along, begins = ends[:, 1] - ends[:, 0], np.zeros(len(edges), np.bool_)
    for start in range(0, len(edges), AT_ONCE):
        part = slice(start, start + AT_ONCE)
        rows = np.repeat(np.arange(len(edges))[part], counts[part])
        place = np.arange(len(rows)) - np.repeat(np.cumsum(counts[part]) - counts[part], counts[part])
        own, far = edges[rows], borders[first[rows] + place]
        cosines = np.sum(along[own] * along[far], axis=1)
        lengths = np.sum(along[own] ** 2, axis=1) * np.sum(along[far] ** 2, axis=1)
        begins[rows[(angles[own] * angles[far] < 0.0) & (cosines**2 > ALONG**2 * lengths)]] = True
    return begins
