"""Triangulations converge to their surface: sphere, torus, and a real mesh with its simplifications.

    python examples/convergence.py [folder]

Prints the certified intervals of the Hausdorff, Gromov-Hausdorff and Lipschitz distances from the limit, and writes one
plot for each surface into the folder (the current one by default).
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull

from rinow.io.mesh_files import demo_mesh
from rinow.mesh import TriangleMesh
from rinow.report.convergence import convergence_figure
from rinow.study.convergence import COLUMNS, ConvergenceStudy, study_meshes


def sphere(n: int) -> TriangleMesh:
    """Convex hull of n points spread evenly over the unit sphere."""
    i = np.arange(n) + 0.5
    z, u = 1 - 2 * i / n, np.pi * (1 + 5**0.5) * i
    s = np.sqrt(1 - z * z)
    V = np.stack([s * np.cos(u), s * np.sin(u), z], axis=1)
    return TriangleMesh(V, ConvexHull(V).simplices)


def torus(n: int) -> TriangleMesh:
    """Torus with the radii 1 and 0.4, from a grid of 2.5 n by n points."""
    m = 5 * n // 2
    i, j = (g.ravel() for g in np.meshgrid(np.arange(m), np.arange(n), indexing="ij"))
    u, v = 2 * np.pi * i / m, 2 * np.pi * j / n
    w = 1 + 0.4 * np.cos(v)
    V = np.stack([w * np.cos(u), w * np.sin(u), 0.4 * np.sin(v)], axis=1)
    a, b = i * n + j, (i + 1) % m * n + j
    c, d = (i + 1) % m * n + (j + 1) % n, i * n + (j + 1) % n
    return TriangleMesh(V, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]))


def simplified(mesh: TriangleMesh, cells: int) -> TriangleMesh:
    """Vertices in one cell of a grid become one, their mean; faces that lose a corner disappear."""
    V = mesh.vertices
    size = np.ptp(V, axis=0).max() / cells
    _, label = np.unique(np.floor((V - V.min(axis=0)) / size).astype(np.intp), axis=0, return_inverse=True)
    label = label.ravel()
    counts = np.bincount(label)
    W = np.stack([np.bincount(label, V[:, k]) / counts for k in range(3)], axis=1)
    F = label[mesh.faces]
    F = F[(F != np.roll(F, 1, axis=1)).all(axis=1)]
    _, first = np.unique(np.sort(F, axis=1), axis=0, return_index=True)
    used, F = np.unique(F[np.sort(first)], return_inverse=True)
    return TriangleMesh(W[used], F.reshape(-1, 3))


def report(name: str, study: ConvergenceStudy, folder: Path) -> None:
    """Print the intervals and draw them."""
    print(f"\n{name}\n{'vertices':>9} {'longest edge':>12}" + "".join(f" {column:>24}" for column in COLUMNS))
    for i, (n, h) in enumerate(zip(study.n_points, study.scale, strict=True)):
        cells = ("[{:.6f}, {:.6f}]".format(*getattr(study, column)[i]) for column in COLUMNS)
        print(f"{n:9,} {h:12.5f}" + "".join(f" {cell:>24}" for cell in cells))
    print("order" + " " * 17 + "".join(f" {order:24.2f}" for order in study.orders().values()))
    intervals = {text: getattr(study, column) for column, text in COLUMNS.items()}
    figure = convergence_figure(study.scale, intervals, label="longest edge", title=name)
    figure.savefig(folder / f"convergence-{name.split()[0]}.png")


def main() -> None:
    """All three surfaces."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    spheres = [sphere(n) for n in (50, 150, 450, 1350)]
    report("sphere against one of 4,000 vertices", study_meshes(spheres, sphere(4000), max_points=1700), folder)
    tori = [torus(n) for n in (8, 12, 18, 26)]
    report("torus against one of 4,000 vertices", study_meshes(tori, torus(40), max_points=1700), folder)
    spot = demo_mesh()
    meshes = [simplified(spot, cells) for cells in (8, 14, 24, 40)]
    report("spot and its simplifications", study_meshes(meshes, spot, max_points=1700), folder)


if __name__ == "__main__":
    main()
