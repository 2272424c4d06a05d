"""Speed and memory of reading a mesh and of its curvature, beside VTK and libigl where they are installed.

    python benchmarks/bench_surface.py [n_vertices]

Prints one line a figure: the median of several runs in one process; read the ratios rather than the seconds.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from _mesh import jittered_torus, torus_curvature
from _timing import median_seconds

import rinow

RUNS = 5


def bench_reading(path: Path) -> None:
    """Time the reader alone and with the adjacency of the faces."""

    def read() -> Any:
        return rinow.read_mesh(path)

    def read_and_join() -> Any:
        return rinow.read_mesh(path).topology.partners

    print(f"read_mesh                       {median_seconds(read):8.3f} s")
    print(f"read_mesh and adjacency         {median_seconds(read_and_join):8.3f} s")


def bench_methods(V: np.ndarray, F: np.ndarray) -> None:
    """Time each method on a checked mesh with cached adjacency, and hold its values against the exact ones."""
    exact = torus_curvature(V)
    rates = {}
    for method in ("angle_defect", "lifted", "wald", "sectional"):

        def fresh() -> Any:
            """A checked mesh whose adjacency is known and nothing else."""
            mesh = rinow.TriangleMesh(V, F)
            t = mesh.topology
            _ = t.partners, t.vertex_is_manifold, t.neighbours
            return mesh

        rinow.surface_curvature(fresh(), method=method)
        times = []
        for _ in range(3):
            mesh = fresh()
            start = time.perf_counter()
            result = rinow.surface_curvature(mesh, method=method)
            times.append(time.perf_counter() - start)
        rates[method] = len(V) / statistics.median(times)
        error = np.sqrt(np.mean((result.gaussian - exact) ** 2) / np.mean(exact**2))
        print(f"rinow {method:13s}             {rates[method] / 1e6:8.2f} M vertices/s   relative error {error:.2e}")
    bench_peers(V, F, rates["angle_defect"])


def bench_peers(V: np.ndarray, F: np.ndarray, ours: float) -> None:
    """Time the angle defects of VTK and libigl."""
    try:
        import pyvista

        surface = pyvista.PolyData.from_regular_faces(V, F)
        rate = len(V) / median_seconds(lambda: surface.curvature("gaussian"), 3)
        print(f"VTK Gauss curvature             {rate / 1e6:8.2f} M vertices/s   ours/theirs {ours / rate:.1f}")
    except ImportError:
        print("VTK: not installed")
    try:
        import igl

        def defect() -> Any:
            mass = igl.massmatrix(V, F, igl.MASSMATRIX_TYPE_VORONOI).diagonal()
            return igl.gaussian_curvature(V, F) / mass

        rate = len(V) / median_seconds(defect, 3)
        print(f"libigl gaussian_curvature       {rate / 1e6:8.2f} M vertices/s   ours/theirs {ours / rate:.1f}")
    except ImportError:
        print("libigl: not installed")


def run_command(*arguments: str) -> tuple[float, float]:
    """Wall seconds and peak memory in GiB of one command."""
    start = time.perf_counter()
    process = subprocess.Popen(arguments, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"{arguments[0]} failed")
    return time.perf_counter() - start, usage.ru_maxrss / 2**20


def bench_command_line(path: Path) -> None:
    """Memory on a big file, start-up time on a small one."""
    rinow_command = str(Path(sys.executable).with_name("rinow"))
    seconds, memory = run_command(rinow_command, "curvature", str(path), "-o", str(path.with_name("out.ply")))
    print(f"rinow curvature, {path.stat().st_size >> 20} MiB file    {seconds:8.2f} s  peak memory {memory:.2f} GiB")
    spot = str(Path(rinow.__file__).parent / "io" / "_assets" / "spot.ply")
    for _ in range(2):
        ours = statistics.median(run_command(rinow_command, "curvature", spot)[0] for _ in range(RUNS))
    base = statistics.median(
        run_command(sys.executable, "-c", "import numba, scipy.spatial, trimesh")[0] for _ in range(RUNS)
    )
    limit = 1.5 * base + 1.0
    print(f"warm rinow curvature spot       {ours:8.2f} s  imports alone {base:.2f} s  limit 1.5 x + 1 = {limit:.2f} s")
    bare = statistics.median(run_command(sys.executable, "-c", "pass")[0] for _ in range(RUNS))
    lazy = statistics.median(run_command(sys.executable, "-c", "import rinow")[0] for _ in range(RUNS))
    print(f"import rinow                    {lazy - bare:8.3f} s above a bare interpreter")


def main() -> None:
    """Run everything."""
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "torus.ply"
        # The commands come first: a child's peak memory starts from that of the process that forks it.
        subprocess.run([sys.executable, __file__, "--write", str(n), str(path)], check=True)
        bench_command_line(path)
        V, F = jittered_torus(n)
        print(f"torus, {len(V):,} vertices, {len(F):,} faces, {os.cpu_count()} cores")
        bench_reading(path)
        bench_methods(V, F)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--write"]:
        rinow.write_mesh(sys.argv[3], rinow.TriangleMesh(*jittered_torus(int(sys.argv[2]))))
    else:
        main()
