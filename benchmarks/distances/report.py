"""The tables of the distance benchmarks."""

from __future__ import annotations

import json
import math
import os
import platform
from pathlib import Path
from typing import Any

Row = dict[str, Any]
HEAD = """# Gromov-Hausdorff and Lipschitz distance: what closes, and how fast

Written by `python benchmarks/bench_gromov_hausdorff.py --page` and `python benchmarks/bench_upper_bounds.py --page`; do
not edit.  Machine: {machine}.

Random instances, one for each seed.  "Exact" counts those whose interval is closed within the limit; the gap is the
largest upper / lower of all seeds.  Seconds are the median and the longest, memory the peak of the process, for meshes.
What is not closed is listed with its interval below.

| group | instance | limit | exact | gap | seconds | GiB |
|---|---|--:|--:|--:|--:|--:|
"""
OPEN = """
## Intervals left open

| instance | seed | lower | upper | upper / lower | lower bound by |
|---|--:|--:|--:|--:|---|
"""
BOUNDS = """
## Upper bounds beside other packages

500 points of the unit square against 500 others, or against a shuffled copy with noise 0.01.  rinow has a limit of 10
seconds; `euclidean-hausdorff`, which uses the coordinates, and `dgh` run as they are, and their seconds are those of
one run.  Each value is the distortion / 2 or the distance that the package reports, and the smaller is the better.

| instance | seed | package | upper bound | seconds |
|---|--:|---|--:|--:|
"""


def write_page(root: Path, group: str, rows: list[Row]) -> None:
    """Replace the results of the same instances and seeds in a group, and write the page from all results."""
    file = root / "benchmarks" / "distances" / "results.json"
    results: dict[str, Any] = json.loads(file.read_text()) if file.exists() else {"groups": {}}
    results["machine"] = f"{os.cpu_count()} cores, {platform.system()}, Python {platform.python_version()}"
    old = {_key(row): row for row in results["groups"].get(group, [])}
    results["groups"][group] = list((old | {_key(row): row for row in rows}).values())
    lines = [",\n".join(f"   {json.dumps(row)}" for row in rows) for rows in results["groups"].values()]
    groups = ",\n".join(f'  "{g}": [\n{text}\n  ]' for g, text in zip(results["groups"], lines, strict=True))
    file.write_text(f' {{"machine": {json.dumps(results["machine"])}, "groups": {{\n{groups}\n }}}}\n'.lstrip())
    (root / "docs" / "reference" / "benchmark-distances.md").write_text(page(results))


def page(results: dict[str, Any]) -> str:
    """Text of the page: intervals, those left open, and the group of upper bounds."""
    text, open_rows = HEAD.format(machine=results["machine"]), list[Row]()
    groups = {group: rows for group, rows in results["groups"].items() if group != "upper bounds"}
    for group, rows in groups.items():
        for name in dict.fromkeys(row["name"] for row in rows):
            same = [row for row in rows if row["name"] == name]
            text += f"| {group} | {name} | {same[0]['limit']:g} s | {_summary(same)} |\n"
            open_rows += [row for row in same if not row["exact"]]
    text += OPEN
    for row in open_rows:
        bounds = f"{row['lower']:.5g} | {row['upper']:.5g} | {_gap(row):.3f}"
        text += f"| {row['name']} | {row['seed']} | {bounds} | {row['by']} |\n"
    text += BOUNDS
    for row in sorted(results["groups"].get("upper bounds", []), key=_key):
        text += f"| {row['name']} | {row['seed']} | {row['package']} | {row['upper']:.4f} | {row['seconds']:.1f} |\n"
    return text


def _key(row: Row) -> tuple[str, int, str]:
    """What tells a result from others of its group."""
    return row["name"], row["seed"], row.get("package", "")


def _summary(rows: list[Row]) -> str:
    """Share of exact results, largest gap, seconds."""
    seconds = sorted(row["seconds"] for row in rows)
    gap = max(_gap(row) for row in rows)
    times = f"{seconds[len(seconds) // 2]:.1f}, {seconds[-1]:.1f}"
    memory = max((f"{row['GiB']:.1f}" for row in rows if "GiB" in row), default="")
    return f"{sum(row['exact'] for row in rows)} of {len(rows)} | {gap:.3f} | {times} | {memory}"


def _gap(row: Row) -> float:
    """Upper bound divided by the lower one."""
    if row["lower"] > 0:
        return row["upper"] / row["lower"]
    return math.inf if row["upper"] > 0 else 1.0
