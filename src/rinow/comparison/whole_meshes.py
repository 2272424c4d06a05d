"""Correspondences of all vertices of two meshes, found from nets, and bounds of their distortion from some rows.

Let R be a correspondence, a relation that covers both spaces, and δ(i) for any pair i of it the largest value of
|d(x_i, x_j) - d(y_i, y_j)| over the pairs j.  From i to another pair j, distances to a third one change by d(x_i, x_j)
and d(y_i, y_j) at most, so

    δ(j) <= δ(i) + d(x_i, x_j) + d(y_i, y_j),

and the distortion of R is at most the largest value, over all its pairs j, of the least right side among those pairs i
of which all distances are known.  These are chosen where the bound is largest: many where δ is large, few elsewhere.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow import tolerances
from rinow.comparison.clock import Clock
from rinow.comparison.edge_metric import EdgeMetric
from rinow.comparison.large_work import farthest_points
from rinow.comparison.surfaces import Sample
from rinow.kernels import distortion_bounds, landmark_maps
from rinow.kernels.edge_rows import LANES

__all__ = ["Chooser", "WholeRelation", "whole_relation"]

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Indices = NDArray[np.intp]

NET, LANDMARKS = 160, 96
"""Farthest points of X whose images are improved, and random ones of them whose distances tell images of vertices."""

ROUNDS, SWEEPS = 6, 4
"""Times that the images of the net are found anew, and that all vertices are run through to find theirs."""

SHARE_OF_IMAGES = 0.35
"""Share of the time for the images of the net."""

PARTS = 10
"""Parts of a sweep, or of the net, between two looks at the clock."""

GROUPS = 8
"""Groups of pairs between two looks at the clock."""

WIDTH = 4.0
"""Radius of the ball from which a group is chosen, in the distances that its points shall have."""

LOOKED_AT, SHARE_OF_COVER = 6e7, 0.5
"""Vertices times pairs looked at in a second, until that is measured, and share of the time that is planned for."""

LEVELS, FALL = 40, 0.85
"""Levels below the bound that may be aimed at; the excess of each over the expected distortion, over the last one's."""

CROWDED = 1.2
"""Nodes needed for a cover, chosen in any order instead of farthest ones first."""


class WholeRelation:
    """A correspondence of all nodes: those of X with their images f, then those of Y with theirs, g.

    Attributes
    ----------
    xs, ys : (n + m,) ndarray of int
        The pairs.
    net : (int, float)
        Number of points of a net of X, and its covering radius.
    bounds : (n + m,) ndarray of float
        An upper bound of δ for each.
    seen, expected : float
        The largest δ of a pair of R of which all distances are known, and what the largest of all pairs may be.
    """

    def __init__(self, X: EdgeMetric, Y: EdgeMetric, f: Indices, g: Indices, net: tuple[int, float]) -> None:
        self.X, self.Y, self.net = X, Y, net
        self.xs, self.ys = np.concatenate([np.arange(len(X)), g]), np.concatenate([f, np.arange(len(Y))])
        self.bounds = np.full(len(self.xs), np.inf)
        self.seen = self.expected = 0.0

    @property
    def upper(self) -> float:
        """Upper bound of the distortion; distances are rounded sums, for which the triangle inequality is, too."""
        return float(self.bounds.max()) * (1.0 + tolerances.COMPARISON)

    def pairs(self, X: Sample, Y: Sample) -> Indices:
        """(k, 2): the different pairs, as vertices of the meshes."""
        xs, ys = X.vertices[self.X.order[self.xs]], Y.vertices[self.Y.order[self.ys]]
        return np.unique(np.stack([xs, ys], axis=1), axis=0)

    def know(self, row_x: Floats, row_y: Floats) -> None:
        """Lower the bounds by the rows of one pair, which need not belong to R."""
        from_x, from_y = row_x[self.xs], row_y[self.ys]
        distortion = float(np.abs(from_x - from_y).max())
        self.expected = max(self.expected, distortion)
        np.minimum(self.bounds, distortion + (from_x + from_y), out=self.bounds)

    def improve(self, clock: Clock) -> None:
        """Lower the bounds by rows of groups of pairs until the time is over or no more is to be gained."""
        choosers, start, n_looked = (Chooser(self.X), Chooser(self.Y)), clock.elapsed, 0
        rate = LOOKED_AT / len(self.xs)
        while not clock.over and self.bounds.max() > self.seen:
            groups = self._chosen(choosers, *self._aim(SHARE_OF_COVER * clock.left * rate))
            distortions, bounds = np.empty(groups.shape), np.repeat(self.bounds[None], len(groups), axis=0)
            distortion_bounds.bound_distortions(
                self.xs, self.ys, groups, self.X.graph, self.Y.graph, (self.X.step, self.Y.step), distortions, bounds
            )
            bounds.min(axis=0, out=self.bounds)
            self.seen = max(self.seen, float(distortions.max()))
            n_looked += groups.size
            rate = n_looked / max(clock.elapsed - start, 1e-9)

    def _aim(self, n_pairs: float) -> tuple[float, float]:
        """The distortion to expect, and the lowest level to which so many pairs can bring all bounds, about."""
        expected, upper = max(self.expected, self.seen), float(self.bounds.max())
        if not expected < upper:
            expected = self.seen
        n, radius = self.net
        level = expected
        for k in range(1, LEVELS):
            level = expected + (upper - expected) * FALL**k
            reach = 0.5 * FALL * (level - expected)
            share = np.count_nonzero(self.bounds > level) / len(self.bounds)
            if not CROWDED * n * share * radius * radius <= n_pairs * reach * reach:
                break
        return expected, min(level, float(np.nextafter(upper, 0.0)))

    def _chosen(self, choosers: tuple[Chooser, Chooser], expected: float, level: float) -> Indices:
        """Groups of pairs whose bounds are above a level: at least the one with the largest bound."""
        bounds, n = self.bounds.copy(), len(self.X)
        below = expected + FALL * (level - expected)
        groups: list[Indices] = []
        while len(groups) < GROUPS:
            seed = int(bounds.argmax())
            if not bounds[seed] > level:
                break
            way = int(seed >= n)
            part = bounds[n:] if way else bounds[:n]
            groups.append(way * n + choosers[way].group(seed - way * n, part, below, expected, 2.0))
        return np.array(groups, np.intp)


