"""Hausdorff distance of surfaces beside libigl (vertices against a surface) and MeshLab (samples against a surface).

    python benchmarks/bench_hausdorff.py [n_faces] [--meshlab]

Every pair has two meshes of `n_faces` faces (100,000 by default).  rinow gives an interval of width 1e-4 of the
diagonal at most, that contains the distance; the others give one number that is at most the distance.  Times are those
of one call after a call on small meshes, reading of files not included.  A peer runs in a process of its own and has
60 seconds for each pair; MeshLab is asked only on request.
"""

from __future__ import annotations

import multiprocessing
import sys
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any

import numpy as np
from _mesh import jittered_torus

import rinow

Mesh = tuple[np.ndarray, np.ndarray]

LIMIT = 60.0
"""Seconds after which a peer is stopped."""


def fibonacci_sphere(n: int, radius: float, turn: float) -> Mesh:
    """Convex hull of n points spread evenly over a sphere."""
    from scipy.spatial import ConvexHull

    i = np.arange(n) + 0.5
    z, u = 1 - 2 * i / n, np.pi * (1 + 5**0.5) * i + turn
    s = np.sqrt(1 - z * z)
    V = np.stack([s * np.cos(u), s * np.sin(u), z], axis=1)
    return radius * V, ConvexHull(V).simplices.astype(np.int64)


def pairs(n_vertices: int) -> dict[str, tuple[Mesh, Mesh]]:
    """Pairs that nearly coincide, run parallel, cross, are far apart or the same, or lie deep inside one another."""
    torus, other = jittered_torus(n_vertices), jittered_torus(n_vertices, seed=21)
    sphere, other_sphere = (fibonacci_sphere(n_vertices, 1.0, turn) for turn in (0.0, 1.0))
    h = np.sqrt(4 * np.pi / n_vertices)
    shift = np.array([0.3, -0.1, 0.2])
    noise = np.random.default_rng(20).normal(size=torus[0].shape)

    def inside(size: float) -> Mesh:
        """A sphere near the centre of the other one, of which all points are nearly as far from it."""
        return size * (other_sphere[0] + shift), other_sphere[1]

    def with_shell(size: float) -> Mesh:
        """The same together with a sphere around the other one, half of the faces each."""
        V, F = fibonacci_sphere(n_vertices // 2, 1.0, 1.0)
        return np.concatenate([1.2 * V, size * (V + shift)]), np.concatenate([F, F + len(V)])

    return {
        "two meshes of one torus": (torus, other),
        "torus and noisy torus": (torus, (torus[0] + 0.2 * h * noise, torus[1])),
        "spheres of radius 1, 1.001": (sphere, fibonacci_sphere(n_vertices, 1.001, 1.0)),
        "spheres of radius 1, 1.1": (sphere, fibonacci_sphere(n_vertices, 1.1, 1.0)),
        "spheres of radius 1, 2": (sphere, fibonacci_sphere(n_vertices, 2.0, 1.0)),
        "sphere and torus": (sphere, torus),
        "torus and shifted torus": (torus, (torus[0] + 0.05, torus[1])),
        "torus and itself": (torus, torus),
        **{f"sphere, {size:g} of it inside": (inside(size), sphere) for size in (0.1, 1e-2, 1e-4, 1e-6)},
        "sphere, inside and around it": (with_shell(1e-4), sphere),
    }


def libigl(A: Mesh, B: Mesh) -> float:
    """Greatest distance of a vertex from the other surface."""
    import igl

    return float(igl.hausdorff(A[0], A[1].astype(np.int64), B[0], B[1].astype(np.int64)))


def meshlab(A: Mesh, B: Mesh) -> float:
    """Greatest distance of a sample, vertices, edges and faces, from the other surface, in both directions."""
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    for V, F in (A, B):
        meshes.add_mesh(pymeshlab.Mesh(V, F.astype(np.int32)))
    return max(
        meshes.get_hausdorff_distance(
            sampledmesh=i, targetmesh=1 - i, sampleedge=True, sampleface=True, samplenum=10 * len(A[0])
        )["max"]
        for i in (0, 1)
    )


def timed(action: Callable[[Mesh, Mesh], Any], A: Mesh, B: Mesh) -> tuple[Any, float]:
    """Result and wall seconds."""
    start = time.perf_counter()
    return action(A, B), time.perf_counter() - start


def answer(peer: Callable[[Mesh, Mesh], float], A: Mesh, B: Mesh, out: Connection) -> None:
    """Send the cell of a peer, timed after a call on small meshes."""
    try:
        timed(peer, *pairs(500)["two meshes of one torus"])
        value, seconds = timed(peer, A, B)
        out.send(f"{value:10.8f} {seconds:6.2f}")
    except ImportError:
        out.send("not installed")


def cell_of(peer: Callable[[Mesh, Mesh], float], A: Mesh, B: Mesh) -> str:
    """What a peer says and how long it takes, or that it does not answer."""
    here, there = multiprocessing.Pipe(duplex=False)
    process = multiprocessing.get_context("spawn").Process(target=answer, args=(peer, A, B, there))
    process.start()
    there.close()
    try:
        text = here.recv() if here.poll(LIMIT) else f"none in {LIMIT:g} s"
    except EOFError:
        text = "crashed"
    process.kill()
    process.join()
    return f"{text:>17}"


def main() -> None:
    """Print one line for each pair."""
    numbers = [word for word in sys.argv[1:] if word.isdigit()]
    n = (int(numbers[0]) if numbers else 100_000) // 2
    peers = [libigl, meshlab] if "--meshlab" in sys.argv else [libigl]
    timed(rinow.hausdorff_distance, *pairs(500)["two meshes of one torus"])
    head = "".join(f" {peer.__name__:>10} {'s':>6}" for peer in peers)
    print(f"{'pair':28} {'rinow, certified':>24} {'width/diag':>10} {'s':>6}{head}")
    for name, (A, B) in pairs(n).items():
        result, seconds = timed(rinow.hausdorff_distance, A, B)
        diagonal = max(np.linalg.norm(np.ptp(V, axis=0)) for V, _ in (A, B))
        width = (result.upper - result.lower) / diagonal
        cells = [f"{name:28} [{result.lower:.8f}, {result.upper:.8f}] {width:10.1e} {seconds:6.2f}"]
        cells += [cell_of(peer, A, B) for peer in peers]
        print(*cells, flush=True)


if __name__ == "__main__":
    main()
