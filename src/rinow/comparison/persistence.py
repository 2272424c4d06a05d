"""Lower bounds of the least distortion by persistent homology: holes that one space has and the other one lacks.

The Vietoris-Rips complex at scale t has the simplices of diameter at most t.  A hole of it lives from a birth b to a
death d.  If two spaces have a correspondence of distortion δ, their holes of one dimension can be paired so that births
and deaths differ by at most δ, where holes with d - b <= 2δ may stay alone: the bottleneck distance of the two diagrams
is at most δ = 2 d_GH (Chazal, Cohen-Steiner, Guibas, Mémoli, Oudot 2009; Chazal, de Silva, Oudot 2014, Theorem 5.2).

GUDHI (the extra `persistence`) computes births and deaths; they are distances, exactly.  Its `bottleneck_distance` is
not used: for some diagrams of a few points it gives too much (version 3.13), and a bound above the distance.
"""

from __future__ import annotations

import importlib.util

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.bounds import matching_bound
from rinow.comparison.clock import Clock
from rinow.comparison.interval import Interval
from rinow.comparison.large_work import farthest_points

__all__ = ["bottleneck_bound", "diagram", "gudhi_installed", "persistence_bound", "raise_by_persistence"]

Floats = NDArray[np.float64]

NETS = {1: 100, 2: 48}
"""Dimension of the holes, and farthest points of each space between which they are sought: some tenths of a second."""

SECONDS = 1.0
"""Time that must be left: GUDHI cannot be interrupted."""


def gudhi_installed() -> bool:
    """Whether GUDHI can be imported."""
    return importlib.util.find_spec("gudhi") is not None


def raise_by_persistence(DX: Floats, DY: Floats, interval: Interval, clock: Clock) -> None:
    """Raise the lower bound where GUDHI is installed and there is time for it."""
    for dimension in NETS:
        if interval.closed or clock.left < SECONDS or not gudhi_installed():
            return
        interval.raise_lower(persistence_bound(DX, DY, dimension, interval.lower), "persistence")


def persistence_bound(DX: Floats, DY: Floats, dimension: int, lower: float = 0.0) -> float:
    """Lower bound of the least distortion by holes of a dimension; 0 where it cannot be above `lower`.

    Of larger spaces nets are looked at, whose distance differs by the larger covering radius at most.  No hole outlives
    the radius of the space: from there on the complex is a cone.
    """
    nets = [farthest_points(D, NETS[dimension]) for D in (DX, DY)]
    loss = 2.0 * max(float(D[net].min(axis=0).max()) for D, net in zip((DX, DY), nets, strict=True))
    A, B = (D[np.ix_(net, net)] for D, net in zip((DX, DY), nets, strict=True))
    if 0.5 * max(A.max(axis=1).min(), B.max(axis=1).min()) - loss <= lower:
        return 0.0
    value = bottleneck_bound(diagram(A, dimension), diagram(B, dimension))
    return value if loss == 0.0 else max(value - loss - 4.0 * float(np.spacing(value + loss)), 0.0)


def diagram(D: Floats, dimension: int) -> Floats:
    """Birth and death of the holes of a dimension from 1 on, (n_holes, 2); all die, and births differ from deaths.

    Collapsing edges first changes no diagram (Boissonnat, Pritam 2020).  Simplices of one dimension more are needed.
    """
    import gudhi  # an extra; the import takes long

    tree = gudhi.RipsComplex(distance_matrix=D).create_simplex_tree(max_dimension=1)
    tree.collapse_edges()
    tree.expansion(dimension + 1)
    tree.compute_persistence()
    return np.asarray(tree.persistence_intervals_in_dimension(dimension), dtype=np.float64).reshape(-1, 2)


def bottleneck_bound(a: Floats, b: Floats) -> float:
    """Bottleneck distance of two diagrams, without rounding beyond that of differences.

    Least level at which all points of either diagram have partners, or a distance from the diagonal, within it: two
    such matchings, one for each, contain one for both (Mendelsohn, Dulmage 1958).
    """
    costs = np.abs(a[:, None] - b).max(axis=2, initial=0.0)
    return max(_one_sided(costs, a), _one_sided(costs.T, b))


def _one_sided(costs: Floats, points: Floats) -> float:
    """Least level at which every point has a partner of its own, or is that near to the diagonal."""
    if not len(points):
        return 0.0
    alone = np.full((len(points), len(points)), np.inf)
    np.fill_diagonal(alone, 0.5 * (points[:, 1] - points[:, 0]))
    return matching_bound(np.hstack([costs, alone]))
