"""Length spaces, seen through finitely many points: midpoints, their defect, and lengths of chains."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array

from rinow._arrays import as_index, as_number
from rinow.errors import InvalidInputError
from rinow.kernels.midpoints import worst_midpoint_defects
from rinow.metric_space import MetricSpace, as_metric_space, finite_distances

__all__ = ["as_step", "intrinsic_metric", "length_defect", "midpoints", "step_graph"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]


def midpoints(space: Any, x: int, y: int, *, epsilon: float) -> Indices:
    r"""The ε-midpoints of two points.

    Parameters
    ----------
    space : MetricSpace or (n_points, n_points) array_like of float
        The metric space.
    x, y : int
        Two of its points.
    epsilon : float
        The defect allowed, not negative, in the unit of length.

    Returns
    -------
    points : (k,) ndarray of intp
        The points z with :math:`|2 d(x, z) - d(x, y)| \le ε` and :math:`|2 d(z, y) - d(x, y)| \le ε`, ascending;
        perhaps none.  With ε = 0 these are the midpoints, d(x, z) = d(z, y) = d(x, y)/2.

    Raises
    ------
    InvalidInputError
        If `x` or `y` is out of range, or `epsilon` is negative or nan.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    length_defect : The least ε for which all pairs have one.

    Notes
    -----
    Definition 2.47 (3) of the paper.  Its part (1) asks of a midpoint only that d(x, z) = d(z, y); the value d(x, y)/2
    is missing there.

    Examples
    --------
    >>> line = abs(np.arange(6.0)[:, None] - np.arange(6.0))
    >>> midpoints(line, 0, 4, epsilon=0.0), midpoints(line, 0, 5, epsilon=1.0)
    (array([2]), array([2, 3]))
    """
    D = finite_distances(space)
    i, j = as_index(x, len(D), "x"), as_index(y, len(D), "y")
    if not as_number(epsilon, "epsilon") >= 0.0:
        raise InvalidInputError(f"epsilon = {epsilon} is not a defect; give a number that is not negative.")
    defects = np.maximum(np.abs(2.0 * D[i] - D[i, j]), np.abs(2.0 * D[j] - D[i, j]))
    return np.flatnonzero(defects <= epsilon)


def length_defect(space: Any) -> float:
    r"""Least ε for which every two points of a finite space have an ε-midpoint.

    It is 0 in a compact length space, and at most 2 δ on a δ-net of one: the space looks like a length space at scales
    well above its defect.

    Parameters
    ----------
    space : MetricSpace or (n_points, n_points) array_like of float
        The metric space; its distances are finite.

    Returns
    -------
    defect : float
        :math:`\max_{x,y} \min_z \max(|2 d(x, z) - d(x, y)|, |2 d(z, y) - d(x, y)|)` in the unit of length: the
        distance itself for two points, 0 for one.

    Raises
    ------
    InvalidInputError
        If a distance is infinite.
    NotAMetricError
        If a matrix is not a metric.

    See Also
    --------
    midpoints : The ε-midpoints of two points.

    Notes
    -----
    Midpoints characterise complete *strictly* intrinsic metrics; Proposition 2.49 of the paper says intrinsic, but in
    the punctured plane x and -x have ε-midpoints only.  A Gromov-Hausdorff limit inherits the defects (Theorem 2.50):
    a correspondence with distortion r changes the defect by at most 3 r.  The cost is O(n³).

    Examples
    --------
    Points 0, 1, ..., 5 of a line: the neighbours have nothing in between.

    >>> length_defect(abs(np.arange(6.0)[:, None] - np.arange(6.0)))
    1.0
    """
    D = finite_distances(space)
    worst = np.empty(len(D))
    worst_midpoint_defects(D, worst)
    return float(worst.max())


def intrinsic_metric(
    space: Any, step: float, *, indices: ArrayLike | None = None, infinite: bool = False
) -> MetricSpace:
    """Intrinsic metric of a subset: the length of the shortest chain of its points with small steps.

    Parameters
    ----------
    space : MetricSpace or (n_points, n_points) array_like of float
        The metric space.
    step : float
        Steps are shorter than this, positive, in the unit of length.
    indices : (k,) array_like of int, optional
        The subset, all points by default.
    infinite : bool, default False
        Allow the distance inf between points that no chain joins.

    Returns
    -------
    intrinsic : MetricSpace
        The subset in the order of `indices`; no distance is less than in `space`.

    Raises
    ------
    InvalidInputError
        If `indices` is empty or out of range, or `step` is not positive.
    NotAMetricError
        If `space` is not a metric, or no chain joins two points and `infinite` is false.

    See Also
    --------
    rinow.epsilon_graph : The graph of the steps.

    Notes
    -----
    For ever denser points of a compact subset and steps that shrink more slowly than the gaps, the distances tend to
    those of the induced length metric.

    Examples
    --------
    The circle in the plane: chords become arcs.

    >>> t = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    >>> circle = MetricSpace.from_points(np.stack([np.cos(t), np.sin(t)], axis=1))
    >>> print(f"{circle.diameter:.4f} {intrinsic_metric(circle, 0.1).diameter:.4f}")
    2.0000 3.1411
    """
    whole = as_metric_space(space)
    subset = whole if indices is None else whole.subspace(indices)
    return MetricSpace.from_graph(step_graph(subset.distances, as_step(step, "step")), infinite=infinite)


def as_step(step: float, name: str) -> float:
    """A positive length."""
    if not as_number(step, name) > 0.0:
        raise InvalidInputError(f"{name} = {step} is not a length; give a positive number.")
    return float(step)


def step_graph(D: Floats, step: float) -> csr_array:
    """The pairs at distances below a step, each both ways, weighted by the distance; zeros are stored."""
    near = D < step
    np.fill_diagonal(near, False)
    i, j = np.nonzero(near)
    return csr_array((D[i, j], (i, j)), shape=D.shape)
