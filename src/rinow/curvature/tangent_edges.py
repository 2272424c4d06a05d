"""Tangent edges of parts: where two faces join smoothly, as a plane and its rounding do, and the curvature jumps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.creases import EdgeTurnings
from rinow.curvature.rounding import file_rounding
from rinow.kernels import crease_lines, edge_noise
from rinow.mesh import TriangleMesh
from rinow.topology import clusters

__all__ = ["tangent_edges"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

WIDER = 3.0
"""Ratio of the widths of two facets that are not of one face, within which they change little from row to row."""
SHARP, CLEAR = np.radians(35.0), 10.0
"""Turning from which on an edge joins nothing smoothly, and over that by rounding up to which it may be flat."""
NEARLY, BY_DESIGN = 3.0, 0.7
"""Edges turn by less than so many times the rounding, and a share of those by less than it, where facets are flat by
design; by chance it is a third."""
LEAST_LINE, LEAST_SHARE = 4, 2e-3
"""Edges of a line that is none by chance, and of all lines of a mesh of parts: on terrains in whole metres few facets
are flat by chance."""
FREE = 0.15
"""Share of the vertices at which lines may end: those around faces do not, but a quarter of those between the facets
that marching cubes make, next to slivers."""


def tangent_edges(mesh: TriangleMesh, turnings: EdgeTurnings) -> Bools:
    """(n_edges,): edges where a wide flat facet ends and a narrow one begins that turns by little from it.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    turnings : EdgeTurnings
        The turning of its edges.

    Returns
    -------
    is_tangent : (n_edges,) ndarray of bool
        Edges of lines of at least four, in the order of ``mesh.topology.edges``.

    Notes
    -----
    Modellers triangulate each face of a part by itself, as coarsely as its curvature allows: planes by facets of any
    size, cylinders by rows of rectangles, roundings by small triangles.  A facet is all that is flat to rounding around
    a face, its width at an edge the area over the length of that edge, of a single triangle its height.  So the ends of
    long rectangles are wide, where a cylinder goes on as a sphere or a torus, and their sides are narrow.
    """
    n_edges, h, partners = len(turnings.turnings), turnings.halfedges, mesh.topology.partners
    rounding, is_tangent = file_rounding(mesh), np.zeros(n_edges, np.bool_)
    is_sharp, is_flat, is_nearly = np.empty((3, n_edges), np.bool_)
    edge_noise.compare_turnings(turnings.turnings, turnings.gains, SHARP, NEARLY * rounding, is_sharp, is_nearly)
    edge_noise.compare_turnings(turnings.turnings, turnings.gains, SHARP, rounding, is_sharp, is_flat)
    flat = h[is_flat]
    if len(flat) < BY_DESIGN * np.count_nonzero(is_nearly) or not len(flat):
        return is_tangent
    ends = _ends_of_wide_facets(mesh, np.stack([flat, partners[flat]], axis=1) // 3)
    edges = np.searchsorted(h, np.minimum(ends, partners[ends]))
    is_clear = np.abs(turnings.turnings[edges]) > CLEAR * rounding * turnings.gains[edges]
    is_tangent[edges[is_clear & ~is_sharp[edges]]] = True
    least = max(LEAST_LINE, LEAST_SHARE * n_edges)
    if np.count_nonzero(is_tangent) < least or turnings.have_treads:
        return np.zeros(n_edges, np.bool_)
    labels = crease_lines.line_components(is_tangent, mesh.topology.edges, mesh.n_vertices)
    is_tangent &= (np.bincount(labels[is_tangent], minlength=mesh.n_vertices) >= LEAST_LINE)[labels]
    degrees = np.bincount(mesh.topology.edges[is_tangent].ravel())
    are_lines = np.count_nonzero(degrees == 1) <= FREE * np.count_nonzero(degrees)
    return is_tangent & (are_lines and np.count_nonzero(is_tangent) >= least)


def _ends_of_wide_facets(mesh: TriangleMesh, pairs: Indices) -> Indices:
    """Half-edges of facets, made of pairs (k, 2) of coplanar faces, beyond which the facet or face is much narrower.

    Both have the same edge, so that the ratio of the widths is that of the areas.
    """
    faces, places = np.unique(pairs, return_inverse=True)
    facet = clusters(len(faces), places.reshape(-1, 2))[1]
    own, inner = np.repeat(facet, 3), (3 * faces[:, None] + np.arange(3)).ravel()
    outer = mesh.topology.partners[inner]
    place = np.minimum(np.searchsorted(faces, outer // 3), len(faces) - 1)
    is_alone = faces[place] != outer // 3
    is_end = is_alone | (facet[place] != own)
    own, inner, outer, place, is_alone = (x[is_end] for x in (own, inner, outer, place, is_alone))
    areas = np.bincount(facet, mesh.face_areas[faces])
    beyond = np.where(is_alone, 2.0 * mesh.face_areas[outer // 3], areas[facet[place]])
    return inner[(outer >= 0) & (areas[own] >= WIDER * beyond)]
