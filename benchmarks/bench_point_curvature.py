"""Speed and accuracy of curvature at a point: Wald, modified Wald, Rinow, regular disks.

    python benchmarks/bench_point_curvature.py

Times are medians of several calls in one process, after one that compiles.  Errors are those of the curvature at 20
vertices of a mesh, in units of 1/radius², beside the standard error that is returned with them.
"""

from __future__ import annotations

import numpy as np
from _mesh import jittered_torus, torus_curvature
from _timing import median_seconds

import rinow


def model_surface(n: int) -> np.ndarray:
    """Distances of points of the unit sphere."""
    sphere = rinow.SpaceForm(1.0)
    points = sphere.sample(n, 0.5, np.random.default_rng(7))
    D = sphere.distance(points[:, None], points)
    return 0.5 * (D + D.T)


def speeds() -> None:
    """Print the time of each function on points of a sphere."""
    D40, D100, D32 = model_surface(40), model_surface(100), model_surface(32)
    calls = {
        "wald_curvature, 40 points, 20000 quadruples": lambda: rinow.wald_curvature(D40, 0, radius=2.0),
        "rinow_curvature, 40 points": lambda: rinow.rinow_curvature(D40),
        "rinow_curvature, 100 points, 3.9 million quadruples": lambda: rinow.rinow_curvature(D100),
        "regular_radius, 32 points": lambda: rinow.regular_radius(D32, 0),
        "angle_at, curvature estimated": lambda: rinow.angle_at(D40, 0, 1, 2),
    }
    for name, call in calls.items():
        print(f"{name:55s} {1e3 * median_seconds(call, 7):9.1f} ms")


def errors() -> None:
    """Print the errors at vertices of a torus of 10,000 vertices, balls of 3 and 6 edge lengths."""
    V, F = jittered_torus(10_000)
    mesh, K = rinow.TriangleMesh(V, F), torus_curvature(V)
    edge = float(np.sqrt(2 * mesh.vertex_areas.mean()))
    chosen = np.random.default_rng(7).choice(mesh.n_vertices, 20, replace=False)
    for n_edges in (3, 6):
        radius = n_edges * edge
        for kind in ("wald", "modified"):
            found = [rinow.wald_curvature(mesh, int(p), radius=radius, kind=kind) for p in chosen]
            error = np.median([abs(f.value - K[p]) for f, p in zip(found, chosen, strict=True)]) * radius**2
            stated = np.median([f.standard_error for f in found]) * radius**2
            exist = sum(f.exists for f in found)
            print(f"{kind:9s} radius {n_edges} edges: error {error:.4f}, stated {stated:.4f}, {exist}/20 exist")


if __name__ == "__main__":
    speeds()
    errors()
