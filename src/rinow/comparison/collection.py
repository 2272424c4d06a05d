"""Distances between all pairs of a collection of spaces."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._executor import Executor, SerialExecutor
from rinow._printing import OneLine
from rinow.comparison.clock import Clock
from rinow.comparison.correspondence import uniform_distance
from rinow.comparison.gromov_hausdorff import gromov_hausdorff
from rinow.comparison.hausdorff import as_point_set, check_tolerance, hausdorff_distance
from rinow.comparison.lipschitz import lipschitz_distance
from rinow.comparison.surfaces import check_connected
from rinow.errors import InvalidInputError, naming
from rinow.mesh import as_mesh, as_triangle_mesh, is_mesh_like
from rinow.metric_space import as_metric_space, finite_distances

__all__ = ["DistanceMatrix", "distance_matrix"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class DistanceMatrix(OneLine):
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
    tolerance: float = 1e-4,
) -> DistanceMatrix:
    """Distances between all pairs of a collection of metric spaces, or of sets in one space.

    Parameters
    ----------
    spaces : iterable of N spaces
        What the chosen function takes, each checked once: `MetricSpace` or distance matrices, for "gromov_hausdorff"
        also meshes; for "hausdorff" arrays of points, or meshes, all in one Euclidean space.
    metric : {"gromov_hausdorff", "hausdorff", "lipschitz", "uniform"}
        Which distance.
    executor : Executor, optional
        Where the pairs are compared: anything with a ``map`` like that of `concurrent.futures`; a pool of processes
        must be started by "spawn".  By default one pair after the other.
    progress : callable, optional
        Called with the numbers of pairs done and in all after each pair.
    time_limit : float, default 60
        Seconds for each pair; the Hausdorff distance has no limit.
    tolerance : float, default 1e-4
        Greatest ``upper - lower`` of the Hausdorff distance of surfaces, relative to the diagonal.

    Returns
    -------
    result : DistanceMatrix
        `lower` and `upper` of shape (N, N).

    Raises
    ------
    InvalidInputError
        If `metric` is unknown, there is no space, one is not valid, the dimensions differ, the limit is negative or
        `tolerance` not positive, or `executor` or `progress` is none.
    NotAMetricError
        If a matrix is not a metric, or for "gromov_hausdorff" the faces of a mesh are not connected.
    InvalidMeshError
        If a mesh has no face that takes part.

    See Also
    --------
    gromov_hausdorff, hausdorff_distance, lipschitz_distance, uniform_distance

    Examples
    --------
    Segments of length 1, 2 and 4:

    >>> distance_matrix([[[0, a], [a, 0]] for a in (1, 2, 4)]).upper
    array([[0. , 0.5, 1.5],
           [0.5, 0. , 1. ],
           [1.5, 1. , 0. ]])
    """
    try:
        listed = list(spaces)
    except TypeError:
        raise InvalidInputError(f"spaces is of type {type(spaces).__name__}; give a list of spaces.") from None
    if not isinstance(metric, str) or metric not in _METRICS:  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InvalidInputError(f"metric = {metric!r} is unknown; give one of {', '.join(map(repr, _METRICS))}.")
    _check_options(executor, progress, time_limit, tolerance)
    check, compare = _METRICS[metric]
    checked = [check(space, f"spaces[{i}]") for i, space in enumerate(listed)]
    if not checked:
        raise InvalidInputError("spaces is empty; give at least one space.")
    pairs = [(i, j) for i in range(len(checked)) for j in range(i)]
    lower, upper = np.zeros((2, len(checked), len(checked)))
    results = (executor or SerialExecutor()).map(
        compare,
        [checked[i] for i, _ in pairs],
        [checked[j] for _, j in pairs],
        [time_limit] * len(pairs),
        [tolerance] * len(pairs),
    )
    for done, ((i, j), (low, high)) in enumerate(zip(pairs, results, strict=True), start=1):
        lower[i, j] = lower[j, i] = low
        upper[i, j] = upper[j, i] = high
        if progress is not None:
            progress(done, len(pairs))
    return DistanceMatrix(lower, upper)


def _check_options(executor: Any, progress: Any, time_limit: float, tolerance: float) -> None:
    """Refuse options that would fail at the first pair, or at none."""
    Clock.of(time_limit)
    check_tolerance(tolerance)
    if executor is not None and not callable(getattr(executor, "map", None)):
        raise InvalidInputError(f"executor of type {type(executor).__name__} has no map; give a pool.")
    if progress is not None and not callable(progress):
        raise InvalidInputError(f"progress is of type {type(progress).__name__}; give a function of two numbers.")


def _space(value: Any, name: str) -> Any:
    with naming(name):
        space = as_metric_space(value)
        finite_distances(space)
        return space


def _space_or_mesh(value: Any, name: str) -> Any:
    if not is_mesh_like(value):
        return _space(value, name)
    with naming(name):
        mesh = as_mesh(value)
        check_connected(mesh)
        return mesh


def _set(value: Any, name: str) -> Any:
    if not is_mesh_like(value):
        return as_point_set(value, name)
    with naming(name):
        return as_triangle_mesh(value)


def _gromov_hausdorff(X: Any, Y: Any, time_limit: float, tolerance: float) -> tuple[float, float]:
    result = gromov_hausdorff(X, Y, time_limit=time_limit)
    return result.lower, result.upper


def _hausdorff(X: Any, Y: Any, time_limit: float, tolerance: float) -> tuple[float, float]:
    result = hausdorff_distance(X, Y, tolerance=tolerance)
    return result.lower, result.upper


def _lipschitz(X: Any, Y: Any, time_limit: float, tolerance: float) -> tuple[float, float]:
    result = lipschitz_distance(X, Y, time_limit=time_limit)
    return result.lower, result.upper


def _uniform(X: Any, Y: Any, time_limit: float, tolerance: float) -> tuple[float, float]:
    value = uniform_distance(X, Y)
    return value, value


_METRICS: dict[str, tuple[Callable[[Any, str], Any], Callable[[Any, Any, float, float], tuple[float, float]]]] = {
    "gromov_hausdorff": (_space_or_mesh, _gromov_hausdorff),
    "hausdorff": (_set, _hausdorff),
    "lipschitz": (_space, _lipschitz),
    "uniform": (_space, _uniform),
}
