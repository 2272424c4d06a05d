"""The curvature of one surface as users want to read it: counts, values, units, percentiles, times."""

from __future__ import annotations

import time
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.status import VertexStatus
from rinow.curvature.surface import SurfaceCurvature, surface_curvature
from rinow.mesh import TriangleMesh

__all__ = ["FIELDS", "SIGNED", "STATUSES", "CurvatureStudy", "SurfaceStudy", "mesh_counts", "study_surface"]

Floats = NDArray[np.float64]

FIELDS: Mapping[str, tuple[str, int]] = {
    "gaussian": ("Gaussian curvature K", -2),
    "mean": ("mean curvature H", -1),
    "k1": ("larger principal curvature k1", -1),
    "k2": ("smaller principal curvature k2", -1),
    "shape_index": ("shape index", 0),
    "curvedness": ("curvedness", -1),
    "spread": ("standard error of K", -2),
    "radius": ("radius used", 1),
}
"""Scalar fields of a curvature result: name in words and power of the unit of length."""

SIGNED = ("gaussian", "mean", "k1", "k2", "shape_index")
"""Fields whose sign tells convex from concave; the others are never negative."""
STATUSES: Mapping[str, str] = {
    "OK": "the value is defined and finite",
    "BOUNDARY": "a one-sided estimate at a boundary or crease, or nan where the method has none",
    "ISOLATED": "nan: no face has the vertex",
    "DEGENERATE": "nan: every face around the vertex is degenerate",
    "NONMANIFOLD": "the faces around the vertex are not one fan; a value where the method has one",
    "NONFINITE": "nan: the position is nan or inf",
    "UNRESOLVED": "nan: the data around the vertex determine no value",
}
"""What each name of `VertexStatus` means, in the order of the codes."""

PERCENTILES = (0, 2, 25, 50, 75, 98, 100)
SIGN = "convex with outward normal is positive; mean curvature is (k1 + k2)/2"
_SUPERSCRIPT = {-2: "1/{}²", -1: "1/{}", 0: "1", 1: "{}"}


def field_unit(name: str, unit: str) -> str:
    """Unit of a field when lengths are measured in `unit`."""
    return _SUPERSCRIPT[FIELDS[name][1]].format(unit)


@dataclass(frozen=True, slots=True)
class CurvatureStudy:
    """Curvature with what is needed to read it.

    Attributes
    ----------
    curvature : SurfaceCurvature
        Values in the order of the vertices or points.
    unit : str
        Name of the unit of length; "length" when nobody said.
    seconds : dict of str to float
        Wall time of each step.
    settings : dict of str to str or float or None
        What was asked for: method, quality, radius (None: the choice of the method).
    """

    curvature: SurfaceCurvature
    unit: str = "length"
    seconds: dict[str, float] = field(default_factory=dict)
    settings: dict[str, str | float | None] = field(default_factory=dict)
    place: ClassVar[str] = "vertex"
    places: ClassVar[str] = "vertices"

    @property
    def positions(self) -> Floats:
        """(n, 3): where the values are."""
        raise NotImplementedError

    @property
    def areas(self) -> Floats:
        """(n,): area of the surface that each value stands for; 0 at positions that are not finite."""
        raise NotImplementedError

    @contextmanager
    def timed(self, step: str) -> Generator[None]:
        """Record the wall time of a step under its name."""
        start = time.perf_counter()
        yield
        self.seconds[step] = self.seconds.get(step, 0.0) + time.perf_counter() - start

    @property
    def notes(self) -> tuple[str, ...]:
        """What the reader and the method had to do, one sentence each."""
        return self.curvature.notes

    def fields(self, chosen: str = "gaussian") -> dict[str, Floats]:
        """The Gaussian curvature, the chosen field and those that hold any value, in the order of `FIELDS`."""
        values = {name: np.asarray(getattr(self.curvature, name)) for name in FIELDS}
        return {name: v for name, v in values.items() if name in ("gaussian", chosen) or np.isfinite(v).any()}

    def vertex_data(self, chosen: str = "gaussian") -> dict[str, NDArray[Any]]:
        """All fields for a file: the scalars, directions where there are any, and the status."""
        data: dict[str, NDArray[Any]] = dict(self.fields(chosen))
        for name in ("direction1", "direction2"):
            directions = getattr(self.curvature, name)
            if np.isfinite(directions).any():
                data[name] = directions
        return {**data, "status": self.curvature.status}

    def units(self) -> dict[str, str]:
        """Name, unit and sign of each field, in words."""
        text = {name: f"{FIELDS[name][0]}, unit {field_unit(name, self.unit)}" for name in FIELDS}
        codes = ", ".join(f"{s.value} {s.name}" for s in VertexStatus)
        signed = {name: f"{text[name]}, {SIGN}" for name in SIGNED}
        directions = {f"direction{i}": f"unit direction of k{i}" for i in (1, 2)}
        return {**text, **signed, **directions, "status": f"status of the vertex: {codes}"}

    def status_counts(self) -> dict[str, int]:
        """Number of vertices with each status that occurs."""
        counts = np.bincount(self.curvature.status, minlength=len(VertexStatus))
        return {s.name: int(counts[s.value]) for s in VertexStatus if counts[s.value]}

    def percentiles(self) -> dict[str, dict[str, float]]:
        """Percentiles of the finite values of each field."""
        table = {}
        for name, values in self.fields().items():
            finite = values[np.isfinite(values)]
            levels = np.percentile(finite, PERCENTILES) if len(finite) else np.full(len(PERCENTILES), np.nan)
            table[name] = {str(p): float(level) for p, level in zip(PERCENTILES, levels, strict=True)}
        return table


