"""The singular points of one surface as users want to read them: counts, angles, fields for files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.repairs import repaired
from rinow.curvature.singular import SingularFeatures, singular_features
from rinow.mesh import TriangleMesh

__all__ = ["FIELDS", "FeatureStudy", "study_features"]

Floats = NDArray[np.float64]

FIELDS: Mapping[str, str] = {
    "feature": "kind of the vertex: 0 smooth, 1 on a crease, 2 corner, 3 cone point off the creases",
    "crease_angle": "mean angle of the creases at the vertex, unit radian, convex is positive, 0 off creases",
    "cone_angle": "total angle at a cone point, unit radian, nan elsewhere",
}
"""Fields at vertices that files get, in words."""


@dataclass(frozen=True, slots=True)
class FeatureStudy:
    """Singular points of a surface with what is needed to read them.

    Attributes
    ----------
    mesh : TriangleMesh
        The surface, unchanged.
    features : SingularFeatures
        What was found.
    names : (n_vertices,) ndarray of intp
        For each vertex the first one at its place, by which features are named.
    """

    mesh: TriangleMesh
    features: SingularFeatures
    names: NDArray[np.intp]

    @property
    def notes(self) -> tuple[str, ...]:
        """What the reader and the method had to do, one sentence each."""
        return (*self.mesh.notes, *self.features.notes)

    @property
    def crease_length(self) -> float:
        """Length of all creases."""
        ends = self.mesh.vertices[self.features.crease_edges]
        return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())

    def counts(self) -> dict[str, int]:
        """Number of features of each kind."""
        f = self.features
        return {"cone_points": len(f.cone_points), "crease_edges": len(f.crease_edges), "corners": len(f.corners)}

    def table(self) -> dict[str, tuple[int, list[float]]]:
        """Number of each kind, and least, median and greatest angle in degrees."""
        f = self.features
        angles = {"cone points": f.cone_angles, "crease edges": f.crease_angles, "corners": np.empty(0)}
        counts = self.counts().values()
        return {
            name: (n, np.degrees(np.percentile(a, (0, 50, 100))).tolist() if len(a) else [])
            for n, (name, a) in zip(counts, angles.items(), strict=True)
        }

    def vertex_data(self) -> dict[str, NDArray[Any]]:
        """The fields of `FIELDS`."""
        f, n = self.features, self.mesh.n_vertices
        ends = f.crease_edges.ravel()
        at_vertex = np.bincount(ends, minlength=n)
        sums = np.bincount(ends, np.repeat(f.crease_angles, 2), minlength=n)
        kind = np.zeros(n, np.uint8)
        kind[f.cone_points] = 3
        kind[at_vertex > 0] = 1
        kind[f.corners] = 2
        cone = np.full(n, np.nan)
        cone[f.cone_points] = f.cone_angles
        data = {"feature": kind, "crease_angle": sums / np.maximum(at_vertex, 1), "cone_angle": cone}
        return {name: values[self.names] for name, values in data.items()}


def study_features(mesh: TriangleMesh) -> FeatureStudy:
    """Find the singular points of a surface.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.

    Returns
    -------
    study : FeatureStudy
        The features and what is needed to read them.
    """
    index = repaired(mesh)[1]
    names = np.arange(mesh.n_vertices) if index is None else np.unique(index, return_index=True)[1][index]
    return FeatureStudy(mesh, singular_features(mesh), names)
