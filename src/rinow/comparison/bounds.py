"""Lower bounds of the least distortion, twice the Gromov-Hausdorff distance, that need no search."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import linkage
from scipy.spatial.distance import squareform

__all__ = ["diameter_bound", "eccentricity_bound", "packing_bound"]

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
    if len(D) == 1:
        return np.zeros(1)
    heights = linkage(squareform(D, checks=False), "complete")[:, 2]
    return np.append(heights[::-1], 0.0)
