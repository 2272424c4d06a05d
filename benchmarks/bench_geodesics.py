"""Speed and accuracy of exact geodesic balls and whole-mesh distances, beside other libraries in one run.

    python benchmarks/bench_geodesics.py [n]
    python benchmarks/bench_geodesics.py MESH [MESH ...]

The mesh is an irregular sphere of `n` vertices (64,000 by default).  Mesh files are checked instead: against
pygeodesic from four sources, and the distances within 3h of all vertices for symmetry, which needs no reference.

pygeodesic computes whole meshes; gdist cuts off at a radius but prepares the whole mesh at each call.  A library that
is not installed, or does not load, is left out.
"""

from __future__ import annotations

import sys
import time

import numba
import numpy as np
from scipy.spatial import ConvexHull

import rinow
from rinow.geodesics.exact import ExactGeodesics

BALLS = 20
"""Sources of the other libraries."""


def irregular_sphere(n: int, seed: int = 20) -> tuple[np.ndarray, np.ndarray]:
    """Evenly spread directions moved by a third of their spacing, in random order, and their convex hull."""
    rng = np.random.default_rng(seed)
    i = np.arange(n) + 0.5
    z, u = 1 - 2 * i / n, np.pi * (1 + 5**0.5) * i
    V = np.stack([np.sqrt(1 - z * z) * np.cos(u), np.sqrt(1 - z * z) * np.sin(u), z], axis=1)
    V += rng.uniform(-1, 1, V.shape) * np.sqrt(4 * np.pi / n) / 3
    V = rng.permutation(V / np.linalg.norm(V, axis=1)[:, None])
    F = ConvexHull(V).simplices.astype(np.int32)
    inward = np.linalg.det(V[F]) < 0
    F[inward] = F[inward][:, ::-1]
    return V, F


def bench_balls(V: np.ndarray, F: np.ndarray) -> None:
    """All balls of radius 3h and 6h, prepared mesh; gdist beside."""
    h, everyone = np.sqrt(4 * np.pi / len(V)), np.arange(len(V))
    start = time.perf_counter()
    geodesics = ExactGeodesics((V, F))
    geodesics.distances([0], max_distance=3 * h)
    print(f"{len(V)} vertices, {numba.get_num_threads()} threads; prepared in {time.perf_counter() - start:.2f} s")
    for factor in (3, 6):
        times = []
        for _ in range(4):
            start = time.perf_counter()
            balls = geodesics.distances(everyone, max_distance=factor * h)
            times.append(time.perf_counter() - start)
        rates = f"best {len(V) / min(times):,.0f}, median {len(V) / np.median(times):,.0f} sources/s"
        gap = np.abs((balls - balls.T).data).max()
        print(f"{factor}h: {rates}; {balls.nnz / len(V):.1f} vertices each; |d(s,v) - d(v,s)| at most {gap:.1e}")
        others = everyone[:: len(V) // BALLS][:BALLS]
        _bench_gdist(V, F, others, factor * h, balls)


def _bench_gdist(V: np.ndarray, F: np.ndarray, sources: np.ndarray, radius: float, balls: object) -> None:
    try:
        import gdist
    except (ImportError, ValueError) as fault:
        print(f"    gdist left out: {fault}")
        return
    start = time.perf_counter()
    rows = [gdist.compute_gdist(V, F, np.array([s], np.int32), max_distance=radius) for s in sources]
    rate = len(sources) / (time.perf_counter() - start)
    ours = balls[sources].toarray()
    error = max(np.abs(row[o > 0] / o[o > 0] - 1).max() for row, o in zip(rows, ours, strict=True))
    print(f"    gdist: {rate:,.1f} sources/s; relative difference at most {error:.1e}")


def bench_rows(n: int) -> None:
    """Distances to all vertices of a mesh; pygeodesic beside."""
    V, F = irregular_sphere(n)
    geodesics = ExactGeodesics((V, F))
    geodesics.distances([0])
    sources = np.arange(0, n, n // 4)[:4]
    start = time.perf_counter()
    rows = geodesics.distances(sources)
    seconds = (time.perf_counter() - start) / len(sources)
    print(f"whole mesh of {n} vertices: {seconds:.3f} s a source")
    try:
        from pygeodesic.geodesic import PyGeodesicAlgorithmExact
    except (ImportError, ValueError) as fault:
        print(f"    pygeodesic left out: {fault}")
        return
    other = PyGeodesicAlgorithmExact(V, F)
    start = time.perf_counter()
    row = other.geodesicDistances(sources[:1].astype(np.int32), None)[0]
    theirs = time.perf_counter() - start
    error = np.abs(row - rows[0]).max()
    print(f"    pygeodesic: {theirs:.3f} s a source, ratio {theirs / seconds:.1f}; difference at most {error:.1e}")


def check_mesh(path: str) -> None:
    """Difference from pygeodesic, relative to the distance, and asymmetry of all small balls."""
    from pygeodesic.geodesic import PyGeodesicAlgorithmExact

    mesh = rinow.read_mesh(path)
    geodesics = ExactGeodesics(mesh)
    used, place = np.unique(mesh.faces, return_inverse=True)
    sources = used[:: max(len(used) // 4, 1)][:4]
    rows = geodesics.distances(sources)[:, used]
    other = PyGeodesicAlgorithmExact(mesh.vertices[used], place.reshape(mesh.faces.shape).astype(np.int32))
    theirs = np.stack([other.geodesicDistances(np.searchsorted(used, [s]).astype(np.int32), None)[0] for s in sources])
    far = np.isfinite(rows) & (rows > 0) & (theirs < 1e90)
    error = (np.abs(rows[far] - theirs[far]) / rows[far]).max()
    h = np.sqrt(mesh.vertex_areas.sum() / len(used))
    balls = geodesics.distances(np.arange(mesh.n_vertices), max_distance=3 * h)
    gap = (abs(balls - balls.T).data / np.maximum(balls.data.max(), 1e-300)).max()
    print(
        f"{path}: pygeodesic differs by at most {error:.1e} of the distance ({far.sum()} distances), "
        f"|d(s,v) - d(v,s)| at most {gap:.1e} of the radius ({balls.nnz} distances)"
    )


def main() -> None:
    """Balls on one big sphere, whole meshes on smaller ones; or checks of the files named."""
    if sys.argv[1:] and not sys.argv[1].isdigit():
        for path in sys.argv[1:]:
            check_mesh(path)
        return
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 64_000
    bench_balls(*irregular_sphere(n))
    for size in (10_000, 30_000):
        bench_rows(min(size, n))


if __name__ == "__main__":
    main()
