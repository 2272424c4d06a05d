"""What a method says about the vertices of a mesh, before statuses are applied."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Estimate"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Estimate:
    """Values at every vertex, nan where undefined; None for what a method cannot know from its data.

    Attributes
    ----------
    gaussian, spread, radius : (n_vertices,) ndarray of float
        Gaussian curvature, its standard error, and the scale it was taken from.
    mean, k1, k2 : (n_vertices,) ndarray of float or None
        Mean and principal curvatures.
    direction1, direction2 : (n_vertices, 3) ndarray of float or None
        Unit principal directions.
    """

    gaussian: Floats
    spread: Floats
    radius: Floats
    mean: Floats | None = None
    k1: Floats | None = None
    k2: Floats | None = None
    direction1: Floats | None = None
    direction2: Floats | None = None
