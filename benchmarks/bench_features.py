"""Precision and recall of creases, corners and cone points on generated parts, and curvature beside creases.

    python benchmarks/bench_features.py features [n_seeds]
    python benchmarks/bench_features.py curvature [n_seeds]
    python benchmarks/bench_features.py smooth [mesh files ...]
    python benchmarks/bench_features.py speed [mesh files ...]

Each part is turned at random.  Noise is normal on every coordinate; its standard deviation is a share of the mean edge
of a remeshed part, and at each vertex of a coarse one, without vertices inside its sides, of the shortest edge there.
"""

from __future__ import annotations

import statistics
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent / "curvature"))
sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))
from _kinds import COARSE_LIMIT, KINDS
from _mesh import jittered_torus
from _parts import Floats, Part, Sampling, lathe
from surfaces import has, surfaces, triangulation

import parts
import rinow
import shapes

SPACINGS = (0.2, 0.12, 0.07, np.inf)
NOISE = (0.0, 0.005, 0.01, 0.02)
ENOUGH = 0.95
RINGS_BESIDE = 2


def part_of(name: str, spacing: float, noise: float, seed: int) -> Part:
    """A part of a kind, turned, with noise."""
    rng = np.random.default_rng(1000 + seed)
    part = KINDS[name](Sampling(spacing, rng))
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    Q[:, 0] *= np.sign(np.linalg.det(Q))
    ends = part.vertices[part.faces]
    lengths = np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2)
    local = np.full(len(part.vertices), lengths.mean())
    if np.isinf(spacing):
        local[:] = np.inf
        for k in (0, 1, 2):
            np.minimum.at(local, part.faces[:, k], np.minimum(lengths[:, k], lengths[:, (k + 1) % 3]))
    V = part.vertices + noise * local[:, None] * rng.normal(size=part.vertices.shape)
    return part._replace(vertices=V @ Q.T)


def cases(name: str, n_seeds: int) -> list[tuple[float, int]]:
    """Spacings and seeds of a kind."""
    coarse = not name.startswith("prism") or int(name.split()[1]) <= COARSE_LIMIT
    return [(h, seed) for h in SPACINGS if np.isfinite(h) or coarse for seed in range(n_seeds)]


# ------------------------------------------------------------------ features


def counts(found: np.ndarray, true: np.ndarray) -> np.ndarray:
    """Numbers of found, true and common items."""
    a, b = ({tuple(np.atleast_1d(x)) for x in rows} for rows in (found, true))
    return np.array([len(a), len(b), len(a & b)])


def measured(part: Part) -> np.ndarray:
    """Counts of creases, corners and cone points."""
    found = rinow.singular_features((part.vertices, part.faces))
    pairs = (found.crease_edges, part.creases), (found.corners, part.corners), (found.cone_points, part.cone_points)
    return np.stack([counts(a, b) for a, b in pairs])


def shown(c: np.ndarray) -> str:
    """Precision and recall."""
    P, R = (c[2] / n if n else 1.0 for n in c[:2])
    text = f"{P:.2f} {R:.2f}"
    return f"**{text}**" if min(P, R) < ENOUGH else text


def bench_features(n_seeds: int) -> None:
    """Print tables of precision and recall, and the worst parts."""
    sums = np.zeros((len(KINDS), len(NOISE), 2, 3, 3), int)
    worst = []
    for k, name in enumerate(KINDS):
        for i, noise in enumerate(NOISE):
            for h, seed in cases(name, n_seeds):
                c = measured(part_of(name, h, noise, seed))
                sums[k, i, int(np.isinf(h))] += c
                share = c[:, 2] / np.maximum(c[:, :2].max(axis=1), 1)
                share[c[:, :2].max(axis=1) == 0] = 1.0
                worst += [(share[j], what, name, h, noise, seed, *c[j]) for j, what in enumerate(WHAT)]
    for j, what in enumerate(WHAT):
        for coarse in (0, 1):
            print(f"\n{what}, {'coarse' if coarse else 'remeshed'}: precision and recall\n")
            print("| part | " + " | ".join(f"noise {x:.1%}" for x in NOISE) + " |\n|---" + "|---:" * len(NOISE) + "|")
            for k, name in enumerate(KINDS):
                if sums[k, :, coarse, j, :2].any():
                    print(f"| {name} | " + " | ".join(shown(sums[k, i, coarse, j]) for i in range(len(NOISE))) + " |")
            print("| all | " + " | ".join(shown(sums[:, i, coarse, j].sum(axis=0)) for i in range(len(NOISE))) + " |")
    print("\nworst: share, what, part, spacing, noise, seed, found, true, common")
    for row in sorted(worst)[:40]:
        if row[0] < ENOUGH:
            print(f"{row[0]:.2f}", *row[1:])


WHAT = ("creases", "corners", "cone points")


# ------------------------------------------------------------------ curvature


def rings_to_crease(part: Part) -> np.ndarray:
    """Edges from each vertex to the next crease, at most nine."""
    steps = np.where(np.isnan(part.mean), 0, 9)
    for _ in range(9):
        least = steps[part.faces].min(axis=1) + 1
        for k in range(3):
            np.minimum.at(steps, part.faces[:, k], least)
    return steps


