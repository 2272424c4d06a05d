"""Speed and accuracy of determinants, embedding curvatures, Robinson's approximation and space forms.

    python benchmarks/bench_quadruples.py [n]

Rates are medians of several runs in one process, on `n` rows (1,000,000 by default).  Errors are given in units that a
rounding of the distances explains: condition · 2⁻⁵³ / diameter² + 2⁻⁵³ |k|.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from typing import Any

import numpy as np
from _timing import median_seconds
from numba import njit, prange

import rinow
from rinow.kernels import spaceform

EPS = 2.0**-53
I, J = np.triu_indices(4, 1)


def rate(action: Callable[[], Any], n: int) -> float:
    """Rows a second: the median of several runs after one call that compiles and warms."""
    return n / median_seconds(action)


def sampled(k: float, radius: float, n: int, rng: np.random.Generator) -> np.ndarray:
    """Quadruples of points of S_k, evenly spread in a disk."""
    surface = rinow.SpaceForm(k)
    points = surface.sample(4 * n, radius, rng).reshape(n, 4, 3)
    return surface.distance(points[:, I], points[:, J])


@njit(parallel=True)
def _outer_sides(a, c, b, alpha, k, out):
    """Write Robinson's quadruples: two hinges with the angles alpha and π - alpha, in S_k."""
    for i in prange(a.shape[0]):
        e, f = spaceform.side(a[i], b[i], alpha[i], k[i]), spaceform.side(c[i], b[i], math.pi - alpha[i], k[i])
        out[i, 0], out[i, 1], out[i, 2], out[i, 3], out[i, 4], out[i, 5] = a[i], a[i] + c[i], e, c[i], b[i], f


def semidependent(largest: float, n: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Quadruples with a linear triple and |k| up to `largest`, a third of them of the extremal thin shape; and k."""
    a, c, b = rng.uniform(0.02, 0.5, (3, n))
    alpha = rng.uniform(0.02, math.pi - 0.02, n)
    thin = rng.uniform(size=n) < 0.33
    alpha[thin], b[thin] = 10.0 ** rng.uniform(-4, -0.5, thin.sum()), a[thin]
    k, out = largest * rng.uniform(-1, 1, n), np.empty((n, 6))
    _outer_sides(a, c, b, alpha, k, out)
    return out, k


def bench_determinants(n: int, rng: np.random.Generator) -> None:
    """Rate of the determinant of four points."""
    points = rng.normal(size=(n, 4, 3))
    D = np.linalg.norm(points[:, :, None] - points[:, None], axis=-1)
    print(
        f"cayley_menger_determinant, 4 points    {rate(lambda: rinow.cayley_menger_determinant(D), n) / 1e6:8.1f} M/s"
    )


def bench_embedding(n: int, rng: np.random.Generator) -> None:
    """Rates for several kinds of input, and the round trip from points of S_k."""
    for name, Q in (("distances in [1, 2]", rng.uniform(1, 2, (n, 6))), ("points of S_1", sampled(1.0, 0.5, n, rng))):
        print(f"embedding_curvatures, {name:20s} {rate(lambda Q=Q: rinow.embedding_curvatures(Q), n) / 1e3:8.0f} k/s")
    print(f"\nround trip of {n} quadruples for each k: error in units, and how many are further than 30 units")
    for k in (-100.0, -1.0, -1e-6, 0.0, 1e-6, 1.0, 100.0):
        for diameter in (1e-3, 1e-1, 1.0):
            round_trip(k, min(diameter / 2, 1.3 / math.sqrt(max(k, 1e-9))), n // 3, rng)


def round_trip(k: float, radius: float, n: int, rng: np.random.Generator) -> None:
    """Distance of the sampled k from the nearest value, in units."""
    Q = sampled(k, radius, n, rng)
    result = rinow.embedding_curvatures(Q)
    error = np.abs(result.values - k)
    nearest = np.nanargmin(error, axis=1)[:, None]
    condition = np.take_along_axis(result.condition, nearest, 1)[:, 0]
    units = np.nanmin(error, axis=1) / (EPS * (condition / Q.max(axis=1) ** 2 + abs(k)))
    lost = (units > 30) & (result.kind[:, 0] != "semidependent")
    snapped = np.count_nonzero(result.kind[:, 0] == "semidependent")
    figures = "  ".join(f"{q:4.0f} %: {np.percentile(units, q):7.2f}" for q in (50, 99, 99.99))
    print(f"k = {k:8g}, diameter <= {2 * radius:6.3g}:  {figures}   lost {lost.sum()}, taken as linear {snapped}")


def bench_robinson(n: int, rng: np.random.Generator) -> None:
    """Rates and violations of the intervals, and the largest constants of the error terms."""
    Q, _ = semidependent(0.15, n, rng)
    print()
    for order in (1, 2, 3):
        fast = rate(lambda order=order: rinow.robinson_curvature(Q, order=order), n)
        sharp = rate(lambda order=order: rinow.robinson_curvature(Q, order=order, verify=True), n)
        print(f"robinson_curvature, order {order}      {fast / 1e6:8.1f} M/s, verified {sharp / 1e6:6.2f} M/s")
    for largest in (1e-8, 1e-4, 0.01, 0.15, 1.0, 20.0):
        Q, k = semidependent(largest, n, rng)
        wrong = {}
        for verify in (False, True):
            result = rinow.robinson_curvature(Q, verify=verify)
            wrong[verify] = np.count_nonzero((result.lower > k) | (result.upper < k))
        print(f"|k| <= {largest:6g}: outside the interval {wrong[False]}, verified {wrong[True]} of {n}")
    Q, k = semidependent(1.0, n, rng)
    d2, condition = Q.max(axis=1) ** 2, rinow.embedding_curvatures(Q).condition[:, 0]
    for order, power in ((1, 2), (2, 3)):
        value = rinow.robinson_curvature(Q, order=order).value
        size = np.abs(rinow.robinson_curvature(Q).value) if order == 2 else np.abs(k)
        inside = (size * d2 < 0.2) & (size * d2 > 0.05)
        error = np.abs(value - k) - 30 * EPS * condition / d2
        constant = (error / (size**power * d2 ** (power - 1)))[inside].max()
        print(f"largest error of order {order}: {constant:.4f} |k|^{power} diameter^{2 * power - 2}")


def bench_space_forms(n: int, rng: np.random.Generator) -> None:
    """Rates of angles, distances and embeddings."""
    sides = rng.uniform(1, 2, (3, n))
    print()
    for k in (-1.0, 0.0, 0.5):
        surface = rinow.SpaceForm(k)
        points = surface.sample(4 * n, 1.0, rng).reshape(n, 4, 3)
        Q = surface.distance(points[:, I], points[:, J])
        angles = rate(lambda surface=surface: surface.angle(*sides), n)
        distances = rate(lambda surface=surface, p=points: surface.distance(p[:, 0], p[:, 1]), n)
        embeddings = rate(lambda surface=surface, Q=Q[: n // 10]: surface.embed(Q), n // 10)
        rates = f"angle {angles / 1e6:6.1f}, distance {distances / 1e6:6.1f}, embed {embeddings / 1e6:6.2f} M/s"
        print(f"SpaceForm({k:4}): {rates}")


def main() -> None:
    """Run everything on one seed."""
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    rng = np.random.default_rng(20260801)
    bench_determinants(n, rng)
    bench_embedding(n, rng)
    bench_robinson(n, rng)
    bench_space_forms(n, rng)


if __name__ == "__main__":
    main()
