"""Estimators of curvature behind one call each, run in a process of their own, since some end it.

    python estimators.py NAME FOLDER

computes the curvature of every ``*.mesh.npz`` in FOLDER that has no answer yet, and writes it beside it.
"""

from __future__ import annotations

import importlib.metadata
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

Floats = np.ndarray
Answer = dict[str, Floats]


def mean_edge(V: Floats, F: Floats) -> float:
    """Mean length of the sides of the faces."""
    ends = V[F]
    return float(np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2).mean())


def third_areas(V: Floats, F: Floats) -> Floats:
    """A third of the area around each vertex."""
    a, b, c = V[F[:, 0]], V[F[:, 1]], V[F[:, 2]]
    return np.bincount(F.ravel(), np.repeat(np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6, 3), len(V))


def rinow(**options: Any) -> Callable[[Floats, Floats], Answer]:
    """The library of this repository."""

    def estimate(V: Floats, F: Floats) -> Answer:
        import rinow

        result = rinow.surface_curvature((V, F), **options)
        return {"K": result.gaussian, "H": result.mean}

    return estimate


def libigl_defect(V: Floats, F: Floats) -> Answer:
    """Angle defect over the Voronoi area."""
    import igl

    mass = igl.massmatrix(V, F, igl.MASSMATRIX_TYPE_VORONOI).diagonal()
    return {"K": igl.gaussian_curvature(V, F) / mass}


def libigl_quadric(rings: int) -> Callable[[Floats, Floats], Answer]:
    """Quadrics fitted to some rings."""

    def estimate(V: Floats, F: Floats) -> Answer:
        import igl

        found = [np.ravel(x) for x in igl.principal_curvature(V, F, rings)[2:4]]
        # Its normals point inwards where those of the faces point outwards.
        return {"K": found[0] * found[1], "H": 0.5 * (found[0] + found[1])}

    return estimate


def vtk(V: Floats, F: Floats) -> Answer:
    """The filter vtkCurvatures."""
    import pyvista

    surface = pyvista.PolyData.from_regular_faces(V, F)
    return {"K": np.asarray(surface.curvature("gaussian")), "H": np.asarray(surface.curvature("mean"))}


def trimesh_ball(reach: float) -> Callable[[Floats, Floats], Answer]:
    """Measures of curvature in balls, over the area of the disk."""

    def estimate(V: Floats, F: Floats) -> Answer:
        import trimesh
        from trimesh import curvature

        mesh = trimesh.Trimesh(V, F, process=False)
        r = reach * mean_edge(V, F)
        K = curvature.discrete_gaussian_curvature_measure(mesh, V, r) / (np.pi * r * r)
        H = curvature.discrete_mean_curvature_measure(mesh, V, r) / (np.pi * r * r)
        return {"K": K, "H": H}

    return estimate


def meshlab(reach: float) -> Callable[[Floats, Floats], Answer]:
    """Scale-dependent quadrics of MeshLab."""

    def estimate(V: Floats, F: Floats) -> Answer:
        import pymeshlab

        answer: Answer = {}
        for key, name in (("K", "Gaussian Curvature"), ("H", "Mean Curvature")):
            meshes = pymeshlab.MeshSet()
            meshes.add_mesh(pymeshlab.Mesh(V, F))
            meshes.compute_curvature_principal_directions_per_vertex(
                method="Scale Dependent Quadric Fitting",
                curvcolormethod=name,
                scale=pymeshlab.PureValue(reach * mean_edge(V, F)),
                autoclean=False,
            )
            answer[key] = np.asarray(meshes.current_mesh().vertex_scalar_array())
        return answer

    return estimate


def pygel(V: Floats, F: Floats) -> Answer:
    """Gaussian and mean curvature of PyGEL."""
    from pygel3d import hmesh
    from scipy.spatial import KDTree

    mesh = hmesh.Manifold.from_triangles(V, F)
    # The order of the vertices is not kept: each is found again by its position.
    numbers = np.array(list(mesh.vertices()))
    distance, nearest = KDTree(mesh.positions()[numbers]).query(V)
    if distance.max() > 1e-9:
        raise ValueError("vertices have changed")
    K = np.array([mesh.gaussian_curvature(v) for v in numbers])
    H = np.array([mesh.mean_curvature(v) for v in numbers])
    return {"K": K[nearest], "H": H[nearest]}


ESTIMATORS: dict[str, tuple[str, Callable[[Floats, Floats], Answer]]] = {
    "rinow": ("rinow", rinow()),
    "rinow, fast": ("rinow", rinow(quality="fast")),
    "rinow, intrinsic": ("rinow", rinow(method="intrinsic")),
    "libigl, angle defect": ("libigl", libigl_defect),
    "libigl, quadrics on 2 rings": ("libigl", libigl_quadric(2)),
    "libigl, quadrics on 5 rings": ("libigl", libigl_quadric(5)),
    "VTK": ("vtk", vtk),
    "trimesh, balls of 2 edges": ("trimesh", trimesh_ball(2.0)),
    "trimesh, balls of 4 edges": ("trimesh", trimesh_ball(4.0)),
    "MeshLab, quadrics of 3 edges": ("pymeshlab", meshlab(3.0)),
    "MeshLab, quadrics of 6 edges": ("pymeshlab", meshlab(6.0)),
    "PyGEL": ("PyGEL3D", pygel),
}
"""Name in tables: package on PyPI, and the call."""


def version(package: str) -> str | None:
    """Installed version of a package."""
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def main(name: str, folder: Path) -> None:
    """Answer the meshes of a folder one after the other; a mesh is marked before, in case the process ends on it."""
    estimate, complaints = ESTIMATORS[name][1], set[str]()
    for path in sorted(folder.glob("*.mesh.npz")):
        answer, tried = path.with_suffix("").with_suffix(".answer.npz"), path.with_suffix("").with_suffix(".tried")
        if answer.exists() or tried.exists():
            continue
        tried.touch()
        with np.load(path) as mesh:
            V, F = np.ascontiguousarray(mesh["V"]), np.ascontiguousarray(mesh["F"])
        try:
            if "warm" in path.name:
                estimate(V, F)
            start = time.perf_counter()
            found = estimate(V, F)
            seconds = time.perf_counter() - start
        except Exception as error:
            if str(error) not in complaints:
                print(f"{name}: {path.name}: {type(error).__name__}: {error}", file=sys.stderr)
            complaints.add(str(error))
            continue
        np.savez(answer, seconds=seconds, **{k: np.asarray(v, float) for k, v in found.items()})


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]))
