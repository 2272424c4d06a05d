"""Accuracy of curvature on surfaces of masks, beside quadrics of libigl over several rings.

    python benchmarks/bench_masks.py

A mask tells for each voxel whether its centre is inside.  Its surface goes around the voxels inside ("squares") or is
made by marching cubes, from the mask as it is ("raw"), blurred by 0.7 voxels, or smoothed afterwards: 5 steps half of
the way to the mean of the neighbours ("smoothed"), or 10 of Taubin's ("swollen").  Prints the relative root mean square
errors of K and H for voxels that are cubes, and for slices 2.5 times farther apart than pixels, and their geometric
means.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import igl
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
import rinow
from voxels import lattice, marching_cubes, smoothed, squares

Floats = NDArray[np.float64]
Pair = tuple[Floats, Floats]

SIDES = ((1.0, 1.0, 1.0), (1.0, 1.0, 2.5))
KINDS = ("squares", "raw", "blurred", "smoothed", "swollen")
RINGS = (3, 5, 8)
TURN = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]


def ellipsoid(p: Floats) -> tuple[Floats, Callable[[Floats], Pair]]:
    """Values that are negative inside, and the curvatures below points."""
    axes = np.array([30.0, 20.0, 14.0])

    def exact(x: Floats) -> Pair:
        x = x @ TURN
        x = x / np.sqrt(np.sum((x / axes) ** 2, axis=1))[:, None]
        w = np.sum(x**2 / axes**4, axis=1)
        mean = (np.sum(axes**2) - np.sum(x**2, axis=1)) / (2.0 * np.prod(axes) ** 2 * w**1.5)
        return 1.0 / (np.prod(axes) ** 2 * w**2), mean

    return np.sum((p @ TURN / axes) ** 2, axis=-1) - 1.0, exact


def torus(p: Floats) -> tuple[Floats, Callable[[Floats], Pair]]:
    """The same for a torus."""
    R, r = 24.0, 10.0

    def exact(x: Floats) -> Pair:
        x = x @ TURN
        far = np.hypot(x[:, 0], x[:, 1]) - R
        c = far / np.hypot(far, x[:, 2])
        k = c / (R + r * c)
        return k / r, (k + 1.0 / r) / 2.0

    q = p @ TURN
    return np.hypot(np.hypot(q[..., 0], q[..., 1]) - R, q[..., 2]) - r, exact


def surface(kind: str, points: Floats, inside: NDArray[np.bool_], sides: tuple[float, ...]) -> tuple[Floats, Floats]:
    """Vertices and faces."""
    if kind == "squares":
        V, F = squares(inside)
        return (V - 0.5) * sides + points[0, 0, 0], F
    values = inside.astype(float)
    V, F = marching_cubes(points, gaussian_filter(values, 0.7 / np.array(sides)) if kind == "blurred" else values)
    steps = {"smoothed": (5, 0.0), "swollen": (10, 0.53)}
    return (smoothed(V, F, *steps[kind]) if kind in steps else V), F


def estimates(V: Floats, F: Floats) -> Iterator[tuple[str, Pair]]:
    """Curvatures by several tools, with their names."""
    for k in RINGS:
        found = igl.principal_curvature(V, F, k, True)
        k1, k2 = found[2], found[3]
        yield f"{k} rings", (k1 * k2, 0.5 * (k1 + k2))
    for quality in ("best", "fast"):
        c = rinow.surface_curvature((V, F), quality=quality)
        yield quality, (c.gaussian, c.mean)


def main() -> None:
    """Measure and print."""
    errors: dict[str, list[tuple[float, float]]] = {}
    for name, shape in (("ellipsoid", ellipsoid), ("torus", torus)):
        for sides in SIDES:
            points = lattice(36.0, sides)
            values, exact = shape(points)
            for kind in KINDS:
                V, F = surface(kind, points, values < 0.0, sides)
                truth, row = exact(V), []
                for tool, found in estimates(V, F):
                    sign = np.sign(np.sum(found[1] * truth[1]))  # tools differ in the direction of the normal
                    found = found[0], sign * found[1]
                    pair = [
                        float(np.sqrt(np.mean((a - b) ** 2) / np.mean(b**2))) for a, b in zip(found, truth, strict=True)
                    ]
                    errors.setdefault(tool, []).append((pair[0], pair[1]))
                    row.append(f"{tool} {pair[0]:.3f} {pair[1]:.3f}")
                print(f"{name:9s} 1:1:{sides[2]:g} {kind:8s} {len(V):6d}  " + "  ".join(row), flush=True)
    for tool, pairs in errors.items():
        mean = np.exp(np.mean(np.log(pairs), axis=0))
        print(f"{tool:8s} geometric mean K {mean[0]:.3f} H {mean[1]:.3f}")


if __name__ == "__main__":
    main()
