"""Creases beyond doubt, across which no curvature is averaged."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.creases import CreaseLines, EdgeTurnings, crease_lines_of
from rinow.curvature.sheet import patch_sheet
from rinow.curvature.stencils import N_BLOCKS, rings_around
from rinow.curvature.strays import spikes
from rinow.kernels import crease_lines, rounds
from rinow.mesh import TriangleMesh

__all__ = ["crease_barriers"]

Bools = NDArray[np.bool_]

LEAST_ANGLE, LEAST_NOISE = np.radians(7.6), 6.0
"""Turning of an edge that can be certain, alone and in standard deviations.  On a smooth mesh noise makes none such."""
LEAST_EDGES = 8
"""Certain edges of a mesh that is worth a closer look."""
CERTAIN = ((10, 8.0), (8, 16.0))
"""Edges of a certain line, and its median jump over the standard error: shorter ones must be clearer."""
LEAST_ENDS = 3
"""Edges of a certain line at which large flat facets end, however short it is."""
ROUND = np.radians(44.0)
"""Jump up to which lines that only bound single strips of faces may be those of a coarse round."""
ROW, EXACT = np.radians(35.0), 1e3
"""Jump in radians, and over its error, up to which a line may be a row of edges along a round: parts with chamfers have
larger ones, and exact facets."""
ALIKE = 3.0
"""Ratio of the widths of two strips up to which they may be of the same round: a chamfer is narrower than its plane."""


def crease_barriers(mesh: TriangleMesh) -> Bools:
    """(n_edges,): edges that are creases beyond doubt, in the order of ``mesh.topology.edges``.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    is_crease : (n_edges,) ndarray of bool
        Those lines of `singular_features` of ten edges or more whose median jump is eight standard errors, or of eight
        edges with sixteen, or where large flat facets end, without the facets of coarse rounds and the edges around
        spikes.  Noise of a tenth of the edge length makes no such line on a smooth surface.
    """
    turnings = EdgeTurnings(mesh)
    theta = np.abs(turnings.turnings)
    with np.errstate(invalid="ignore"):
        certain = theta > LEAST_ANGLE
        if np.count_nonzero(certain) >= LEAST_EDGES:
            certain &= theta > LEAST_NOISE * turnings.noise
    if np.count_nonzero(certain) < LEAST_EDGES:
        return np.zeros(len(theta), np.bool_)
    return _certain_lines(mesh, turnings, crease_lines_of(turnings))


def _certain_lines(mesh: TriangleMesh, turnings: EdgeTurnings, lines: CreaseLines) -> Bools:
    """(n_edges,): creases on lines with enough edges that are clear of noise, or with ends of large flat facets."""
    edges, kept = mesh.topology.edges, lines.is_crease
    labels = crease_lines.line_components(kept, edges, mesh.n_vertices)
    apart = kept & ~np.all(_around_spikes(mesh, kept)[edges], axis=1)
    sizes = np.bincount(labels[apart], minlength=mesh.n_vertices)
    told = apart & ~_bounds_strips(mesh, turnings, lines) & ~_are_rows(mesh, turnings, lines)
    certain = np.bincount(labels[kept & turnings.ends_facet], minlength=mesh.n_vertices) >= LEAST_ENDS
    for least, ratio in CERTAIN:
        clear = told & (np.abs(lines.angles) >= ratio * lines.errors)
        certain |= (sizes >= least) & (2 * np.bincount(labels[clear], minlength=mesh.n_vertices) > sizes)
    return kept & certain[labels]


def _around_spikes(mesh: TriangleMesh, kept: Bools) -> Bools:
    """(n_vertices,): single vertices beside the surface, and their neighbours.

    At these most edges turn, at corners of parts, which may have many edges, only those of three creases.
    """
    sheet, index = patch_sheet(mesh)
    alone = index[spikes(sheet)[0]]
    t, is_spike = mesh.topology, np.zeros(mesh.n_vertices, np.bool_)
    turning = np.bincount(t.edges[kept].ravel(), minlength=mesh.n_vertices)
    is_spike[alone] = 2 * turning[alone] > np.diff(t.neighbour_offsets)[alone]
    return rings_around(t, is_spike, 1)


def _are_rows(mesh: TriangleMesh, turnings: EdgeTurnings, lines: CreaseLines) -> Bools:
    """(n_edges,): the mesh turns about as much at the next row of edges as at a flat crease, and bends so beyond both.

    Of volumes with thick slices the surfaces have such rows where they run along the slices.
    """
    doubtful = np.abs(lines.angles) < np.minimum(ROW, EXACT * lines.errors)
    rows = np.flatnonzero(lines.is_crease & doubtful)
    votes, found = np.empty(len(rows)), np.zeros(len(lines.is_crease), np.bool_)
    place = mesh.vertices, mesh.faces, turnings.normals, mesh.topology.partners, turnings.halfedges
    rounds.bends_of_rounds(rows, *place, N_BLOCKS, votes)
    found[rows] = votes > 0.5
    return found


def _bounds_strips(mesh: TriangleMesh, turnings: EdgeTurnings, lines: CreaseLines) -> Bools:
    """(n_edges,): both faces of a flat crease have all their vertices on creases and are about as wide."""
    on_crease = np.zeros(mesh.n_vertices, np.bool_)
    on_crease[mesh.topology.edges[lines.is_crease]] = True
    is_strip: Bools = np.all(on_crease[mesh.faces], axis=1, keepdims=False)
    h = turnings.halfedges
    other = mesh.topology.partners[h]
    mine, theirs = mesh.face_areas[h // 3], mesh.face_areas[other // 3]  # on the same edge, as their widths
    alike = np.maximum(mine, theirs) < ALIKE * np.minimum(mine, theirs)
    return (np.abs(lines.angles) < ROUND) & is_strip[h // 3] & (other >= 0) & is_strip[other // 3] & alike
