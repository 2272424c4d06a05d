"""Curvature of a surface by geodesic distances around each vertex: stars, and quadruples with a linear triple."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from rinow.curvature.estimate import Estimate
from rinow.curvature.flow import CurvatureFlow
from rinow.curvature.wald import wald
from rinow.geodesics.edge_graph import edge_graph
from rinow.geodesics.exact import ExactGeodesics, GeodesicBalls
from rinow.kernels import geodesic_stars as kernels
from rinow.kernels import patch_order
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = ["geodesic_wald", "robinson"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.intp]

PATCH, BLOCK = 200, 4096
"""Vertices of a patch, in whose order they are taken, and those whose balls are held at a time."""
SPACINGS = 4.0
"""Default radius of `robinson`, in local spacings."""
CROWDED, GRADED = 8.0, 0.5
"""A default radius is at most so many spacings of even triangles at any vertex, and this share of the distance from
there more: no ball holds thousands of vertices of finer parts."""
INNER = 0.7
"""Radius of the star that one is compared with, over its own."""
PASSES = 3
"""Repetitions of the mean over a ring that average squared differences."""
CALIBRATION = 1.5
"""Spread over that mean difference: the error of order radius² is twice the difference, that of noise below it."""
RESOLVED = 1.5
"""Least radius that is resolved, in local spacings.  A mesh has its curvature at vertices: with a radius of one spacing
`robinson` sees half of it, with two spacings nine tenths."""
SLACK = 1.3
"""Radius of balls in which the distances between ends are looked for, over those distances in the plane."""
ORDER = 2
"""Of Robinson's formula: with the next term of its series."""


class _Ends(NamedTuple):
    """Ends of four lines through some centres, a row of eight each; -1 and nan for none."""

    vertices: Indices
    distances: Floats
    directions: Floats
    totals: Floats
    """Angles around the centres."""
    bends: Floats
    """(n, 4): angles of the second ends beyond the straight continuation of the first."""
    radii: Floats


Method = Callable[[ExactGeodesics, _Ends], Floats]


def geodesic_wald(mesh: TriangleMesh | IntrinsicMesh, radius: float) -> Estimate:
    r"""Curvature k of the surface S_k in which a star of geodesic distances around each vertex closes up.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface; only edge lengths are used.
    radius : float
        Radius of the stars.

    Returns
    -------
    estimate : Estimate
        `gaussian` is nan at the boundary and at vertices that are not manifold.  Near the boundary the radius is the
        distance from it; a vertex less than 1.5 spacings from it has the mean of those beside it that are farther
        away, or, if there are none, the curvature of its ring.  `spread` is 1.5 times the root of the mean square,
        around each vertex, of the difference from the star of 0.7 times the radius.

    Notes
    -----
    A star has up to eight vertices near the distance `radius`, in about equal directions, first one way round and then
    the other from the vertex nearest to it; its sides and the chords between neighbours are exact geodesic distances.
    The value is the only k at which the comparison angles at the centre sum to 2π (Wald), which by Gauss and Bonnet is
    a mean of the curvature within.  On a mesh of a smooth surface with edges of length h its error is of second order
    in `radius`, plus one of `(h/radius)²` or less: it converges if the radius tends to 0 more slowly than h.
    """
    ring = wald(mesh)
    values, radii = _both(mesh, np.full(mesh.n_vertices, radius), _star_values)
    flow = CurvatureFlow(mesh)
    is_cut = (radii < RESOLVED * flow.spacing) & (radii < radius)
    small = np.isfinite(ring.gaussian) & np.isnan(values[0])
    values[0, small] = ring.gaussian[small]
    radii[small] = ring.radius[small]
    estimate = _estimate(mesh, values, radii)
    estimate.spread[small] = np.hypot(ring.spread[small], estimate.spread[small])
    _take_from_beside(flow, estimate, is_cut & np.isfinite(estimate.gaussian))
    return estimate


