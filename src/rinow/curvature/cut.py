"""A mesh cut open along its creases, so that curvature on each side is taken from that side alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.barriers import crease_barriers
from rinow.curvature.creases import EdgeTurnings
from rinow.curvature.estimate import Estimate
from rinow.curvature.facets import take_facets, tells_facets
from rinow.curvature.hull_slivers import without_hull_slivers
from rinow.curvature.rims import rims_of, take_strips
from rinow.curvature.rounding import file_rounding
from rinow.curvature.star_bounds import heed_stars
from rinow.curvature.stencils import rings_around
from rinow.curvature.tangent_edges import tangent_edges
from rinow.kernels import cuts
from rinow.mesh import TriangleMesh

__all__ = ["cut_along_creases", "one_sided"]

Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]
Progress = Callable[[int, int], object]

NOISE = 2.0
"""A side bends if its sagitta over a ball exceeds so many standard deviations of the positions."""
SURE, NEAR_RINGS, STRIP_RINGS = 0.5, 8, 3
"""Standard error of a face by itself over that of the whole up to which it is taken, how far from a tangent edge, and
how far from vertices inside the face."""
CLEAR = 0.25
"""The same standard error over what both differ by: so much is no noise, but the jump that the whole does not know."""
OF_VOXELS = 1.2
"""The standard error where vertices were moved to a lattice, neighbours alike, over that of independent noise."""


def cut_along_creases(
    mesh: TriangleMesh, is_crease: NDArray[np.bool_] | None = None
) -> tuple[TriangleMesh, NDArray[np.intp]]:
    """The mesh with a copy of each crease vertex for every side, and the vertex that each one is a copy of.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    is_crease : (n_edges,) ndarray of bool, optional
        Edges to cut, in the order of ``mesh.topology.edges``; by default `crease_barriers`.

    Returns
    -------
    cut : TriangleMesh
        The first n_vertices vertices are those of `mesh`; the creases are boundaries.  All faces point outwards.
    origin : (n_cut_vertices,) ndarray of intp
        Vertex of `mesh` of each vertex of `cut`.
    """
    creased = crease_barriers(mesh) if is_crease is None else is_crease
    origin = np.arange(mesh.n_vertices)
    if not creased.any():
        return mesh, origin
    t, n_corners = mesh.topology, 3 * mesh.n_faces
    edge_of = EdgeTurnings(mesh).edge_of_halfedge
    labels, numbers, faces = np.empty(n_corners, np.intp), np.empty(n_corners, np.intp), mesh.faces.copy()
    cuts.sectors(mesh.faces, t.corner_offsets, t.vertex_corners, t.partners, creased[edge_of], labels)
    origin = np.resize(origin, mesh.n_vertices + n_corners)
    n = cuts.number_sectors(mesh.n_vertices, t.corner_offsets, t.vertex_corners, labels, faces, origin, numbers)
    origin = origin[:n].copy()
    faces[mesh.outward_flips] = faces[mesh.outward_flips, ::-1]
    return TriangleMesh(mesh.vertices[origin], faces), origin


def one_sided(
    method: Callable[..., Estimate], mesh: TriangleMesh, progress: Progress | None = None, **options: Any
) -> tuple[Estimate, Bools]:
    """An estimate that takes no data from beyond a crease, and the vertices on creases.

    At a crease each side has its own curvature; that of the side that bends most is taken, of flat ones that with the
    largest area around the vertex.  Where faces of a part join smoothly, values of each face by itself are taken if
    they promise much less error, unless a radius is given.

    Parameters
    ----------
    method : callable
        From a mesh, `progress` and options to an estimate.
    mesh : TriangleMesh
        The surface.
    progress : callable, optional
        Called with the number of vertices done and their total.
    **options
        Passed on.

    Returns
    -------
    estimate : Estimate
        Of the vertices of `mesh`; without creases that of `method`.
    on_crease : (n_vertices,) ndarray of bool
        The vertex has more than one side.
    """
    is_crease = crease_barriers(mesh)
    smooth = without_hull_slivers(mesh, is_crease)
    if smooth is not mesh:
        mesh, is_crease = smooth, crease_barriers(smooth)
    turnings, is_tangent = EdgeTurnings(mesh), np.zeros(len(is_crease), np.bool_)
    are_steps = turnings.are_steps
    if options.get("radius") is None:
        is_tangent = tangent_edges(mesh, turnings) & ~is_crease
    del turnings  # as large as the mesh
    n, passes, done_before = mesh.n_vertices, 1 + int(is_tangent.any()), 0

    def report(done: int, total: int) -> None:
        if progress is not None:
            progress((done_before + done * n // total) // passes, n)

    cut, origin = cut_along_creases(mesh, is_crease)
    estimate = method(cut, progress=report, **options)
    on_crease = np.bincount(origin, minlength=n) > 1
    if cut is not mesh:
        _heed(cut, estimate, options)
        take_facets(cut, estimate, cut.topology.vertex_is_boundary | ~np.isfinite(estimate.spread))
        if tells_facets(EdgeTurnings(cut)):
            take_strips(cut, estimate, rims_of(cut))
        estimate = _that_bends_most(cut, estimate, origin)
    if is_tangent.any():
        done_before = n
        cut, origin = cut_along_creases(mesh, is_crease | is_tangent)
        beside = method(cut, progress=report, **options)
        _heed(cut, beside, options)
        _take_faces(mesh, is_tangent, estimate, (cut, beside, origin), on_crease)
    if are_steps:
        estimate.spread[:] *= OF_VOXELS
    return estimate, on_crease


def _heed(cut: TriangleMesh, estimate: Estimate, options: dict[str, Any]) -> None:
    """Correct, in place, what the mesh itself contradicts, unless a radius is given or rounding makes its stars."""
    if options.get("radius") is None and tells_facets(EdgeTurnings(cut)):
        heed_stars(cut, estimate, rims_of(cut))


def _take_faces(
    mesh: TriangleMesh, is_tangent: Bools, estimate: Estimate, apart: tuple[TriangleMesh, Estimate, Indices],
    on_crease: Bools,
) -> None:  # fmt: skip
    """Take the curvature of faces by themselves near tangent edges, in place, where it promises much less error.

    Few points on one side may tell less than all around, for which the jump is noise.  But what both differ by, beyond
    the error of the face by itself, is an error of the whole, however small its spread: it bends over the edge.  What
    has no vertex inside is no face but a strip: it is flat whatever the surface is.
    """
    cut, beside, origin = apart
    joins = np.zeros(mesh.n_vertices, np.bool_)
    joins[mesh.topology.edges[is_tangent]] = True
    fitted = np.flatnonzero(joins[origin] & ~on_crease[origin] & np.isfinite(beside.spread))
    fits = beside.at(fitted)
    take_facets(cut, beside, on_crease[origin] | ~np.isfinite(beside.spread))
    beside.fill(fitted, fits)
    is_strip = ~rings_around(cut.topology, ~cut.topology.vertex_is_boundary, STRIP_RINGS)
    beside.spread[is_strip | ~np.isfinite(beside.spread)] = np.inf
    is_known = np.bincount(origin, ~np.isfinite(beside.gaussian), mesh.n_vertices) == 0
    beside = _that_bends_most(cut, beside, origin)
    step = np.nan_to_num(np.abs(beside.gaussian - estimate.gaussian))
    limit = np.fmax(SURE * np.nan_to_num(estimate.spread, nan=np.inf), CLEAR * step)
    is_near = rings_around(mesh.topology, joins, NEAR_RINGS) & is_known
    is_taken = is_near & (beside.spread < limit)
    doubted = np.flatnonzero(is_near & ~is_taken & np.isfinite(beside.spread))
    estimate.spread[doubted] = np.fmax(estimate.spread[doubted], step[doubted] - beside.spread[doubted])
    rows = np.flatnonzero(is_taken)
    estimate.fill(rows, beside.at(rows))


def _that_bends_most(cut: TriangleMesh, estimate: Estimate, origin: Indices) -> Estimate:
    """The copy of each vertex that bends most, of flat ones that with the largest area around it."""
    n, n_cut = int(origin.max()) + 1, cut.n_vertices
    order = np.lexsort((np.arange(n_cut), -cut.vertex_areas, -_bending(estimate, file_rounding(cut)), origin))
    return estimate.at(order[np.searchsorted(origin[order], np.arange(n))])


def _bending(estimate: Estimate, rounding: float) -> NDArray[np.float64]:
    """Squared curvedness at each vertex; 0 where noise or rounding explains the sagitta of its ball, -1 if unknown."""
    mean = np.zeros_like(estimate.gaussian) if estimate.mean is None else estimate.mean
    noise = np.zeros_like(mean) if estimate.noise is None else np.nan_to_num(estimate.noise)
    with np.errstate(invalid="ignore"):
        squared = 2.0 * mean**2 - estimate.gaussian
        sagitta = 0.5 * np.sqrt(np.maximum(squared, 0.0)) * estimate.radius**2
        bends = sagitta > NOISE * np.maximum(noise, rounding)
    return np.where(np.isfinite(squared), np.where(bends, squared, 0.0), -1.0)
