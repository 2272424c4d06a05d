"""Gromov-Hausdorff and Lipschitz distance: what is exact, what stays open, and how long it takes.

    python benchmarks/bench_gromov_hausdorff.py [group ...] [--seeds N ...] [--only TEXT] [--seconds S] [--page]
                                                [--verify]

Prints instance, lower and upper bound, whether they are equal, what proved the lower one, and seconds.  Groups:
plane, space, hops100, hops200, noisy, lipschitz, circle, continuous, intervals, meshes, large-meshes; by default all of
them.  The correspondence of every result is measured again.  With `--page` each result replaces that of the
same instance and seed in `benchmarks/distances/results.json` as soon as it is there, and
docs/reference/benchmark-distances.md is written from all of them.
"""

from __future__ import annotations

import argparse
import itertools
import math
import resource
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import networkx as nx
import numpy as np
from _mesh import jittered_torus
from distances.report import write_page
from scipy.sparse.csgraph import shortest_path

import rinow

Instance = tuple[Any, ...]
"""Name, the two spaces, and the covering radii where these are nets."""


def cloud(rng: np.random.Generator, n: int, dimension: int = 2) -> rinow.MetricSpace:
    """Points of the unit cube."""
    return rinow.MetricSpace.from_points(rng.random((n, dimension)))


def noisy(rng: np.random.Generator, n: int, sigma: float = 0.01) -> tuple[rinow.MetricSpace, rinow.MetricSpace]:
    """Points of the unit square and their shuffled copy with noise."""
    points = rng.random((n, 2))
    moved = rng.permutation(points) + rng.normal(0, sigma, points.shape)
    return rinow.MetricSpace.from_points(points), rinow.MetricSpace.from_points(moved)


def polygon(n: int) -> rinow.MetricSpace:
    """Vertices of a regular polygon with the arc metric."""
    steps = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
    return rinow.MetricSpace(np.minimum(steps, n - steps) * (2 * math.pi / n))


def sphere_net(rng: np.random.Generator | None, n: int) -> rinow.MetricSpace:
    """Points of the unit sphere with the geodesic metric: a Fibonacci net, or farthest points of a random set."""
    k = 4000 if rng else n
    z = 1 - (2 * np.arange(k) + 1) / k
    angle = math.pi * (1 + math.sqrt(5)) * np.arange(k)
    P = np.stack([np.sqrt(1 - z * z) * np.cos(angle), np.sqrt(1 - z * z) * np.sin(angle), z], axis=1)
    if rng:
        chosen = [int(rng.integers(k))]
        nearest = P @ P[chosen[0]]
        while len(chosen) < n:
            chosen.append(int(nearest.argmin()))
            nearest = np.maximum(nearest, P @ P[chosen[-1]])
        P = P[chosen]
    D = np.arccos(np.clip(P @ P.T, -1, 1))
    D = (D + D.T) / 2
    np.fill_diagonal(D, 0)
    return rinow.MetricSpace(D)


def hops(graph: nx.Graph) -> rinow.MetricSpace:
    """Numbers of steps between the nodes; components are joined by an edge."""
    parts = [min(c) for c in nx.connected_components(graph)]
    graph.add_edges_from(itertools.pairwise(parts))
    return rinow.MetricSpace(shortest_path(nx.to_scipy_sparse_array(graph), directed=False, unweighted=True))


GRAPHS = {
    "tree": lambda n, s: nx.random_labeled_tree(n, seed=s),
    "G(n,.05)": lambda n, s: nx.gnp_random_graph(n, 0.05, seed=s),
    "G(n,.1)": lambda n, s: nx.gnp_random_graph(n, 0.1, seed=s),
    "preferential": lambda n, s: nx.barabasi_albert_graph(n, 2, seed=s),
    "3-regular": lambda n, s: nx.random_regular_graph(3, n, seed=s),
    "geometric": lambda n, s: nx.random_geometric_graph(n, 0.18, seed=s),
    "small world": lambda n, s: nx.connected_watts_strogatz_graph(n, 4, 0.3, seed=s),
}


def plane(seed: int) -> Iterator[Instance]:
    """Unrelated clouds of the plane."""
    for n in (100, 200):
        rng = np.random.default_rng(1000 + seed)
        yield f"R2 n={n}", cloud(rng, n), cloud(rng, n)


def space(seed: int) -> Iterator[Instance]:
    """Unrelated clouds of space."""
    for n in (45, 100):
        rng = np.random.default_rng(1000 + seed)
        yield f"R3 n={n}", cloud(rng, n, 3), cloud(rng, n, 3)


def hop_metrics(seed: int, n: int) -> Iterator[Instance]:
    """Random graphs of several kinds."""
    for name, make in GRAPHS.items():
        yield f"{name} n={n}", hops(make(n, seed)), hops(make(n, seed + 100))


def noisy_copies(seed: int) -> Iterator[Instance]:
    """Nearly isometric clouds."""
    for n in (200, 500):
        yield (f"noisy copy n={n}", *noisy(np.random.default_rng(1000 + seed), n))


