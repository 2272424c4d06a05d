"""How often the true error of the Gaussian curvature lies within two spreads, on analytic surfaces with noise.

    python benchmarks/check_spread.py [n]

Noise is normal on every coordinate, 1, 5 and 10 % of the mean edge.  Prints for each estimator the mean and the least
share of vertices over all meshes, inside and at the boundary; two standard errors of a normal distribution hold 95 %.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent / "curvature"))
from surfaces import has, surfaces, triangulation

import rinow

OPTIONS: dict[str, dict[str, Any]] = {"best": {}, "fast": {"quality": "fast"}, "intrinsic": {"method": "intrinsic"}}
STYLES, NOISE = ("irregular", "regular"), (0.01, 0.05, 0.1)


def main(n: int) -> None:
    """Measure and print."""
    shares: dict[tuple[str, str], list[float]] = {}
    for surface in surfaces().values():
        for style in (style for style in STYLES if has(surface, style)):
            for noise in NOISE:
                mesh = triangulation(surface, style, n, noise=noise)
                at_boundary = rinow.TriangleMesh(mesh.vertices, mesh.faces).boundary_vertices
                ends = np.isin(np.arange(len(mesh.vertices)), at_boundary)
                for name, options in OPTIONS.items():
                    found = rinow.surface_curvature((mesh.vertices, mesh.faces), **options)
                    holds = np.abs(found.gaussian - mesh.gaussian) <= 2.0 * found.spread
                    known = np.isfinite(found.gaussian) & np.isfinite(found.spread)
                    for place, chosen in (("inside", known & ~ends), ("boundary", known & ends)):
                        if chosen.any():
                            shares.setdefault((name, place), []).append(float(holds[chosen].mean()))
    for (name, place), values in sorted(shares.items()):
        print(f"{name:10} {place:9} mean {np.mean(values):.3f}  least {np.min(values):.3f}  ({len(values)} meshes)")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 4000)