def robinson(mesh: TriangleMesh | IntrinsicMesh, radius: float | None = None) -> Estimate:
    r"""Mean of Robinson's rational formula over quadruples of geodesic distances with a linear triple at each vertex.

    Parameters
    ----------
    mesh : TriangleMesh or IntrinsicMesh
        The surface; only edge lengths are used.
    radius : float, optional
        Distance of the points of the quadruples from the vertex; by default four local spacings, or less where a finer
        part of the mesh is near.

    Returns
    -------
    estimate : Estimate
        As for `geodesic_wald`, but nan where too few vertices are in reach.  A vertex less than 1.5 spacings from the
        boundary has the mean of those beside it that are farther away, and the spread that of the values around too.

    Notes
    -----
    Each of four lines through the vertex v has the ends a and b; q is an end of the line across it.  (a, v, b, q) is a
    quadruple with v between a and b, once b has been turned about v onto the straight continuation of av, which halves
    the angle around v: b is chosen so that the turn is small, and its distance from q follows from that in the plane
    triangle (v, b, q), whose angle grows by the turn.  The value is the mean over both ends of all four lines, which
    by its symmetry has an error of second order in the radius.
    """
    flow = CurvatureFlow(mesh)
    sizes = _default_radii(flow) if radius is None else np.full(mesh.n_vertices, radius)
    values, radii = _both(mesh, sizes, _robinson_values)
    estimate = _estimate(mesh, values, radii.copy())
    _take_from_beside(flow, estimate, (radii < RESOLVED * flow.spacing) & (radii < sizes))
    return estimate


def _default_radii(flow: CurvatureFlow) -> Floats:
    """(n_vertices,): `SPACINGS`, less where finer parts are near, by shortest paths from beyond all vertices."""
    beyond, fine = flow.mesh.n_vertices, CROWDED * flow.even_spacing
    known = np.flatnonzero(np.isfinite(fine) & (fine > 0.0))
    edges = edge_graph(flow.mesh).tocoo()
    rows, columns = (
        np.concatenate([own, other])
        for own, other in zip(edges.coords, (np.full_like(known, beyond), known), strict=True)
    )
    graph = csr_array(
        (np.concatenate([GRADED * edges.data, fine[known]]), (rows, columns)), shape=(beyond + 1, beyond + 1)
    )
    return np.minimum(SPACINGS * flow.spacing, dijkstra(graph, indices=beyond)[:beyond])


def _take_from_beside(flow: CurvatureFlow, estimate: Estimate, to_fill: Bools) -> None:
    """Give vertices the means of others in the two rings around, those farther in first, as far as there are any.

    The spread takes the differences of these from the mean twice: the vertex is beside them, not amid.
    """
    K, spread, radii = estimate.gaussian, estimate.spread, estimate.radius
    known, filled = np.isfinite(K) & np.isfinite(spread) & ~to_fill, to_fill
    while filled.any():
        columns = np.column_stack([known.astype(np.float64), K, K * K, spread * spread, radii])
        columns[~known] = 0.0
        share, mean, square, variance, radius = flow.means(columns, 2).T
        filled = to_fill & ~known & (share > 0.0)
        K[filled], radii[filled] = mean[filled] / share[filled], radius[filled] / share[filled]
        around = np.maximum(square[filled] / share[filled] - K[filled] ** 2, 0.0)
        spread[filled] = np.sqrt(variance[filled] / share[filled] + 4.0 * around)
        known |= filled


def _both(mesh: TriangleMesh | IntrinsicMesh, sizes: Floats, method: Method) -> tuple[Floats, Floats]:
    """(2, n): values of the radii and of smaller ones; (n,): radii used."""
    t, geodesics = mesh.topology, ExactGeodesics(mesh)
    order = patch_order.patch_order(t.neighbour_offsets, t.neighbours, PATCH)
    is_inner = t.vertex_is_manifold & ~t.vertex_is_boundary & np.isfinite(sizes) & (sizes > 0.0)
    centres = order[is_inner[order]]
    values, radii = np.full((2, mesh.n_vertices), np.nan), np.full(mesh.n_vertices, np.nan)
    for start in range(0, len(centres), BLOCK):
        block = centres[start : start + BLOCK]
        balls = geodesics.polar(block, max_distance=kernels.FARTHEST * sizes[block])
        for row, share in enumerate((1.0, INNER)):
            senses = [_ends(b, t.vertex_is_boundary, sizes[block], share) for b in (balls, _mirrored(balls))]
            one, other = (method(geodesics, ends) for ends in senses)
            values[row, block] = np.where(np.isnan(one), other, np.where(np.isnan(other), one, 0.5 * (one + other)))
            if row == 0:
                radii[block] = senses[0].radii
    return values, radii


