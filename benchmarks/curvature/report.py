"""Tables and pictures of the curvature benchmark."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

Cell = dict[str, Any]
HEAD = """# Curvature on analytic surfaces, beside other tools

Written by `python benchmarks/bench_curvature.py`; do not edit.

Estimators: {versions}.
Machine: {machine}.

Error: root mean square over the vertices more than five rings from the border, weighted by area, relative to that of
the exact curvature; geometric mean over sphere, ellipsoid, rounded cube, torus, saddle and waves (stretched: the last
three; marching cubes: the first four).  All vertices lie on the surface; noise is normal on every coordinate, in units
of the mean edge length.  Each tool is run with the settings in its name, whatever the mesh; the parameter-free
estimates of rinow are its defaults.  The best of each column is bold.  The fits of rinow start from an osculating torus
and are exact on the sphere: without it, its means without noise are larger.
"""
QUOTED = """
Not on PyPI, and so not run here: CGAL's Monge jets (degree 4, radius of three mean edges) and the corrected curvature
measures of Lachaud et al. (2020).  On other analytic surfaces of 4,000 vertices, and measured elsewhere, they had these
errors of K: CGAL 1.0e-3 regular, 1.1e-3 irregular, 1.2e-3 random, 0.045 stretched, 1.3e-3 marching cubes, and 0.17,
0.91, 2.1 with 1, 5 and 10 % noise (radius of five edges: 0.040, 0.18, 0.35); corrected measures with a radius of four
edges 0.026, 0.039, 0.055, 0.013, 0.048, and 0.044, 0.076, 0.125; speed 17,000 (CGAL) and 190,000 vertices/s.
LaPy returns tensors that are not divided by an area, so no curvature to compare.
"""


def write_report(results: dict[str, Any], docs: Path) -> str:
    """Write the page and its pictures; the text of the page is returned."""
    cells = results["cells"]
    middle = sorted({c["n"] for c in cells if c["noise"] == 0})
    n = next(c["n"] for c in cells if c["noise"] > 0)
    versions = ", ".join(f"{p} {v}" for p, v in sorted(results["versions"].items()))
    text = [HEAD.format(versions=versions, machine=results.get("machine", "unknown"))]
    for quantity, word in (("K", "Gaussian"), ("H", "mean")):
        text += [f"\n## Relative error of the {word} curvature, {n:,} vertices\n", _accuracy(results, quantity, n)]
    text += ["\n## Error against the number of vertices and against noise\n"]
    text += ["![Error of K](../images/benchmark_error.png)\n\n![Speed](../images/benchmark_speed.png)\n"]
    text += ["\n## Observed orders in the edge length, without noise\n", _orders(results, middle)]
    text += ["\n## Vertices per second, irregular torus\n", _speeds(results), QUOTED]
    (docs / "reference").mkdir(parents=True, exist_ok=True)
    (docs / "images").mkdir(parents=True, exist_ok=True)
    page = "\n".join(text)
    (docs / "reference" / "benchmark.md").write_text(page)
    _error_figure(results, middle, n).savefig(docs / "images" / "benchmark_error.png", dpi=110)
    _speed_figure(results).savefig(docs / "images" / "benchmark_speed.png", dpi=110)
    return page


def _mean(results: dict[str, Any], name: str, quantity: str, accept: Callable[[Cell], bool]) -> float:
    """Geometric mean over the accepted cells; nan if the estimator has no value on one of them."""
    chosen = [e.get(quantity) for c, e in zip(results["cells"], results["errors"][name], strict=True) if accept(c)]
    if not chosen or None in chosen:
        return float("nan")
    return float(np.exp(np.mean(np.log(np.maximum(chosen, 1e-12)))))


def _columns(n: int) -> dict[str, Callable[[Cell], bool]]:
    def clean(style: str) -> Callable[[Cell], bool]:
        return lambda c: c["n"] == n and c["noise"] == 0 and c["style"] == style

    def noisy(x: float) -> Callable[[Cell], bool]:
        return lambda c: c["noise"] == x

    styles = ("regular", "irregular", "random", "stretched", "marching cubes")
    return {**{s: clean(s) for s in styles}, **{f"irregular, {x:.0%} noise": noisy(x) for x in (0.01, 0.05, 0.1)}}


def _accuracy(results: dict[str, Any], quantity: str, n: int) -> str:
    columns = _columns(n)
    rows = {name: [_mean(results, name, quantity, f) for f in columns.values()] for name in results["errors"]}
    rows = {name: row for name, row in rows.items() if np.isfinite(row).any()}
    best = np.nanmin(list(rows.values()), axis=0)
    lines = [f"| | {' | '.join(columns)} |", f"|---|{'--:|' * len(columns)}"]
    for name, row in rows.items():
        shown = [_shown(x, x <= 1.005 * b) for x, b in zip(row, best, strict=True)]
        lines.append(f"| {name} | {' | '.join(shown)} |")
    return "\n".join(lines)


def _shown(x: float, is_best: bool) -> str:
    if not np.isfinite(x):
        return "–"
    text = f"{x:.3f}" if 0.01 <= x < 10 else f"{x:.1e}" if x < 0.01 else f"{x:.0f}"
    return f"**{text}**" if is_best else text


def _orders(results: dict[str, Any], sizes: list[int]) -> str:
    """Slope of the error against h between the last two sizes of a style."""
    styles = ("regular", "irregular", "random", "stretched", "marching cubes")
    lines = [f"| | {' | '.join(styles)} |", f"|---|{'--:|' * len(styles)}"]
    for name in results["errors"]:
        row = []
        for style in styles:
            errors = [(n, _mean(results, name, "K", _columns(n)[style])) for n in sizes]
            known = [(n, e) for n, e in errors if np.isfinite(e)][-2:]
            if len(known) < 2:
                row.append("–")
                continue
            (n, coarse), (m, fine) = known
            row.append(f"{2 * np.log(coarse / fine) / np.log(m / n):.1f}")
        lines.append(f"| {name} | {' | '.join(row)} |")
    return "\n".join(lines)


def _speeds(results: dict[str, Any]) -> str:
    sizes = list(next(iter(results["speed"].values())))
    lines = [f"| | {' | '.join(f'{int(n):,} vertices' for n in sizes)} |", f"|---|{'--:|' * len(sizes)}"]
    for name, rates in results["speed"].items():
        lines.append(f"| {name} | {' | '.join(f'{rates[n]:,.0f}' if rates[n] else '–' for n in sizes)} |")
    return "\n".join(lines)


def _style(name: str) -> dict[str, Any]:
    ours = name.startswith("rinow")
    return {"linewidth": 2.4 if ours else 1.2, "marker": "o" if ours else ".", "label": name, "alpha": 0.9}


def _error_figure(results: dict[str, Any], sizes: list[int], n: int) -> Figure:
    figure = Figure(figsize=(11, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    noises = sorted({c["noise"] for c in results["cells"]})
    for i, name in enumerate(results["errors"]):
        colour = f"C{i % 10}"
        dashes = "-" if i < 10 else "--"
        errors = [_mean(results, name, "K", _columns(m)["irregular"]) for m in sizes]
        left.loglog(sizes, errors, dashes, color=colour, **_style(name))
        noisy = [
            _mean(results, name, "K", lambda c, x=x: c["n"] == n and c["noise"] == x and c["style"] == "irregular")
            for x in noises
        ]
        right.semilogy([100 * x for x in noises], noisy, dashes, color=colour, **_style(name))
    left.set(xlabel="vertices", ylabel="relative error of K", title="irregular meshes, no noise")
    right.set(xlabel="noise, % of the mean edge", title=f"irregular meshes, {n:,} vertices")
    for axis in (left, right):
        axis.grid(alpha=0.3, which="both")
    figure.legend(*left.get_legend_handles_labels(), loc="outside right center", fontsize=8)
    return figure


def _speed_figure(results: dict[str, Any]) -> Figure:
    n = list(next(iter(results["speed"].values())))[-1]
    rates = {name: r[n] for name, r in results["speed"].items() if r[n]}
    figure = Figure(figsize=(8, 0.32 * len(rates) + 1.1), layout="constrained")
    axis = figure.subplots()
    names = list(rates)[::-1]
    axis.barh(names, [rates[k] for k in names], color=["C3" if k.startswith("rinow") else "0.6" for k in names])
    axis.set(xscale="log", xlabel=f"vertices per second, irregular torus of {int(n):,} vertices")
    axis.grid(alpha=0.3, axis="x")
    return figure