def circle(seed: int) -> Iterator[Instance]:
    """Homogeneous spaces."""
    segment = np.abs(np.subtract.outer(*[np.linspace(0, math.pi, 25)] * 2))
    yield "24-gon / segment", polygon(24), rinow.MetricSpace(segment)
    yield "24-gon / sphere net", polygon(24), sphere_net(np.random.default_rng(seed), 24)
    yield "24-gon / Fibonacci net", polygon(24), sphere_net(None, 24)


def continuous(seed: int) -> Iterator[Instance]:
    """The circle and the sphere themselves, by nets of them."""
    net = sphere_net(np.random.default_rng(seed), 120)
    radius = 0.35  # 0.2 within the 4000 points, which are themselves closer than 0.1 to every point
    yield "circle / sphere: π/3", polygon(36), net, (math.pi / 36, radius)


def intervals(seed: int) -> Iterator[Instance]:
    """Clouds that are too large to close."""
    rng = np.random.default_rng(1000 + seed)
    yield "R2 n=500", cloud(rng, 500), cloud(rng, 500)


def bipartite(seed: int) -> Iterator[Instance]:
    """Clouds for the Lipschitz distance."""
    for n in (45, 60):
        rng = np.random.default_rng(1000 + seed)
        yield f"d_L R2 n={n}", cloud(rng, n), cloud(rng, n)


def icosphere(levels: int) -> tuple[np.ndarray, np.ndarray]:
    """A subdivided icosahedron on the unit sphere."""
    import trimesh

    sphere = trimesh.creation.icosphere(levels)
    return np.array(sphere.vertices), np.array(sphere.faces)


def meshes(seed: int) -> Iterator[Instance]:
    """Meshes with the metric of their edges, the second one with its vertices shuffled."""
    rng = np.random.default_rng(seed)
    V, F = icosphere(4)
    order = rng.permutation(len(V))
    yield "sphere / ellipsoid", (V, F), ((V * [1, 1, 0.7])[np.argsort(order)], order[F])
    u, v = (a.ravel() for a in np.meshgrid(np.linspace(0, 1, 30), np.linspace(0, 2, 60), indexing="ij"))
    i, j = (a.ravel() for a in np.meshgrid(np.arange(29), np.arange(59), indexing="ij"))
    k = i * 60 + j
    F = np.concatenate([np.stack([k, k + 60, k + 61], axis=1), np.stack([k, k + 61, k + 1], axis=1)])
    flat, bent = np.stack([u, v, 0 * u], axis=1), np.stack([u, np.sin(v), np.cos(v)], axis=1)
    order = rng.permutation(len(u))
    yield "flat / bent sheet", (flat, F), (bent[np.argsort(order)], order[F])
    import trimesh

    torus = trimesh.creation.torus(1, 0.4, major_sections=64, minor_sections=32)
    scale = 3.3359203 / 3.8955038  # of the diameters along edges
    yield "torus / sphere", (scale * np.array(torus.vertices), np.array(torus.faces)), icosphere(4)


def large_meshes(seed: int) -> Iterator[Instance]:
    """Meshes of 100,000 vertices, the second one with its vertices shuffled."""
    V, F = jittered_torus(100_000, seed=20 + seed)
    order = np.random.default_rng(seed).permutation(len(V))
    wavy = V * (1 + 0.05 * np.sin(5 * np.arctan2(V[:, 1], V[:, 0])))[:, None]
    yield "torus / wavy torus", (V, F), (wavy[np.argsort(order)], order[F])
    yield "torus / ellipsoid", (V, F), (1.4 * icosphere(7)[0] * [1, 1, 0.4], icosphere(7)[1])


GROUPS: dict[str, tuple[Callable[[int], Iterator[Instance]], float]] = {
    "plane": (plane, 60.0),
    "space": (space, 60.0),
    "hops100": (partial(hop_metrics, n=100), 10.0),
    "hops200": (partial(hop_metrics, n=200), 60.0),
    "noisy": (noisy_copies, 60.0),
    "lipschitz": (bipartite, 60.0),
    "circle": (circle, 60.0),
    "continuous": (continuous, 60.0),
    "intervals": (intervals, 60.0),
    "meshes": (meshes, 60.0),
    "large-meshes": (large_meshes, 60.0),
}
"""The instances of a seed, and the seconds allowed for each."""


SOME_ROWS = 6000
"""Pairs of a relation up to which all their distances are found."""


def measured_on(mesh: Any, points: np.ndarray) -> tuple[np.ndarray, float, float]:
    """Distances along edges between vertices of a mesh, how far others are from them, and a bound of the diameter."""
    rows = rinow.geodesic_distances(mesh, points, method="edges")
    between, radius = rows[:, points], float(rows.min(axis=0).max())
    return np.minimum(between, between.T), radius, min(2 * rows.max(axis=1).min(), between.max() + 2 * radius)


