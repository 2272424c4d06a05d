"""The radius of the Earth, with a standard error, from distances between cities alone.

    python examples/earth_radius.py [distances.csv]

Reads a square table of distances in km, by default that of 25 cities beside this file: great-circle distances, rounded
to the km.  No coordinate is read.  That these numbers fit a sphere, of which size, and how well, are found from them.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rinow import MetricSpace, fit_curvature, metric_space_curvature

TABLE = Path(__file__).with_name("city_distances.csv")


def read_distances(path: Path) -> tuple[list[str], NDArray[np.float64]]:
    """Names and the square matrix of a table whose first row and column are names."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return rows[0][1:], np.array([[float(x) for x in row[1:]] for row in rows[1:]])


def radius(distances: NDArray[np.float64]) -> tuple[float, float]:
    """Radius of the sphere that fits distances best, and its standard error."""
    fit = fit_curvature(distances)
    R = float(fit.value) ** -0.5
    return R, R * float(fit.standard_error) / (2 * float(fit.value))


def main() -> None:
    """Print what the distances tell."""
    names, D = read_distances(Path(sys.argv[1]) if len(sys.argv) > 1 else TABLE)
    fit, (R, error) = fit_curvature(D), radius(D)
    print(f"{len(names)} cities, {len(names) * (len(names) - 1) // 2} distances up to {D.max():,.0f} km, nothing else")
    print(f"curvature ({fit.value:.6e} ± {fit.standard_error:.1e}) / km²")
    print(f"R = {R:.2f} ± {error:.2f} km; the distances fit a sphere to {1000 * fit.residual:.0f} m")
    local = metric_space_curvature(MetricSpace(D, rtol=1e-3))
    best = int(np.nanargmin(local.standard_error))
    print(
        f"seen from {names[best]} alone, within {local.radius[best]:,.0f} km: "
        f"R = {local.value[best] ** -0.5:.1f} ± {local.standard_error[best] / (2 * local.value[best] ** 1.5):.1f} km"
    )


if __name__ == "__main__":
    main()
