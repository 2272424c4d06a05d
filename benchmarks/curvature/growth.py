"""Speed and memory of curvature as meshes grow: each case in a process of its own.

    python benchmarks/bench_curvature.py --growth [n ...]

The mesh is the irregular torus.  `mesh` is the memory of its adjacency, which `TriangleMesh` keeps; `extra` is the peak
above positions, faces and adjacency, result included; the rate counts the adjacency, as a first call makes it, and is
the best of some runs.
"""

from __future__ import annotations

import json
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
from estimators import libigl_quadric
from surfaces import surfaces, triangulation

SIZES = (16_000, 64_000, 256_000, 1_000_000)
CASES: dict[str, dict[str, Any]] = {
    "best": {"quality": "best"},
    "fast": {"quality": "fast"},
    "intrinsic": {"method": "intrinsic"},
}
PEER = "libigl, 2 rings"
MIB = 2.0**20
INTERVAL = 0.002
"""Seconds between two looks at the memory."""
MOST_RUNS, LONG = 5, 300_000
"""Runs of small cases; from so many vertices on one is enough."""


class Peak:
    """The most resident memory while a block runs, in MiB above that at its beginning."""

    def __init__(self) -> None:
        import psutil

        self.process = psutil.Process()
        self.over = threading.Event()

    def __enter__(self) -> Peak:
        self.first = self.most = self.process.memory_info().rss
        self.watch = threading.Thread(target=self._look)
        self.watch.start()
        return self

    def _look(self) -> None:
        while not self.over.wait(INTERVAL):
            self.most = max(self.most, self.process.memory_info().rss)

    def __exit__(self, *_: object) -> None:
        self.over.set()
        self.watch.join()
        self.most = max(self.most, self.process.memory_info().rss)

    @property
    def mib(self) -> float:
        """The rise."""
        return (self.most - self.first) / MIB


def measure(case: str, n: int, noise: float) -> dict[str, float]:
    """Rate and memory of one case, after a small mesh has compiled the kernels."""
    small = triangulation(surfaces()["torus"], "irregular", 2000, noise=noise)
    mesh = triangulation(surfaces()["torus"], "irregular", n, noise=noise)
    V, F = np.ascontiguousarray(mesh.vertices), np.ascontiguousarray(mesh.faces)
    if case == PEER:
        return {"rate": n / least_seconds(lambda: libigl_quadric(2)(V, F), n)}
    import rinow

    options = CASES[case]
    rinow.surface_curvature((small.vertices, small.faces), **options)
    with Peak() as adjacency:
        surface = rinow.TriangleMesh(V, F)
        _ = surface.topology.partners, surface.topology.vertex_is_manifold, surface.topology.neighbours
    with Peak() as curvature:
        rinow.surface_curvature(surface, **options)
    del surface
    rate = n / least_seconds(lambda: rinow.surface_curvature((V, F), **options), n)
    return {"rate": rate, "mesh": adjacency.mib, "extra": curvature.mib}


def least_seconds(action: Any, n: int) -> float:
    """The shortest wall time of some runs."""
    times: list[float] = []
    for _ in range(MOST_RUNS if n < LONG else 1):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return min(times)


def show_growth(sizes: list[int], noise: float, cases: list[str]) -> None:
    """Print the table; a case that ends its process, as for lack of memory, is left out."""
    print(f"| {'n':>9} | {'case':<15} | {'vertices/s':>10} | {'mesh MiB':>8} | {'extra MiB':>9} |")
    print(f"|{'-' * 11}|{'-' * 17}|{'-' * 12}|{'-' * 10}|{'-' * 11}|")
    for n in sizes:
        for case in cases:
            command = [sys.executable, str(Path(__file__)), case, str(n), str(noise)]
            answer = subprocess.run(command, stdout=subprocess.PIPE, text=True)
            if answer.returncode:
                continue
            found = json.loads(answer.stdout)
            memory = [f"{found[k]:.0f}" if k in found else "" for k in ("mesh", "extra")]
            print(f"| {n:>9,} | {case:<15} | {found['rate']:>10,.0f} | {memory[0]:>8} | {memory[1]:>9} |", flush=True)


if __name__ == "__main__":
    print(json.dumps(measure(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]))))
