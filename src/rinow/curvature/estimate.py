"""What a method says about the vertices of a mesh, before statuses are applied."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["Estimate", "undefined"]

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
    noise, spacing : (n_vertices,) ndarray of float or None
        Standard deviation of the positions from a smooth surface, and the distance of neighbours.
    risk : (n_vertices,) ndarray of float or None
        Squared error of the Gaussian curvature expected by the choice of scale and order, by which estimates are
        weighted.  The spread holds more: what that choice does not see.
    height, first_mean : (n_vertices,) ndarray of float or None
        Heights of the vertices over the surfaces fitted first, and the mean curvatures of these, whether or not smaller
        ones took their place.
    left_out, has_steps : (n_vertices,) ndarray of bool or None
        The vertex took no part and has the values of a neighbour; there are low steps, which were taken for noise.
    """

    gaussian: Floats
    spread: Floats
    radius: Floats
    mean: Floats | None = None
    k1: Floats | None = None
    k2: Floats | None = None
    direction1: Floats | None = None
    direction2: Floats | None = None
    noise: Floats | None = None
    spacing: Floats | None = None
    risk: Floats | None = None
    height: Floats | None = None
    first_mean: Floats | None = None
    left_out: NDArray[np.bool_] | None = None
    has_steps: NDArray[np.bool_] | None = None

    def with_gaussian(self, gaussian: Floats, spread: Floats) -> Estimate:
        """The same with another Gaussian curvature: k1 and k2 have it as their product.

        To first order they take the shortest step there, so that H moves by H ΔK / (k1² + k2²).
        """
        if self.mean is None:
            return replace(self, gaussian=gaussian, spread=spread)
        squares = 4.0 * self.mean * self.mean - 2.0 * self.gaussian
        step = gaussian - self.gaussian
        share = np.divide(step, squares, out=np.zeros_like(step), where=np.abs(step) < squares)
        mean = self.mean * (1.0 + share)
        half = np.sqrt(np.maximum(mean * mean - gaussian, 0.0))
        return replace(self, gaussian=gaussian, spread=spread, mean=mean, k1=mean + half, k2=mean - half)

    def with_steps(self, has_steps: NDArray[np.bool_]) -> Estimate:
        """The same with steps at more vertices, if at any."""
        if not has_steps.any():
            return self
        return replace(self, has_steps=has_steps if self.has_steps is None else self.has_steps | has_steps)

    def at(self, vertices: NDArray[np.intp]) -> Estimate:
        """The values at some vertices, in their order."""
        values: dict[str, Any] = {field.name: getattr(self, field.name) for field in fields(self)}
        return replace(self, **{name: x[vertices] for name, x in values.items() if x is not None})

    def fill(self, vertices: NDArray[np.intp], other: Estimate) -> None:
        """Give some vertices the values of another estimate, in their order."""
        for name in (field.name for field in fields(self)):
            ours, theirs = getattr(self, name), getattr(other, name)
            if ours is not None and theirs is not None:
                ours[vertices] = theirs

    def put(self, vertices: NDArray[np.intp], origins: NDArray[np.intp]) -> None:
        """Give some vertices the values of others."""
        if len(vertices):
            for value in (getattr(self, field.name) for field in fields(self)):
                if value is not None:
                    value[vertices] = value[origins]


def undefined(n_vertices: int) -> Estimate:
    """An estimate of everything with nan everywhere."""
    width = {"direction1": (3,), "direction2": (3,)}
    names = [field.name for field in fields(Estimate) if field.name not in ("left_out", "has_steps")]
    values: dict[str, Any] = {name: np.full((n_vertices, *width.get(name, ())), np.nan) for name in names}
    return Estimate(**values)
