"""What the chords of a smooth surface hide from its metric, and the angle defects without it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.flow import N_BLOCKS, CurvatureFlow
from rinow.curvature.length_noise import LengthNoise
from rinow.curvature.waves import Waves, window
from rinow.kernels import arcs, chord_forms

__all__ = ["Arcs", "without_chords"]

Floats = NDArray[np.float64]

REACH = 4.0
"""Radius of the balls in local spacings: some fifty vertices for eleven unknowns."""

EVIDENCE = 2.0
"""Corrections count from where they halve the noise: five numbers fitted to fifty vertices take away up to that much by
chance."""
SMOOTH = (2, 3)
"""Scale and order of the mean that shows how the curvature varies over the star of a vertex."""


@dataclass(frozen=True)
class Arcs:
    r"""Normal curvatures found in the edge lengths, and the curvature of the arcs that the edges stand for.

    Chords on the normal curvature κ are short by :math:`κ^2 c^3/24` (Haantjes).  On an irregular mesh this is the
    noise of the angle defects, of the size of the curvature at any spacing.  It is noise of known shape: five numbers,
    those of the form :math:`κ^2(θ)`, make it for all vertices around.  So they are found as the form without which the
    defects are smoothest.  On edges that are geodesics already the form found is 0, and on regular meshes, which
    have no such noise, it is not determined and kept small.

    Attributes
    ----------
    flow : CurvatureFlow
        The mesh and its areas.
    """

    flow: CurvatureFlow

    @cached_property
    def _corrections(self) -> tuple[Floats, Floats]:
        """What the lengths and the areas of arcs change: a term to add, and then a factor, of all vertices."""
        flow, n = self.flow, self.flow.mesh.n_vertices
        terms, forms, smooth = np.empty((n, chord_forms.N_FORM)), np.empty((n, chord_forms.N_FORM)), np.empty(n)
        rings = flow.mesh.topology.neighbour_offsets, flow.mesh.topology.neighbours
        spokes = np.empty((len(rings[1]), 2))
        chord_forms.chord_terms(flow.defect_densities, flow.areas, flow.metric, rings, N_BLOCKS, terms, spokes)
        for values in (terms, spokes):
            values[~np.isfinite(values)] = 0.0  # of faces without area
        is_fan, radii = flow.mesh.topology.vertex_is_manifold, REACH * flow.spacing
        data = (flow.defect_densities, flow.areas, terms, spokes)
        chord_forms.fit_forms(radii, *data, is_fan, flow.metric, rings, N_BLOCKS, forms, smooth)
        ratios = np.empty(n)
        arcs.area_ratios(smooth, flow.metric, ratios)
        return np.einsum("vi,vi->v", terms, forms), ratios

    def curvatures(self, shares: Floats) -> Floats:
        """Defects over areas (n_vertices,) of arcs, the correction of each vertex multiplied by its share."""
        terms, ratios = self._corrections
        return (self.flow.defect_densities + shares * terms) / (1.0 + shares * (ratios - 1.0))


def without_chords(flow: CurvatureFlow, noise: LengthNoise) -> tuple[Floats, Floats]:
    """Curvature at the vertices, as far as defects show it without their chords, and the share of the correction.

    Parameters
    ----------
    flow : CurvatureFlow
        The mesh.
    noise : LengthNoise
        What noise of its lengths does.

    Returns
    -------
    curvatures : (n_vertices,) ndarray of float
        Where data are, else 0.
    shares : (n_vertices,) ndarray of float
        1 where the noise of the defects is that of chords alone, 0 where the form of their curvatures is not seen.
    """
    curved = Arcs(flow)
    plain = noise.level(flow, Waves(flow, flow.defect_densities))
    left = noise.level(flow, Waves(flow, curved.curvatures(np.ones(len(plain)))))
    ratio = np.divide(left, plain, out=np.ones_like(plain), where=plain > 0.0)
    shares = np.maximum(1.0 - EVIDENCE * np.where(np.isfinite(ratio), ratio, 1.0), 0.0)
    return _at_vertices(flow, curved.curvatures(shares)), shares


def _at_vertices(flow: CurvatureFlow, means: Floats) -> Floats:
    """Means over stars, turned into values at their vertices by what a smooth curvature has there.

    A defect is the integral of K times the hat function of its vertex.  The first moment of a hat is 0 on average, so
    that a linear K on each face, which is off by half the second moment, is corrected by half its own mean.
    """
    smooth = np.nan_to_num(Waves(flow, means).sums([window(*SMOOTH)])[0])
    hats = np.empty_like(means)
    arcs.hat_means(smooth, flow.areas, flow.metric, hats)
    difference = np.where(flow.has_data, hats - smooth, 0.0)
    return np.where(flow.has_data, means - difference + 0.5 * np.nan_to_num(flow.step(flow.step(difference))), 0.0)
