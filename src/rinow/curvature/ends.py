"""Ends of surfaces, where a fit has too few points on one side, or none."""

from __future__ import annotations

import numpy as np

from rinow.curvature.angle_defect import longest_edges, ring_deviations
from rinow.curvature.estimate import Estimate
from rinow.curvature.stencils import N_BLOCKS, empty_frames, rings_around, stencil_surface
from rinow.kernels import quadrics
from rinow.mesh import TriangleMesh

__all__ = ["repair_ends"]


def repair_ends(mesh: TriangleMesh, estimate: Estimate, fill: bool) -> None:
    """Undefine what no edge at the boundary can have, and fill in where no patch has a fit."""
    _doubt_ends(mesh, estimate)
    if fill:
        _fill_in(mesh, estimate)
        _doubt_ends(mesh, estimate)


def _doubt_ends(mesh: TriangleMesh, estimate: Estimate) -> None:
    """Undefine curvatures at the boundary that no edge there can have: a chord is at most the diameter of its circle.

    The few points on one side of a short boundary may lie almost on a line, and show any curvature then.
    """
    t = mesh.topology
    at_ends = np.flatnonzero(t.vertex_is_boundary & np.isfinite(estimate.gaussian))
    if not len(at_ends):
        return
    edges, shortest = t.edges[t.vertex_is_boundary[t.edges].any(axis=1)], np.full(mesh.n_vertices, np.inf)
    lengths = np.linalg.norm(np.subtract(*mesh.vertices[edges.T]), axis=1)
    np.minimum.at(shortest, edges.ravel(), np.repeat(lengths, 2))
    largest = np.maximum(np.abs(estimate.k1[at_ends]), np.abs(estimate.k2[at_ends]))  # type: ignore[index]
    estimate.gaussian[at_ends[largest * shortest[at_ends] > 2.0]] = np.nan


def _fill_in(mesh: TriangleMesh, estimate: Estimate) -> None:
    """Take two rings and a quadric, or Euler's formula alone, where no patch has a fit.

    What neighbours with a fit differ by is all that tells an error there.
    """
    has_fit = np.isfinite(estimate.gaussian)
    rows = np.flatnonzero(~has_fit & mesh.topology.vertex_is_used)
    if not len(rows):
        return
    frames = empty_frames(len(rows))
    quadrics.ring_quadrics(rows, stencil_surface(mesh), True, N_BLOCKS, frames)
    estimate.gaussian[rows] = frames.k1 * frames.k2
    estimate.radius[rows] = longest_edges(mesh)[rows]
    beside_fits, deviations = rings_around(mesh.topology, has_fit, 1), ring_deviations(mesh, estimate.gaussian)
    estimate.spread[rows] = np.where(beside_fits, deviations, np.nan)[rows]
    for name in ("k1", "k2", "direction1", "direction2"):
        getattr(estimate, name)[rows] = getattr(frames, name)
    if estimate.mean is not None:
        estimate.mean[rows] = 0.5 * (frames.k1 + frames.k2)
