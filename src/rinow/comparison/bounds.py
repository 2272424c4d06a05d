"""Lower bounds of the least distortion, twice the Gromov-Hausdorff distance, that need no search."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import linkage
from scipy.sparse import csr_array
from scipy.sparse.csgraph import maximum_bipartite_matching
from scipy.spatial.distance import squareform

from rinow.comparison.clock import Clock

__all__ = ["diameter_bound", "eccentricity_bound", "matching_bound", "packing_bound", "single_linkage_bound"]

Floats = NDArray[np.float64]


def diameter_bound(DX: Floats, DY: Floats) -> float:
    """Difference of the diameters: the ends of the longer one have partners at most as far apart as the other one."""
    return float(abs(DX.max() - DY.max()))


def eccentricity_bound(DX: Floats, DY: Floats) -> float:
    """Hausdorff distance of the two sets of eccentricities: partners x, y have |ecc(x) - ecc(y)| <= dis R.

    It contains the bounds by diameter and by radius.
    """
    a, b = np.unique(DX.max(axis=1)), np.unique(DY.max(axis=1))
    return max(_one_sided(a, b), _one_sided(b, a))


def _one_sided(a: Floats, b: Floats) -> float:
    """Largest distance of a number of the ascending list a from the ascending list b."""
    place = np.searchsorted(b, a)
    below, above = b[np.maximum(place - 1, 0)], b[np.minimum(place, len(b) - 1)]
    return float(np.minimum(np.abs(a - below), np.abs(above - a)).max())


def packing_bound(DX: Floats, DY: Floats) -> float:
    """Pigeonhole: of k points of X at mutual distance s, two have partners in one of k - 1 sets that cover Y.

    So the distortion is at least s minus the largest diameter of these sets.  The points are a farthest-point sequence,
    the sets those of complete linkage, for every k, and both ways round.
    """
    return max(_pigeonhole(DX, DY), _pigeonhole(DY, DX))


def _pigeonhole(DX: Floats, DY: Floats) -> float:
    separations, diameters = _separations(DX, len(DY) + 1), _cover_diameters(DY)
    return float((separations - diameters[: len(separations)]).max(initial=0.0))


def _separations(D: Floats, k_max: int) -> Floats:
    """Least distance among the first 2, 3, ..., k_max points of a farthest-point sequence from a diameter on."""
    nearest = D[D.max(axis=1).argmax()].copy()
    out = np.empty(min(len(D), k_max) - 1)
    for k in range(len(out)):
        far = int(nearest.argmax())
        out[k] = nearest[far]
        np.minimum(nearest, D[far], out=nearest)
    return out


def _cover_diameters(D: Floats) -> Floats:
    """Largest diameter of the clusters when complete linkage has left 1, 2, ..., n of them."""
    return np.append(_merges(D, "complete"), 0.0)


def single_linkage_bound(DX: Floats, DY: Floats) -> float:
    """Largest difference of the merge heights of single linkage, from the highest on, filled up with zeros.

    Points that steps of at most t join have partners that steps of at most t + dis R join.  So Y has at most as many
    clusters at t + dis R as X has at t, and conversely (Carlsson, Mémoli 2010).  The heights are the deaths in
    persistent homology of dimension 0, whose bottleneck distance is at most this bound and may be half of it.
    """
    a, b = _merges(DX, "single"), _merges(DY, "single")
    k = max(len(a), len(b))
    return float(np.abs(np.pad(a, (0, k - len(a))) - np.pad(b, (0, k - len(b)))).max(initial=0.0))


def _merges(D: Floats, method: str) -> Floats:
    """The heights at which clusters merge, descending."""
    if len(D) == 1:
        return np.zeros(0)
    return np.sort(linkage(squareform(D, checks=False), method)[:, 2])[::-1]


def matching_bound(levels: Floats, clock: Clock | None = None) -> float:
    """Least level at which a perfect matching exists among the pairs (x, y) with levels[x, y] at most that.

    All x must be matched, and there are as many y, or more.  When the time is over, the least level that is not
    excluded yet.  Each point needs a partner: levels at which one has none, whose matchings take longest, are left out.
    """
    values = np.unique(levels)
    partners = max(float(levels.min(axis=k).max()) for k in ((0, 1) if len(levels) == levels.shape[1] else (1,)))
    low, high = int(np.searchsorted(values, partners)), len(values) - 1
    while low < high and not (clock and clock.over):
        middle = (low + high) // 2
        matched = maximum_bipartite_matching(csr_array(levels <= values[middle]), perm_type="column")
        low, high = (low, middle) if (matched >= 0).all() else (middle + 1, high)
    return float(values[low])
