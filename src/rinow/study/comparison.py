"""Two shapes compared, as users want to read it: bounds, witnesses, percentiles, units, times."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.hausdorff import HausdorffDistance, hausdorff_distance
from rinow.errors import InvalidInputError

__all__ = ["ComparisonStudy", "compare_shapes"]

Metric = Literal["hausdorff", "gromov-hausdorff", "lipschitz"]
Kind = Literal["surfaces", "points", "distances"]

PERCENTILES = (0, 25, 50, 75, 95, 100)


@dataclass(frozen=True, slots=True)
class ComparisonStudy:
    """The distance of two shapes with what is needed to read it.

    Attributes
    ----------
    metric : str
        Name of the distance.
    kind : str
        What was compared: surfaces, points or distances.
    result : HausdorffDistance
        The interval and its witnesses.
    seconds : float
        Wall time.
    unit : str
        Name of the unit of length; "length" when nobody said.
    """

    metric: Metric
    kind: Kind
    result: HausdorffDistance
    seconds: float
    unit: str = "length"

    def record(self) -> dict[str, Any]:
        """Everything but the distances of single points, in plain types."""
        r = self.result
        values: dict[str, Any] = {
            "lower": r.lower,
            "upper": r.upper,
            "unit": self.unit,
            "witness_a": np.asarray(r.witness_a).tolist(),
            "witness_b": np.asarray(r.witness_b).tolist(),
            "directed_a": r.directed_a,
            "directed_b": r.directed_b,
            "percentile_levels": PERCENTILES,
            "percentiles_a": _percentiles(r.distances_a),
            "percentiles_b": _percentiles(r.distances_b),
        }
        return {"metric": self.metric, "kind": self.kind, **values, "seconds": self.seconds}


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
    unit: str = "length",
) -> ComparisonStudy:
    """Compare two meshes, point sets or distance matrices.

    Parameters
    ----------
    a, b
        The shapes, both of one kind.
    metric : {"hausdorff", "gromov-hausdorff", "lipschitz"}
        The distance.
    kind : {"surfaces", "points", "distances"}
        What the shapes are.
    tolerance : float, default 1e-4
        Greatest width of the interval between surfaces, relative to their diagonal.
    time_limit : float, default 60
        Seconds after which the other two distances stop with the interval reached.
    unit : str, optional
        Name of the unit of length.

    Returns
    -------
    study : ComparisonStudy
        The distance.

    Raises
    ------
    InvalidInputError
        If the distance is not defined between shapes of this kind.
    """
    begin = time.perf_counter()
    if kind == "distances":
        raise InvalidInputError(
            "the Hausdorff distance needs both sets in one space, and two distance matrices are two spaces; "
            "choose --metric gromov-hausdorff."
        )
    result = hausdorff_distance(a, b, tolerance=tolerance)
    return ComparisonStudy(metric, kind, result, time.perf_counter() - begin, unit)
