"""The curvature at the points of a metric space as users want to read it."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from rinow.curvature.metric_space import metric_space_curvature
from rinow.curvature.surface import SurfaceCurvature
from rinow.metric_space import MetricSpace
from rinow.study.surface import CurvatureStudy, field_unit

__all__ = ["SpaceStudy", "study_space"]


@dataclass(frozen=True, slots=True)
class SpaceStudy(CurvatureStudy):
    """Curvature at the points of a metric space, with the names of surfaces: `gaussian`, `spread`, `status`."""

    place: ClassVar[str] = "point"
    places: ClassVar[str] = "points"

    def units(self) -> dict[str, str]:
        """Name and unit of each field, in words."""
        text = {name: words.replace("vertex", "point") for name, words in super(SpaceStudy, self).units().items()}
        return {**text, "gaussian": f"curvature K, unit {field_unit('gaussian', self.unit)}, positive as on a sphere"}


def study_space(space: MetricSpace, *, radius: float | None = None, unit: str = "length") -> SpaceStudy:
    """Compute the curvature at the points of a metric space and time it.

    Parameters
    ----------
    space : MetricSpace
        The points.
    radius : float, optional
        As for `rinow.metric_space_curvature`.
    unit : str, optional
        Name of the unit of length of the distances.

    Returns
    -------
    study : SpaceStudy
        The curvature and what is needed to read it.
    """
    start = time.perf_counter()
    found = metric_space_curvature(space, radius=radius)
    unknown, directions = np.full(len(space), np.nan), np.full((len(space), 3), np.nan)
    curvature = SurfaceCurvature(
        gaussian=found.value,
        mean=unknown,
        k1=unknown,
        k2=unknown,
        shape_index=unknown,
        curvedness=unknown,
        direction1=directions,
        direction2=directions,
        status=found.status,
        radius=found.radius,
        spread=found.standard_error,
        method="metric_space",
    )
    return SpaceStudy(curvature, unit, {"curvature": time.perf_counter() - start}, {"radius": radius})
