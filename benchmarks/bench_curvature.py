"""Accuracy and speed of curvature on analytic surfaces, beside every tool on PyPI that installs.

    python benchmarks/bench_curvature.py                # everything: docs/reference/benchmark.md and its pictures
    python benchmarks/bench_curvature.py --only rinow VTK --sizes 1000 4000
    python benchmarks/bench_curvature.py --growth       # speed and memory from 16,000 to 1,000,000 vertices

Every estimator sees the same meshes with the settings of its name and runs in a process of its own.  The error is the
relative root mean square over the vertices off the border, weighted by area; the tables have geometric means over the
surfaces.  The vertices are on the surfaces exactly, and so are the curvatures compared with.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent / "curvature"))
from estimators import ESTIMATORS, third_areas, version
from growth import CASES, PEER, SIZES, show_growth
from report import write_report
from surfaces import STYLES, Mesh, has, surfaces, triangulation

HERE = Path(__file__).parent
DOCS = HERE.parent / "docs"
NOISE = (0.01, 0.05, 0.1)
NOISY_STYLE, NOISY_SIZE = "irregular", 4000
TIME_LIMIT = 1800.0
"""Seconds for all meshes of one estimator."""


def cells(sizes: list[int]) -> list[dict[str, Any]]:
    """All meshes without noise, the largest irregular ones only, then noise on irregular ones."""
    clean = [
        {"surface": s.name, "style": style, "n": n, "noise": 0.0}
        for s in surfaces().values()
        for style in STYLES
        if has(s, style)
        for n in sizes
        if style == NOISY_STYLE or n != sizes[-1] or len(sizes) < 3
    ]
    n = NOISY_SIZE if NOISY_SIZE in sizes else sizes[-1]
    noisy = [{"surface": s, "style": NOISY_STYLE, "n": n, "noise": x} for s in surfaces() for x in NOISE]
    return clean + noisy


def mesh_of(cell: dict[str, Any]) -> Mesh:
    """The mesh of a cell; the seed is the same for all estimators."""
    return triangulation(surfaces()[cell["surface"]], cell["style"], cell["n"], noise=cell["noise"])


def answers(name: str, folder: Path) -> None:
    """Run an estimator over the folder, again after each crash, until every mesh was tried."""
    for path in (*folder.glob("*.answer.npz"), *folder.glob("*.tried")):
        path.unlink()
    n_meshes = len(list(folder.glob("*.mesh.npz")))
    command = [sys.executable, str(HERE / "curvature" / "estimators.py"), name, str(folder)]
    while len(list(folder.glob("*.tried"))) < n_meshes:
        before = len(list(folder.glob("*.tried")))
        try:
            status = subprocess.run(command, stdout=subprocess.DEVNULL, timeout=TIME_LIMIT).returncode
        except subprocess.TimeoutExpired:
            status = "time limit"
        if status:
            print(f"{name}: ended with {status}", file=sys.stderr)
        if len(list(folder.glob("*.tried"))) == before:
            return  # not even started: the package is broken


def relative_error(found: np.ndarray, exact: np.ndarray, weights: np.ndarray) -> float:
    """Weighted root mean square of the error over that of the exact values; a value that is none counts as 0."""
    error = np.where(np.isfinite(found), found, 0.0) - exact
    return float(np.sqrt(np.sum(weights * error**2) / np.sum(weights * exact**2)))


def run(names: list[str], sizes: list[int], speed_sizes: list[int]) -> dict[str, Any]:
    """Errors and times of the estimators on all cells."""
    every = cells(sizes)
    results: dict[str, Any] = {"cells": every, "errors": {}, "speed": {}, "versions": {}}
    with tempfile.TemporaryDirectory() as name_of_folder:
        folder = Path(name_of_folder)
        meshes = [mesh_of(cell) for cell in every]
        _save(folder / "0000-warm.mesh.npz", triangulation(surfaces()["torus"], "irregular", 500))
        for i, mesh in enumerate(meshes):
            _save(folder / f"{i + 1:04d}.mesh.npz", mesh)
        for n in speed_sizes:
            _save(folder / f"9{n:09d}.mesh.npz", triangulation(surfaces()["torus"], "irregular", n))
        for name in names:
            package = ESTIMATORS[name][0]
            if version(package) is None:
                print(f"{name}: {package} is not installed", file=sys.stderr)
                continue
            answers(name, folder)
            results["versions"][package] = version(package)
            results["errors"][name] = [_errors(folder / f"{i + 1:04d}.answer.npz", m) for i, m in enumerate(meshes)]
            results["speed"][name] = {str(n): _rate(folder / f"9{n:09d}.answer.npz") for n in speed_sizes}
            print(f"{name}: done", file=sys.stderr)
            if all(not errors for errors in results["errors"][name]):
                del results["errors"][name], results["speed"][name]
    return results


def _save(path: Path, mesh: Mesh) -> None:
    np.savez(path, V=mesh.vertices, F=mesh.faces)


def _errors(path: Path, mesh: Mesh) -> dict[str, float]:
    if not path.exists():
        return {}
    weights = third_areas(mesh.vertices, mesh.faces) * mesh.interior
    exact = {"K": mesh.gaussian, "H": mesh.mean}
    with np.load(path) as found:
        known = [q for q in "KH" if q in found and np.isfinite(found[q]).any()]
        return {q: relative_error(found[q], exact[q], weights) for q in known}


def _rate(path: Path) -> float | None:
    if not path.exists():
        return None
    with np.load(path) as found:
        return len(found["K"]) / float(found["seconds"])


def main() -> None:
    """Parse the command line, run and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="*", help="start of the names of the estimators to run")
    parser.add_argument("--sizes", nargs="*", type=int, default=[1000, 4000, 16000])
    parser.add_argument("--speed-sizes", nargs="*", type=int, default=[64000])
    parser.add_argument("--docs", type=Path, default=DOCS, help="folder to write reference/benchmark.md and images/ to")
    parser.add_argument("--from-json", type=Path, help="write the report of an earlier run again")
    parser.add_argument("--growth", nargs="*", type=int, help="only the table of speed and memory, for these sizes")
    parser.add_argument("--noise", type=float, default=0.0, help="noise of the meshes of --growth, over the mean edge")
    arguments = parser.parse_args()
    if arguments.growth is not None:
        show_growth(arguments.growth or list(SIZES), arguments.noise, arguments.only or [*CASES, PEER])
        return
    kept = HERE / "curvature" / "results.json"
    if arguments.from_json:
        results = json.loads(arguments.from_json.read_text())
    else:
        names = [n for n in ESTIMATORS if not arguments.only or n.startswith(tuple(arguments.only))]
        results = run(names, arguments.sizes, arguments.speed_sizes)
        results["machine"] = f"{os.cpu_count()} cores, {platform.system()}, Python {platform.python_version()}"
        kept.write_text(json.dumps(results, indent=0))
    print(write_report(results, arguments.docs))


if __name__ == "__main__":
    main()
