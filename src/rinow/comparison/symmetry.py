"""Isometries of a finite metric space onto itself: images of what is refuted are refuted."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.comparison.clock import Clock

__all__ = ["Isometries", "isometries"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

TOLERANCE = 1e-9
"""Distances of points and images may differ by this share of the diameter: rounding of regular figures."""

LARGEST_NUMBER, LARGEST_EFFORT = 256, 20_000
"""Isometries that are listed, and partial ones that are tried for it; any subset of the group may be used."""


class Isometries(NamedTuple):
    """Some isometries, the identity first, and the largest change of a distance under one of them."""

    images: Indices  # (k, n)
    error: float

    @property
    def trivial(self) -> bool:
        """Whether the identity is the only one."""
        return len(self.images) == 1

    @property
    def transitive(self) -> bool:
        """Whether they take every point to the first one: the space is homogeneous."""
        return bool((self.images == 0).any(axis=0).all())

    def exact(self) -> Isometries:
        """Those that change no distance at all."""
        return self if self.error == 0 else Isometries(self.images[:1], 0.0)

    def representatives(self, fixed: list[int]) -> Indices:
        """Points of which every point is an image under an isometry that leaves the given points in place."""
        images = self.images[(self.images[:, fixed] == fixed).all(axis=1)]
        chosen: list[int] = []
        for x in range(self.images.shape[1]):
            if not np.isin(images[:, x], chosen).any():
                chosen.append(x)
        return np.array(chosen, np.intp)


def isometries(D: Floats, clock: Clock) -> Isometries:
    """Isometries of a space, up to rounding, by backtracking over the points in farthest-point order.

    Those found when the time is over: any subset of the group may be used.
    """
    n = len(D)
    tolerance = TOLERANCE * float(D.max())
    profile = np.sort(D, axis=1)
    order = _farthest_point_order(D)
    found = [np.arange(n)]
    if n > 1:
        _extend(D, profile, order, tolerance, found, clock)
    images = np.array(found, np.intp)
    error = max(float(np.abs(D[np.ix_(f, f)] - D).max()) for f in images)
    return Isometries(images, error)


def _farthest_point_order(D: Floats) -> Indices:
    """All points, each as far as possible from those before it."""
    nearest = np.full(len(D), np.inf)
    order: list[int] = []
    for _ in range(len(D)):
        free = nearest.copy()
        free[order] = -1.0
        order.append(int(free.argmax()))
        np.minimum(nearest, D[order[-1]], out=nearest)
    return np.array(order, np.intp)


def _extend(D: Floats, profile: Floats, order: Indices, tolerance: float, found: list[Indices], clock: Clock) -> None:
    """Depth-first search for the images of the points in order; complete ones are appended to `found`."""
    n, effort = len(D), 0
    image = np.empty(n, np.intp)
    stack = [(0, y) for y in _images(D, profile, order, image, 0, tolerance)[::-1]]
    while stack and len(found) < LARGEST_NUMBER and effort < LARGEST_EFFORT and not clock.over:
        k, y = stack.pop()
        effort += 1
        image[k] = y
        if k + 1 == n:
            isometry = np.empty(n, np.intp)
            isometry[order] = image
            if (isometry != found[0]).any():
                found.append(isometry)
            continue
        stack.extend((k + 1, z) for z in _images(D, profile, order, image, k + 1, tolerance)[::-1])


def _images(D: Floats, profile: Floats, order: Indices, image: Indices, k: int, tolerance: float) -> Indices:
    """Points that may be the image of point k of the order, given those of the points before it."""
    x = order[k]
    fits = np.abs(D[image[:k]] - D[order[:k], x][:, None]).max(axis=0, initial=0.0) <= tolerance
    fits[image[:k]] = False
    candidates = np.flatnonzero(fits)
    return candidates[np.abs(profile[candidates] - profile[x]).max(axis=1) <= tolerance]