def measured_in_part(pairs: np.ndarray, X: Any, Y: Any) -> float:
    """Half the largest disagreement of some pairs of vertices with all pairs: at most half the distortion."""
    some = pairs[np.random.default_rng(3).choice(len(pairs), SOME_ROWS // 100)]
    DX, DY = (rinow.geodesic_distances(m, p, method="edges") for m, p in ((X, some[:, 0]), (Y, some[:, 1])))
    return max(float(np.abs(a[pairs[:, 0]] - b[pairs[:, 1]]).max()) for a, b in zip(DX, DY, strict=True)) / 2


def measured_again(pairs: np.ndarray, X: Any, Y: Any, covering_radii: tuple[float, float]) -> float:
    """Upper bound by a correspondence: half its distortion, and how far other points are from those in it at most."""
    if isinstance(X, rinow.MetricSpace):
        return rinow.distortion(pairs, X, Y) / 2 + max(covering_radii)
    if len(pairs) > SOME_ROWS:
        return measured_in_part(pairs, X, Y)
    (xs, i), (ys, j) = (np.unique(side, return_inverse=True) for side in pairs.T)
    (DX, *x), (DY, *y) = measured_on(X, xs), measured_on(Y, ys)
    radius, diameter = max(x[0], y[0]), max(x[1], y[1])
    half = max(float(np.abs(DX[a, i] - DY[b, j]).max()) for a, b in zip(i, j, strict=True)) / 2
    return min(half + radius, diameter / 2) if radius > 0 else half


def show(
    name: str,
    seed: int,
    seconds: float,
    X: Any,
    Y: Any,
    covering_radii: tuple[float, float] = (0.0, 0.0),
    *,
    verify: bool = False,
) -> dict[str, Any]:
    """Compare two spaces and print one line; what it says."""
    start = time.perf_counter()
    if name.startswith("d_L"):
        result: Any = rinow.lipschitz_distance(X, Y, time_limit=seconds, verify=verify)
        spent = time.perf_counter() - start
        f = result.bijection
        measured = math.log(max(rinow.dilatation(f, X, Y), rinow.dilatation(np.argsort(f), Y, X)))
    else:
        result = rinow.gromov_hausdorff(X, Y, time_limit=seconds, covering_radii=covering_radii, verify=verify)
        spent = time.perf_counter() - start
        measured = measured_again(result.correspondence, X, Y, covering_radii)
    in_part = not name.startswith("d_L") and len(result.correspondence) > SOME_ROWS
    if measured > result.upper * (1 + 1e-12) if in_part else measured != result.upper:
        raise SystemExit(f"{name}: the certificate gives {measured}, not {result.upper}")
    row: dict[str, Any] = {"name": name, "seed": seed, "lower": result.lower, "upper": result.upper}
    row |= {"exact": result.exact, "by": result.lower_bound_by, "seconds": round(spent, 2), "limit": seconds}
    if not isinstance(X, rinow.MetricSpace):  # the peak of the process so far
        row["GiB"] = round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20, 2)
    state = "exact" if result.exact else f"ratio {result.upper / result.lower if result.lower else math.inf:.4f}"
    notes = (f"{row['GiB']} GiB" if "GiB" in row else "") + "  proof checked" * bool(result.proof_checked)
    print(
        f"{name:24s} {seed:2d} {result.lower:11.6f} {result.upper:11.6f} {state:14s} "
        f"{result.lower_bound_by:18s} {spent:6.1f} s {notes}",
        flush=True,
    )
    return row


def main() -> None:
    """Run the groups that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("groups", nargs="*", default=list(GROUPS))
    parser.add_argument("--seeds", type=int, nargs="+", default=list(range(5)))
    parser.add_argument("--only", default="", help="text in the names of the instances")
    parser.add_argument("--seconds", type=float, help="for each instance, instead of those of its group")
    parser.add_argument("--page", action="store_true")
    parser.add_argument("--verify", action="store_true", help="check the proofs of the clause-learning solver")
    options = parser.parse_args()
    rng = np.random.default_rng(2)
    for small in (12, 90):  # warms the kernels, serial and parallel
        rinow.gromov_hausdorff(cloud(rng, small), cloud(rng, small), time_limit=5)
        rinow.lipschitz_distance(cloud(rng, small), cloud(rng, small), time_limit=2)
    rinow.gromov_hausdorff(hops(GRAPHS["G(n,.05)"](40, 7)), hops(GRAPHS["G(n,.05)"](40, 8)), time_limit=5)
    for group in options.groups:
        instances, limit = GROUPS[group]
        seconds = limit if options.seconds is None else options.seconds
        wanted = ((seed, *row) for seed in options.seeds for row in instances(seed) if options.only in row[0])
        for seed, name, *spaces in wanted:
            row = show(name, seed, seconds, *spaces, verify=options.verify)
            if options.page:
                write_page(Path(__file__).parents[1], group, [row])


if __name__ == "__main__":
    main()