def bench_curvature(n_seeds: int) -> None:
    """Print errors of curvature beside creases and inside, times powers of the mean edge."""
    print("| part, spacing | quality | noise | " + " | ".join(COLUMNS) + " |")
    print("|---|---|---" + "|---:" * len(COLUMNS) + "|")
    for name in KINDS:
        for quality in ("best", "fast"):
            for noise in (0.0, 0.01, 0.02):
                errors = [curvature_errors(part_of(name, 0.1, noise, seed), quality) for seed in range(n_seeds)]
                cells = " | ".join(f"{x:.3g}" for x in np.median(errors, axis=0))
                print(f"| {name} | {quality} | {noise:.0%} | {cells} |", flush=True)


COLUMNS = ("median ΔK s² beside", "95 %", "inside", "95 %", "median ΔH s beside", "95 %", "inside", "95 %", "nan")


def curvature_errors(part: Part, quality: str) -> list[float]:
    """Median and 95 % of the errors of K and H, times the squared mean edge and the edge, and the share without any."""
    found = rinow.surface_curvature((part.vertices, part.faces), quality=quality)
    mesh = rinow.TriangleMesh(part.vertices, part.faces)
    steps, s = rings_to_crease(part), mesh.mean_edge_length
    values = []
    for error in (np.abs(found.gaussian - part.gaussian) * s * s, np.abs(found.mean - part.mean) * s):
        for chosen in ((steps > 0) & (steps <= RINGS_BESIDE), steps > RINGS_BESIDE):
            e = error[chosen & np.isfinite(error)]
            values += [*np.percentile(e, [50, 95])] if len(e) else [np.nan, np.nan]
    return [*values, float(np.mean(np.isnan(found.gaussian[steps > 0])))]


# ------------------------------------------------------------------ negatives and speed


def folds(n: int = 6000, seed: int = 5) -> shapes.Shape:
    """A sphere with folds a tenth of its radius deep and a quarter wide."""
    sphere = shapes.irregular_sphere(n, seed=seed)
    rng = np.random.default_rng(seed)
    waves = rng.normal(size=(24, 3))
    waves *= 14.0 / np.linalg.norm(waves, axis=1)[:, None]
    height = np.cos(sphere.vertices @ waves.T + rng.uniform(0, 6.3, 24)).sum(axis=1) / np.sqrt(24.0)
    return shapes.without_curvature(sphere.vertices * (1.0 + 0.08 * height)[:, None], sphere.faces)


def smooth_meshes() -> dict[str, tuple[Floats, np.ndarray]]:
    """Surfaces without features."""
    found = {}
    for surface in surfaces().values():
        for style in (style for style in ("irregular", "regular") if has(surface, style)):
            mesh = triangulation(surface, style, 4000, seed=3)
            found[f"{surface.name}, {style}"] = mesh.vertices, mesh.faces
    found["rounded box"] = parts.rounded_box(26)[:2]
    found["folds"] = folds()[:2]
    return found


def bench_smooth(paths: list[str]) -> None:
    """Print the number of creases, corners and cone points of smooth surfaces with noise, where there is any."""
    meshes = smooth_meshes()
    for path in paths:
        mesh = rinow.read_mesh(path)
        meshes[Path(path).stem] = mesh.vertices, mesh.faces
    for name, (V, F) in meshes.items():
        ends = V[F]
        h = np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2).mean()
        row = []
        for noise in (0.0, 0.01, 0.02, 0.05, 0.1):
            W = V + noise * h * np.random.default_rng(7).normal(size=V.shape)
            found = rinow.singular_features((W, F))
            row.append(f"{len(found.crease_edges)}/{len(found.corners)}/{len(found.cone_points)}")
        print(f"| {name} | " + " | ".join(row) + " |", flush=True)


def bench_speed(paths: list[str]) -> None:
    """Print vertices per second."""
    meshes = {"torus": jittered_torus(100_000), "box": shapes.box(120)[:2]}
    meshes |= {"cylinder": lathe([(0, 0), (1, 0), (1, 1.5), (0, 1.5)], Sampling(0.03, np.random.default_rng(1)))[:2]}
    meshes |= {Path(path).stem: (lambda m: (m.vertices, m.faces))(rinow.read_mesh(path)) for path in paths}
    for name, (V, F) in meshes.items():
        rinow.singular_features((V, F))
        times = []
        for _ in range(5):
            start = time.perf_counter()
            rinow.singular_features((V, F))
            times.append(time.perf_counter() - start)
        print(f"{name:20} {len(V):8} vertices  {len(V) / statistics.median(times):10,.0f} vertices/s")


if __name__ == "__main__":
    command, *rest = sys.argv[1:] or ["features"]
    if command in ("features", "curvature"):
        {"features": bench_features, "curvature": bench_curvature}[command](int(rest[0]) if rest else 3)
    else:
        {"smooth": bench_smooth, "speed": bench_speed}[command](rest)
