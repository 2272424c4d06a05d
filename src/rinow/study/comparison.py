"""Two shapes compared, as users want to read it: bounds, witnesses, percentiles, units, times."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock
from rinow.comparison.gromov_hausdorff import GromovHausdorff, gromov_hausdorff
from rinow.comparison.hausdorff import HausdorffDistance, hausdorff_distance
from rinow.comparison.lipschitz import LipschitzDistance, infinitely_far, lipschitz_distance
from rinow.comparison.surfaces import geodesics_within
from rinow.errors import InvalidInputError
from rinow.mesh import TriangleMesh
from rinow.metric_space import MetricSpace, as_metric_space

__all__ = ["ComparisonStudy", "Kind", "Metric", "compare_shapes"]

Metric = Literal["hausdorff", "gromov-hausdorff", "lipschitz"]
Kind = Literal["surfaces", "points", "distances"]
Result = HausdorffDistance | GromovHausdorff | LipschitzDistance

PERCENTILES = (0, 25, 50, 75, 95, 100)
MOST_POINTS = 4096
"""Vertices of a mesh that the Lipschitz distance takes: it knows bijections of all points only."""
SHARES = (0.4, 0.7)
"""Shares of the time left for all geodesic distances of the first mesh, and then for those of the second one."""


@dataclass(frozen=True, slots=True)
class ComparisonStudy:
    """The distance of two shapes with what is needed to read it.

    Attributes
    ----------
    metric : {"hausdorff", "gromov-hausdorff", "lipschitz"}
        The distance.
    kind : {"surfaces", "points", "distances"}
        What was compared.
    result : HausdorffDistance, GromovHausdorff or LipschitzDistance
        The interval and its certificates.
    seconds : float
        Wall time.
    unit : str
        Unit of the distance: that of length, or "1" for the Lipschitz distance, a logarithm.
    """

    metric: Metric
    kind: Kind
    result: Result
    seconds: float
    unit: str = "length"

    def record(self) -> dict[str, Any]:
        """The interval and what proves it, in plain types."""
        r = self.result
        head = {"metric": self.metric, "kind": self.kind, "lower": r.lower, "upper": r.upper, "unit": self.unit}
        return {**head, **self._certificates(), "seconds": self.seconds}

    def _certificates(self) -> dict[str, Any]:
        """What proves the bounds: witnesses and percentiles of surfaces, pairs of points of spaces."""
        r = self.result
        if isinstance(r, HausdorffDistance):
            return {
                "witness_a": np.asarray(r.witness_a).tolist(),
                "witness_b": np.asarray(r.witness_b).tolist(),
                "directed_a": r.directed_a,
                "directed_b": r.directed_b,
                "percentile_levels": PERCENTILES,
                "percentiles_a": _percentiles(r.distances_a),
                "percentiles_b": _percentiles(r.distances_b),
            }
        proof = {"lower_bound_by": r.lower_bound_by, "proof_checked": r.proof_checked}
        return {"exact": r.exact, **proof, "pairs": self.pairs().tolist()}

    def pairs(self) -> NDArray[np.intp]:
        """(k, 2): points of A and B that belong together, with which the upper bound is attained."""
        r = self.result
        if isinstance(r, GromovHausdorff):
            return np.asarray(r.correspondence)
        images = r.bijection if isinstance(r, LipschitzDistance) else np.empty(0, np.intp)
        return np.stack([np.arange(len(images)), images], axis=1)


def _percentiles(distances: NDArray[np.float64]) -> dict[str, float]:
    """Percentiles of the distances that are defined."""
    levels = np.percentile(distances[np.isfinite(distances)], PERCENTILES)
    return {str(p): float(level) for p, level in zip(PERCENTILES, levels, strict=True)}


def compare_shapes(
    a: Any,
    b: Any,
    *,
    metric: Metric,
    kind: Kind,
    tolerance: float = 1e-4,
    time_limit: float = 60.0,
    verify: bool = False,
    unit: str = "length",
) -> ComparisonStudy:
    """Compare two meshes, point sets or distance matrices.

    Parameters
    ----------
    a, b
        The shapes, both of one kind: `TriangleMesh`, (n, dimension) points, `MetricSpace` or (n, n) distances.
    metric : {"hausdorff", "gromov-hausdorff", "lipschitz"}
        The distance.
    kind : {"surfaces", "points", "distances"}
        What the shapes are.
    tolerance : float, default 1e-4
        Greatest width of the interval of the Hausdorff distance of surfaces, relative to their diagonal.
    time_limit : float, default 60
        Seconds after which the other two distances stop with the interval reached.  The Lipschitz distance of meshes
        needs all their geodesic distances first; if these take too long, it is refused after a second or two.
    verify : bool, default False
        Have proofs of a clause-learning solver checked, for these two distances.
    unit : str, optional
        Name of the unit of length.

    Returns
    -------
    study : ComparisonStudy
        The distance.

    Raises
    ------
    InvalidInputError
        If the distance is not defined between shapes of this kind, or a mesh has too many vertices for it or for the
        time limit.
    """
    begin, clock = time.perf_counter(), Clock.of(time_limit)
    if metric == "hausdorff":
        if kind == "distances":
            raise InvalidInputError(
                "the Hausdorff distance needs both sets in one space, and two distance matrices are two spaces; "
                "choose --metric gromov-hausdorff."
            )
        result: Result = hausdorff_distance(a, b, tolerance=tolerance)
    elif metric == "gromov-hausdorff":
        X, Y = (shape if kind == "surfaces" else _space(shape, kind, clock) for shape in (a, b))
        result = gromov_hausdorff(X, Y, time_limit=clock.left, verify=verify)
    elif kind == "surfaces" and a.n_vertices != b.n_vertices:  # no need for distances
        result, unit = infinitely_far(), "1"
    else:
        X, Y = (
            _space(shape, kind, clock.part(share * clock.left)) for shape, share in zip((a, b), SHARES, strict=True)
        )
        result, unit = lipschitz_distance(X, Y, time_limit=clock.left, verify=verify), "1"
    return ComparisonStudy(metric, kind, result, time.perf_counter() - begin, unit)


def _space(shape: Any, kind: Kind, clock: Clock) -> MetricSpace:
    """A shape as a finite metric space, a surface in the time of a clock."""
    if kind == "points":
        return MetricSpace.from_points(shape)
    if kind == "distances":
        return as_metric_space(shape)
    if isinstance(shape, TriangleMesh) and shape.n_vertices > MOST_POINTS:
        raise InvalidInputError(
            f"a mesh has {shape.n_vertices:,} vertices, more than the {MOST_POINTS:,} of which the Lipschitz distance "
            "can keep all distances; simplify the meshes to equal numbers of vertices."
        )
    return geodesics_within(shape, clock)
