"""How often the true error of the Gaussian curvature lies within two spreads, on analytic surfaces with noise.

    python benchmarks/check_spread.py [n] [seed] [estimator ...]

Noise is normal on every coordinate, 1, 5 and 10 % of the mean edge; two standard errors of a normal distribution hold
95 %.  Prints for each estimator, inside and at the boundary, the mean and the least share of vertices over all meshes,
the mesh of the least one, and the median over the meshes of the median spread over the root mean square of the errors.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent / "curvature"))
from surfaces import Mesh, has, surfaces, triangulation

import rinow

OPTIONS: dict[str, dict[str, Any]] = {"best": {}, "fast": {"quality": "fast"}, "cloud": {}}
OPTIONS |= {name: {"method": name} for name in ("intrinsic", "lifted", "wald", "robinson", "angle_defect")}
USUAL = ["best", "fast", "intrinsic"]
STYLES, NOISE = ("irregular", "regular"), (0.01, 0.05, 0.1)


def meshes(n: int, seed: int) -> Iterator[tuple[str, Mesh]]:
    """All meshes with their names."""
    for surface in surfaces().values():
        for style in (style for style in STYLES if has(surface, style)):
            for noise in NOISE:
                yield (
                    f"{surface.name}, {style}, {noise:.0%}",
                    triangulation(surface, style, n, noise=noise, seed=seed),
                )


def estimate(name: str, mesh: Mesh) -> rinow.SurfaceCurvature:
    """The curvature by one of the estimators."""
    if name == "cloud":
        return rinow.point_cloud_curvature(mesh.vertices)
    return rinow.surface_curvature((mesh.vertices, mesh.faces), **OPTIONS[name])


def main(n: int, seed: int, estimators: list[str]) -> None:
    """Measure and print."""
    rows: dict[tuple[str, str], list[tuple[float, float, str]]] = {}
    for mesh_name, mesh in meshes(n, seed):
        ends = np.zeros(len(mesh.vertices), bool)
        ends[rinow.TriangleMesh(mesh.vertices, mesh.faces).boundary_vertices] = True
        for name in estimators:
            found = estimate(name, mesh)
            error, known = np.abs(found.gaussian - mesh.gaussian), np.isfinite(found.spread)
            for place, chosen in (("inside", known & ~ends), ("boundary", known & ends)):
                if chosen.any():
                    e, spread = error[chosen], found.spread[chosen]
                    row = np.mean(e <= 2.0 * spread), np.median(spread) / np.sqrt(np.mean(e**2)), mesh_name
                    rows.setdefault((name, place), []).append(row)
    for (name, place), found in sorted(rows.items()):
        shares, ratios = [row[0] for row in found], [row[1] for row in found]
        least, _, where = min(found)
        print(f"{name:12} {place:8} mean {np.mean(shares):.3f}  least {least:.3f} ({where})", end="")
        print(f"  spread / error {np.median(ratios):.2f}  {len(found)} meshes")


if __name__ == "__main__":
    numbers = [int(x) for x in sys.argv[1:3]]
    main(*(numbers + [4000, 1][len(numbers) :]), sys.argv[3:] or USUAL)
