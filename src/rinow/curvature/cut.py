"""A mesh cut open along its creases, so that curvature on each side is taken from that side alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.barriers import crease_barriers
from rinow.curvature.creases import EdgeTurnings
from rinow.curvature.estimate import Estimate
from rinow.curvature.facets import take_facets
from rinow.curvature.hull_slivers import without_hull_slivers
from rinow.curvature.rounding import file_rounding
from rinow.kernels import cuts
from rinow.mesh import TriangleMesh

__all__ = ["cut_along_creases", "one_sided"]

Bools = NDArray[np.bool_]
Progress = Callable[[int, int], object]

NOISE = 2.0
"""A side bends if its sagitta over a ball exceeds so many standard deviations of the positions."""


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
    largest area around the vertex.

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
    cut, origin = cut_along_creases(smooth, is_crease if smooth is mesh else None)
    n, n_cut = mesh.n_vertices, cut.n_vertices
    if cut is smooth:
        return method(cut, progress=progress, **options), np.zeros(n, np.bool_)

    def report(done: int, total: int) -> None:
        if progress is not None:
            progress(done * n // total, n)

    estimate = method(cut, progress=report, **options)
    take_facets(cut, estimate, cut.topology.vertex_is_boundary | ~np.isfinite(estimate.spread))
    on_crease = np.bincount(origin, minlength=n) > 1
    order = np.lexsort((np.arange(n_cut), -cut.vertex_areas, -_bending(estimate, file_rounding(cut)), origin))
    return estimate.at(order[np.searchsorted(origin[order], np.arange(n))]), on_crease


def _bending(estimate: Estimate, rounding: float) -> NDArray[np.float64]:
    """Squared curvedness at each vertex; 0 where noise or rounding explains the sagitta of its ball, -1 if unknown."""
    mean = np.zeros_like(estimate.gaussian) if estimate.mean is None else estimate.mean
    noise = np.zeros_like(mean) if estimate.noise is None else np.nan_to_num(estimate.noise)
    with np.errstate(invalid="ignore"):
        squared = 2.0 * mean**2 - estimate.gaussian
        sagitta = 0.5 * np.sqrt(np.maximum(squared, 0.0)) * estimate.radius**2
        bends = sagitta > NOISE * np.maximum(noise, rounding)
    return np.where(np.isfinite(squared), np.where(bends, squared, 0.0), -1.0)