def _mirrored(balls: GeodesicBalls) -> GeodesicBalls:
    """The balls as they are seen from below."""
    return replace(balls, directions=-balls.directions)


def _ends(balls: GeodesicBalls, is_boundary: Bools, sizes: Floats, share: float) -> _Ends:
    n, radii = len(sizes), sizes.copy()
    entries, bends = np.full((n, 2 * kernels.LINES), -1, np.intp), np.full((n, kernels.LINES), np.nan)
    ball = balls.vertices, balls.distances, balls.directions
    kernels.choose_ends(ball, balls.offsets, balls.total_angles, is_boundary, share, radii, entries, bends)
    found = entries >= 0
    vertices = np.where(found, balls.vertices[entries], -1)
    distances, directions = (np.where(found, x[entries], np.nan) for x in (balls.distances, balls.directions))
    return _Ends(vertices, distances, directions, balls.total_angles, bends, radii)


def _distances_between(geodesics: ExactGeodesics, ends: _Ends, first: Indices, second: Indices) -> Floats:
    """(n, k): geodesic distances between the ends in the columns `first` and `second`, (k,) or (n, k); nan for none."""
    rows = np.arange(len(ends.radii))[:, None]
    a, b = ends.vertices[rows, first], ends.vertices[rows, second]
    p, q = ends.distances[rows, first], ends.distances[rows, second]
    turns = ends.directions[rows, second] - ends.directions[rows, first]
    with np.errstate(invalid="ignore"):
        plane = np.sqrt(p * p + q * q - 2 * p * q * np.cos(turns * (2 * np.pi / ends.totals[:, None])))
    known = np.isfinite(plane)
    sources, place = np.unique(a[known], return_inverse=True)
    reach = np.zeros(len(sources))
    np.maximum.at(reach, place, SLACK * plane[known])
    near = csr_array(geodesics.distances(sources, max_distance=reach))
    out = np.full(a.shape, np.nan)
    found = np.empty(len(place))
    kernels.look_up(near.indptr, near.indices, near.data, place.astype(np.intp), b[known], found)
    out[known] = found
    return out


def _star_values(geodesics: ExactGeodesics, ends: _Ends) -> Floats:
    """Embedding curvature of the star of the different ends of each centre."""
    n, size = ends.vertices.shape
    order, counts = np.empty((n, size), np.intp), np.empty(n, np.intp)
    kernels.order_stars(ends.vertices, ends.directions, ends.totals, order, counts)
    columns = np.arange(size)
    following = np.where(columns + 1 < counts[:, None], np.roll(order, -1, axis=1), order[:, :1])
    chords = _distances_between(geodesics, ends, order, following)
    values = np.empty(n)
    kernels.star_values(counts, np.take_along_axis(ends.distances, order, axis=1), chords, values)
    return values


def _robinson_values(geodesics: ExactGeodesics, ends: _Ends) -> Floats:
    """Mean of Robinson's approximations over the lines of each centre."""
    first, second = np.array([(k + 4 * e, k + 2 + 4 * f) for k in range(2) for e in range(2) for f in range(2)]).T
    across = _distances_between(geodesics, ends, first, second).reshape(-1, 2, 2, 2)
    values = np.empty(len(across))
    kernels.robinson_values(ends.distances, across, ends.bends, ORDER, values)
    return values


def _estimate(mesh: TriangleMesh | IntrinsicMesh, values: Floats, radii: Floats) -> Estimate:
    """The values of the larger radius; their spread from those of the smaller one, or all of them without any.

    Radii near the spacing see a share of the curvature that the spread takes into account.
    """
    flow, squares = CurvatureFlow(mesh), (values[0] - values[1]) ** 2
    known = np.isfinite(squares)
    sums, shares = flow.means(np.column_stack([np.where(known, squares, 0.0), known.astype(np.float64)]), PASSES).T
    squares = CALIBRATION**2 * np.divide(sums, shares, out=values[0] ** 2, where=shares > 0.0)
    small = np.flatnonzero(radii < RESOLVED * flow.spacing)
    with np.errstate(over="ignore"):  # a radius of nothing sees nothing: the spread is infinite
        squares[small] += values[0, small] ** 2 * (flow.spacing[small] / radii[small]) ** 4
    spread = np.sqrt(squares)
    missing = np.isnan(values[0])
    radii[missing], spread[missing] = np.nan, np.nan
    return Estimate(values[0].copy(), spread, radii)
