"""A point cloud as the fits of patches see it: neighbours, normals of agreeing signs, and the spacing of the points."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.cloud_faces import agreed_triangles
from rinow.curvature.cloud_hands import hands
from rinow.curvature.cloud_holes import filled
from rinow.curvature.cloud_signs import outward
from rinow.curvature.cloud_stars import FEW, agreement, first_stars, links_of, normals_of, stars_over
from rinow.curvature.stencils import NEEDLES
from rinow.kernels import balls, stencils

__all__ = ["Cloud", "cloud_sheet"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

SKEW = 0.1
"""Shear of the plane along the long axis of a star.  Rectangles of rows of points have two Delaunay triangulations;
all are cut along the same one of their diagonals then, as in a structured mesh; which one the cloud decides, see
`cloud_hands`."""
BORDER_GAP = 2.8
"""Angle between neighbours, in radians, that tells a border: inside, Delaunay triangles have less."""


class Cloud(NamedTuple):
    """A cloud as the fits see it, the triangles on which its stars agree, and which points are at a border.

    `agreement` is the share of the triangles of each star that are in those of all three corners.
    """

    sheet: balls.Sheet
    faces: Indices
    at_border: Bools
    agreement: Floats


def cloud_sheet(points: Floats, distances: Floats, near: Indices) -> Cloud:
    """The sheet of a cloud of distinct finite points, in their order, with their nearest ones.

    Neighbours are those of the Delaunay triangulation of the nearest points, laid over the plane of least squares of
    few.  Normals are the area vectors of these stars, averaged over the neighbours, and the stars are laid over these
    once more if there are enough: planes of few points turn with noise, those of many cut corners.  For the signs see
    `cloud_signs`.
    """
    normals, stars = first_stars(points, near)
    links = links_of(stars)
    normals = outward(points, normals, links)
    skew = SKEW * hands(points, normals, near, links)
    for rounds in (1, 2) if near.shape[1] > FEW else (2,):
        stars = stars_over(points, normals, near, stars, skew)
        links = links_of(stars)
        normals = normals_of(points, normals, stars, links, rounds)
    offsets, neighbours = links.indptr.astype(np.int32), links.indices.astype(np.int32)
    reach, at_border = distances[:, -1], stars.gaps > BORDER_GAP
    even = _even_spacing(distances, near, at_border)
    sheet = balls.Sheet(points, normals, offsets, neighbours, _spacing(points, even, offsets, neighbours), True)
    faces = filled(points, normals, agreed_triangles(points, stars, reach), reach, at_border)
    return Cloud(sheet, faces, at_border, agreement(stars))


def _even_spacing(distances: Floats, near: Indices, at_border: Bools) -> Floats:
    """Edge of equilateral triangles of the same density, from the distance of the last of the nearest points.

    A border cuts the disc of that radius, so that it is too large; where it is cut, that of the nearest points whose
    disc is not cut is taken, if there are any.
    """
    even = np.sqrt(2.0 / np.sqrt(3.0) * np.pi / (distances.shape[1] + 0.5)) * distances[:, -1]
    is_cut = at_border | at_border[near].any(axis=1)
    whole = ~is_cut[near[is_cut]]
    counts = np.count_nonzero(whole, axis=1)
    means = np.sum(even[near[is_cut]] * whole, axis=1) / np.maximum(counts, 1)
    even[is_cut] = np.where(counts > 0, means, even[is_cut])
    return even


def _spacing(points: Floats, even: Floats, offsets: NDArray[np.int32], neighbours: NDArray[np.int32]) -> Floats:
    """Mean distance of neighbours, between the edge of equilateral triangles of the same density and some of it.

    The same rule as for meshes: rows of points need the larger one, clusters must not get too small a one.
    """
    edges, sums = np.empty(len(points)), np.empty(len(points))
    stencils.mean_edge_lengths(points, offsets, neighbours, edges)
    local = np.clip(edges, even, NEEDLES * even)
    stencils.ring_sums(local, offsets, neighbours, sums)
    return sums / (np.diff(offsets) + 1)