@dataclass(frozen=True, slots=True)
class SurfaceStudy(CurvatureStudy):
    """Curvature of a surface, and the surface.

    Attributes
    ----------
    mesh : TriangleMesh
        The surface, unchanged.
    """

    mesh: TriangleMesh = field(kw_only=True)

    @property
    def positions(self) -> Floats:
        """(n_vertices, 3): the vertices of the mesh."""
        return self.mesh.vertices

    @property
    def areas(self) -> Floats:
        """(n_vertices,): a third of the area of the faces around each vertex."""
        return self.mesh.vertex_areas

    @property
    def notes(self) -> tuple[str, ...]:
        """What the reader and the method had to do, one sentence each."""
        return (*self.mesh.notes, *self.curvature.notes)


def mesh_counts(mesh: TriangleMesh) -> dict[str, int]:
    """Counts that describe a mesh and its faults."""
    t = mesh.topology
    return {
        "vertices": mesh.n_vertices,
        "faces": mesh.n_faces,
        "edges": t.n_edges,
        "components": t.n_components,
        "euler_characteristic": t.euler_characteristic,
        "boundary_edges": int(t.edge_is_boundary.sum()),
        "nonmanifold_edges": int((~t.edge_is_manifold).sum()),
        "nonmanifold_vertices": int((t.vertex_is_used & ~t.vertex_is_manifold).sum()),
        "unused_vertices": int((~t.vertex_is_used).sum()),
        "nonfinite_vertices": int((~mesh.vertex_is_finite).sum()),
        "degenerate_faces": int(mesh.face_is_degenerate.sum()),
        "misoriented_faces": int(t.face_flips.sum()),
    }


def study_surface(
    mesh: TriangleMesh,
    *,
    method: str = "auto",
    quality: str = "best",
    radius: float | None = None,
    unit: str = "length",
    progress: Any = None,
) -> SurfaceStudy:
    """Compute the curvature of a surface and time it.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface.
    method, quality, radius, progress
        As for `rinow.surface_curvature`.
    unit : str, optional
        Name of the unit of length of the positions.

    Returns
    -------
    study : SurfaceStudy
        The curvature and what is needed to read it.
    """
    start = time.perf_counter()
    curvature = surface_curvature(mesh, method=method, quality=quality, radius=radius, progress=progress)
    seconds = {"curvature": time.perf_counter() - start}
    return SurfaceStudy(curvature, unit, seconds, {"method": method, "quality": quality, "radius": radius}, mesh=mesh)
