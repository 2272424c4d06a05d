"""Meshes as metric spaces: all vertices where that is affordable, else a net with its true covering radius."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from rinow import tolerances
from rinow.comparison.clock import Clock
from rinow.comparison.edge_metric import EdgeMetric
from rinow.errors import InvalidInputError, InvalidMeshError, NotAMetricError, naming
from rinow.geodesics.distances import geodesic_space
from rinow.geodesics.edge_graph import edge_graph
from rinow.mesh import IntrinsicMesh, TriangleMesh, as_mesh, is_mesh_like
from rinow.metric_space import MetricSpace, finite_distances

__all__ = ["Sample", "check_connected", "eccentricity_gap", "geodesics_within", "sample_of", "samples_of"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

ALL_VERTICES = 3000
"""Vertices up to which all distances of a mesh are computed, if the time suffices: 72 MB."""

LARGEST_DISTANCE = 1e307
"""From the first point to the farthest one, so that sums of distances are numbers."""

LARGEST_NET, NET_BYTES = 580, 1 << 29
"""Points of a net, and memory for their distances to all vertices."""


SHARES, SMALL_NET, SHARES_OF_SMALL = (0.1, 0.11), 100, (0.4, 0.65)
"""Shares of the time left that the first and the second net take, and while they have fewer points than that: these are
compared in no time."""
SHARE_OF_ALL = 0.08
"""Share of the time left in which all distances of a mesh must be known, or its net is compared: some thousand points
take ten times as long to compare."""


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """Points of a space and their distances to all its points.

    Attributes
    ----------
    indices : (k,) ndarray of int
        The chosen points as vertices of the mesh or points of the space.
    rows : (k, n) ndarray of float
        Distances to the n points of the space.
    distances : (k, k) ndarray of float
        Distances between the chosen points.
    covering_radius : float
        Greatest distance of a point from the nearest chosen one; 0 if all were chosen.
    vertices : (n,) ndarray of int
        The points of the space as vertices of the mesh or points of the space.
    metric : EdgeMetric or None
        Where other rows of a mesh come from.
    """

    indices: Indices
    rows: Floats
    distances: Floats
    covering_radius: float
    vertices: Indices
    metric: EdgeMetric | None = None

    @property
    def positions(self) -> Indices:
        """The chosen points among those of the space."""
        return np.searchsorted(self.vertices, self.indices)

    @property
    def eccentricity_bounds(self) -> tuple[Floats, Floats]:
        """(n,) each: bounds of the eccentricity of every point of the space; equal where all points were chosen."""
        if self.covering_radius == 0.0 and len(self.rows) == self.rows.shape[1]:
            return self.rows.max(axis=1), self.rows.max(axis=1)
        own = self.rows.max(axis=1)[:, None]
        low = np.maximum(self.rows.max(axis=0), (own - self.rows).max(axis=0))
        return low, (own + self.rows).min(axis=0)

    @property
    def diameter_bound(self) -> float:
        """Upper bound of the diameter of the space."""
        by_ball = 2.0 * float(self.rows.max(axis=1).min())
        return min(by_ball, float(self.distances.max()) + 2.0 * self.covering_radius)


def samples_of(X: Any, Y: Any, clock: Clock) -> tuple[Sample, Sample]:
    """The samples of two spaces or meshes, in a share of the time."""
    samples: list[Sample] = []
    for name, thing, *shares in zip("XY", (X, Y), SHARES, SHARES_OF_SMALL, strict=True):
        clocks = (clock.part(share * clock.left) for share in (*shares, SHARE_OF_ALL))
        with naming(name):
            samples.append(sample_of(thing, *clocks))
    return samples[0], samples[1]


def sample_of(thing: Any, clock: Clock, clock_of_small: Clock, clock_of_all: Clock) -> Sample:
    """All points of a space, or a net of a mesh that grows while there is time: to all vertices of a small one.

    Raises
    ------
    InvalidInputError
        If it is neither a space nor a mesh, or the mesh has no face that takes part.
    NotAMetricError
        If a matrix is not a metric, or the faces of a mesh are not connected.
    """
    if not is_mesh_like(thing):
        D = finite_distances(thing)
        return Sample(np.arange(len(D)), D, D, 0.0, np.arange(len(D)))
    return _net(*_connected_edges(as_mesh(thing)), clock, clock_of_small, clock_of_all)


def eccentricity_gap(X: Sample, Y: Sample, beyond: tuple[float, float] = (0.0, 0.0)) -> float:
    """Lower bound of the distortion: every point has a partner whose eccentricity differs by no more than it.

    `beyond` are the radii within which the samples' spaces come to all points of the spaces to be compared.
    """
    return max(_one_sided(X, Y, *beyond), _one_sided(Y, X, *reversed(beyond)))


def _one_sided(X: Sample, Y: Sample, r: float, s: float) -> float:
    """The same for the chosen points of X.

    Beyond its points X reaches r farther; a point of Y has a point within s whose eccentricity is smaller by s at most,
    and larger by 2s, for Y reaches s farther too.
    """
    low, high = Y.eccentricity_bounds
    gaps = [float(np.maximum(low - s - (e + r), e - (high + 2.0 * s)).min()) for e in X.rows.max(axis=1)]
    known = Y.covering_radius == 0.0 and r == s == 0.0
    return max(0.0, max(gaps) - (0.0 if known else tolerances.COMPARISON * float(high.max())))


def _connected_edges(mesh: TriangleMesh | IntrinsicMesh) -> tuple[csr_array, Indices]:
    """The edges of a mesh between the vertices that have a face, and these vertices."""
    check_connected(mesh)
    vertices = np.flatnonzero(mesh.topology.vertex_is_used)
    return csr_array(edge_graph(mesh)[vertices][:, vertices]), vertices


def check_connected(mesh: TriangleMesh | IntrinsicMesh, *, every_vertex: bool = False) -> None:
    """Refuse a mesh whose faces are not connected, or with `every_vertex` one with a vertex that has no face.

    Raises
    ------
    InvalidMeshError
        If no face takes part, or one of the vertices has no face.
    NotAMetricError
        If no path joins two vertices; they are the witness.
    """
    parts = mesh.components
    used, bare = np.flatnonzero(parts >= 0), np.flatnonzero(parts < 0)
    if not len(used):
        raise InvalidMeshError("mesh has no face with three different finite vertices; a space has at least one point.")
    apart = used[parts[used] != parts[used[0]]]
    if len(apart):
        i, j = int(used[0]), int(apart[0])
        raise NotAMetricError(f"mesh has no path from vertex {i} to vertex {j}; take one component.", (i, j))
    if every_vertex and len(bare):
        raise InvalidMeshError(f"mesh has no face at vertex {bare[0]}, and so no path to it; remove such vertices.")


def geodesics_within(mesh: TriangleMesh | IntrinsicMesh, clock: Clock) -> MetricSpace:
    """All vertices of a mesh with their exact geodesic distances, if the time suffices for them.

    What the first sources take tells what all of them will take.

    Raises
    ------
    InvalidInputError
        If the time will not suffice, or is over.
    """
    first: list[float] = []

    def look(done: int, total: int) -> None:
        first.append(clock.elapsed)
        if len(first) == 1 or done == total:  # the first sources load compiled code, too
            return
        expected = (first[-1] - first[0]) / (1.0 - 1.0 / len(first)) * total / done
        if clock.over or expected > clock.seconds:
            raise InvalidInputError(
                f"the geodesic distances of {total:,} vertices take about {expected:.2g} s, too much for the "
                f"time limit; allow {math.ceil(3.0 * expected)} s, or simplify the meshes."
            )

    check_connected(mesh, every_vertex=True)
    return geodesic_space(mesh, progress=look)


def _net(graph: csr_array, vertices: Indices, clock: Clock, clock_of_small: Clock, clock_of_all: Clock) -> Sample:
    """Farthest points in turn, with their distances to all vertices: of a small mesh all, in their order."""
    n = len(vertices)
    size = n if n <= ALL_VERTICES else max(2, min(LARGEST_NET, NET_BYTES // (8 * n)))
    rows, chosen, metric = np.empty((size, n)), [0], EdgeMetric(graph)
    nearest = np.full(n, np.inf)
    for k in range(size):
        rows[k] = metric.row(chosen[k])
        if k == 0 and not rows[0].max() < LARGEST_DISTANCE:
            raise InvalidMeshError(f"mesh has distances of {rows[0].max():.3g}, and some are no number; scale it.")
        np.minimum(nearest, rows[k], out=nearest)
        nearest[chosen[k]] = -1.0  # vertices may coincide
        limit = clock_of_small if k < SMALL_NET else clock if k < LARGEST_NET else clock_of_all
        if k + 1 == size or (k > 0 and limit.over):
            break
        chosen.append(int(nearest.argmax()))
    if LARGEST_NET < len(chosen) < n:
        chosen = chosen[:LARGEST_NET]
        nearest = rows[:LARGEST_NET].min(axis=0)
    distances = rows[: len(chosen), chosen]
    distances = np.minimum(distances, distances.T)
    if len(chosen) == n:
        places = np.argsort(chosen)
        distances = distances[np.ix_(places, places)]
        return Sample(vertices, distances, distances, 0.0, vertices, metric)
    return Sample(vertices[chosen], rows[: len(chosen)], distances, float(nearest.max()), vertices, metric)