class Chooser:
    """Groups of nodes near each other at which rows shall be found."""

    def __init__(self, metric: EdgeMetric) -> None:
        n, n_arcs = len(metric), len(metric.graph[1])
        self._graph = metric.graph
        self._spaces = np.full(n, np.inf), np.empty(n, np.intp), np.full(n, np.inf), np.empty(n, np.intp)
        self._work = np.empty(n_arcs + 1), np.empty(n_arcs + 1, np.intp)

    def group(self, seed: int, bounds: Floats, target: float, value: float, slope: float) -> Indices:
        """A seed and nodes near it whose bounds are above a target; these and those around them are lowered.

        A node at distance d from one of the group is expected to fall to value + slope · d.
        """
        group = np.empty(LANES, np.intp)
        distortion_bounds.choose_group(
            seed, target, value, slope, WIDTH, self._graph, bounds, group, self._spaces, self._work
        )
        return group


def whole_relation(X: Sample, Y: Sample, pairs: Indices, clock: Clock) -> WholeRelation | None:
    """A correspondence of all vertices that begins with pairs of points of two nets, which must be nets of meshes.

    None if the time does not suffice.
    """
    mx, my = X.metric, Y.metric
    if mx is None or my is None:
        return None
    chosen = farthest_points(X.distances, NET)
    f = np.empty(len(X.indices), np.intp)
    f[pairs[:, 0]] = pairs[:, 1]
    net, images = mx.place[X.positions[chosen]], my.place[Y.positions[f[chosen]]]
    rows, rng = X.rows[np.ix_(chosen, mx.order)], np.random.default_rng(24)
    found = _better_images(my, net, rows, images, rng, clock.part(SHARE_OF_IMAGES * clock.left))
    if found is None:
        return None
    images, image_rows = found
    chosen = rng.permutation(len(net))[:LANDMARKS]
    own, other = _descriptions(rows[chosen], image_rows[chosen])
    f = _extended(mx, my, own, other, net, images, clock)
    if f is None:
        return None
    covered, sources = np.unique(f, return_index=True)
    g = _extended(my, mx, other, own, covered, sources, clock)
    if g is None:
        return None
    relation = WholeRelation(mx, my, f, g, (len(net), float(rows.min(axis=0).max())))
    for row_x, row_y in zip(rows, image_rows, strict=True):
        relation.know(row_x, row_y)
    return relation


def _better_images(
    Y: EdgeMetric, net: Indices, rows: Floats, images: Indices, rng: np.random.Generator, clock: Clock
) -> tuple[Indices, Floats] | None:
    """Images of the net and their rows: the best of some rounds, in each of which the last ones are landmarks."""
    best, least = None, np.inf
    for _ in range(ROUNDS):
        image_rows = Y.rows(images, clock)
        if image_rows is None:
            break
        value = float(np.abs(rows[:, net] - image_rows[:, images]).max())
        if value < least:
            best, least = (images, image_rows), value
        chosen = rng.permutation(len(net))[:LANDMARKS]
        own, other = _descriptions(rows[np.ix_(chosen, net)], image_rows[chosen])
        images = np.empty(len(net), np.intp)
        for part in np.array_split(np.arange(len(net)), PARTS):
            if clock.over:
                return best
            nearest = np.empty(len(part), np.intp)
            landmark_maps.nearest_rows(own[part], other, nearest)
            images[part] = nearest
    return best


def _descriptions(rows_x: Floats, rows_y: Floats) -> tuple[Singles, Singles]:
    """The distances of all points from landmarks, a row for each point, in single precision and units of a diameter."""
    scale = max(float(rows_x.max()), float(rows_y.max())) or 1.0
    own, other = (np.ascontiguousarray((rows / scale).T, np.float32) for rows in (rows_x, rows_y))
    return own, other


def _extended(
    X: EdgeMetric, Y: EdgeMetric, own: Singles, other: Singles, points: Indices, images: Indices, clock: Clock
) -> Indices | None:
    """Images of all nodes of X, those of some points being known; None if the time is over before."""
    n = len(X)
    found, gaps = np.full(n, -1, np.intp), np.full(n, np.inf, np.float32)
    found[points], gaps[points] = images, ((own[points] - other[images]) ** 4).sum(axis=1)
    parts = [(int(p[0]), int(p[-1])) for p in np.array_split(np.arange(n), min(n, PARTS))]
    for sweep in range(SWEEPS):
        for first, last in parts if sweep % 2 == 0 else [(b, a) for a, b in reversed(parts)]:
            if clock.over:
                return None
            landmark_maps.extend(first, last, own, X.graph[:2], other, Y.graph[:2], found, gaps)
    return None if (found < 0).any() else found
