"""Distances between all pairs of a collection of spaces."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._executor import Executor, SerialExecutor
from rinow.comparison.correspondence import uniform_distance
from rinow.comparison.gromov_hausdorff import gromov_hausdorff
from rinow.comparison.lipschitz import lipschitz_distance
from rinow.errors import InvalidInputError
from rinow.metric_space import as_metric_space

__all__ = ["DistanceMatrix", "distance_matrix"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class DistanceMatrix:
    """Bounds of the distances between N spaces.

    Attributes
    ----------
    lower, upper : (N, N) ndarray of float
        Symmetric, 0 on the diagonal; equal where the distance is exact.
    """

    lower: Floats
    upper: Floats


def distance_matrix(
    spaces: Iterable[Any],
    *,
    metric: str = "gromov_hausdorff",
    executor: Executor | None = None,
    progress: Callable[[int, int], None] | None = None,
    time_limit: float = 60.0,
) -> DistanceMatrix:
    """Distances between all pairs of a collection of metric spaces.

    Parameters
    ----------
    spaces : iterable of N spaces
        What the chosen function takes: `MetricSpace` or distance matrices, each checked once.
    metric : {"gromov_hausdorff", "lipschitz", "uniform"}
        Which distance.
    executor : Executor, optional
        Where the pairs are compared: anything with a ``map`` like that of `concurrent.futures`; a pool of processes
        must be started by "spawn".  By default one pair after the other.
    progress : callable, optional
        Called with the numbers of pairs done and in all after each pair.
    time_limit : float, default 60
        Seconds for each pair.

    Returns
    -------
    result : DistanceMatrix
        `lower` and `upper` of shape (N, N).

    Raises
    ------
    InvalidInputError
        If `metric` is unknown, there is no space, or one is not valid.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    gromov_hausdorff, lipschitz_distance, uniform_distance

    Examples
    --------
    Segments of length 1, 2 and 4:

    >>> distance_matrix([[[0, a], [a, 0]] for a in (1, 2, 4)]).upper
    array([[0. , 0.5, 1.5],
           [0.5, 0. , 1. ],
           [1.5, 1. , 0. ]])
    """
    if metric not in _METRICS:
        raise InvalidInputError(f"metric = {metric!r} is unknown; give one of {', '.join(map(repr, _METRICS))}.")
    checked = [as_metric_space(space) for space in spaces]
    if not checked:
        raise InvalidInputError("spaces is empty; give at least one space.")
    pairs = [(i, j) for i in range(len(checked)) for j in range(i)]
    lower, upper = np.zeros((2, len(checked), len(checked)))
    results = (executor or SerialExecutor()).map(
        _METRICS[metric], [checked[i] for i, _ in pairs], [checked[j] for _, j in pairs], [time_limit] * len(pairs)
    )
    for done, ((i, j), (low, high)) in enumerate(zip(pairs, results, strict=True), start=1):
        lower[i, j] = lower[j, i] = low
        upper[i, j] = upper[j, i] = high
        if progress is not None:
            progress(done, len(pairs))
    return DistanceMatrix(lower, upper)


def _gromov_hausdorff(X: Any, Y: Any, time_limit: float) -> tuple[float, float]:
    result = gromov_hausdorff(X, Y, time_limit=time_limit)
    return result.lower, result.upper


def _lipschitz(X: Any, Y: Any, time_limit: float) -> tuple[float, float]:
    result = lipschitz_distance(X, Y, time_limit=time_limit)
    return result.lower, result.upper


def _uniform(X: Any, Y: Any, time_limit: float) -> tuple[float, float]:
    value = uniform_distance(X, Y)
    return value, value


_METRICS: dict[str, Callable[[Any, Any, float], tuple[float, float]]] = {
    "gromov_hausdorff": _gromov_hausdorff,
    "lipschitz": _lipschitz,
    "uniform": _uniform,
}
