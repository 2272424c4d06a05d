"""The table of the distance benchmarks."""

from __future__ import annotations

import json
import math
import os
import platform
from pathlib import Path
from typing import Any

Row = dict[str, Any]
HEAD = """# Gromov-Hausdorff and Lipschitz distance: what closes, and how fast

Written by `python benchmarks/bench_gromov_hausdorff.py --page`; do not edit.  Machine: {machine}.

Random instances, one for each seed.  "Exact" counts those whose interval is closed within the limit; the gap is the
largest upper / lower of all seeds.  Seconds are the median and the longest.  What is not closed is listed with
its interval below.

| group | instance | limit | exact | gap | seconds |
|---|---|--:|--:|--:|--:|
"""


def write_page(root: Path, group: str, rows: list[Row]) -> None:
    """Replace the results of the same instances and seeds in a group, and write the page from all results."""
    file = root / "benchmarks" / "distances" / "results.json"
    results: dict[str, Any] = json.loads(file.read_text()) if file.exists() else {"groups": {}}
    results["machine"] = f"{os.cpu_count()} cores, {platform.system()}, Python {platform.python_version()}"
    old = {(row["name"], row["seed"]): row for row in results["groups"].get(group, [])}
    results["groups"][group] = list((old | {(row["name"], row["seed"]): row for row in rows}).values())
    lines = [",\n".join(f"   {json.dumps(row)}" for row in rows) for rows in results["groups"].values()]
    groups = ",\n".join(f'  "{g}": [\n{text}\n  ]' for g, text in zip(results["groups"], lines, strict=True))
    file.write_text(f' {{"machine": {json.dumps(results["machine"])}, "groups": {{\n{groups}\n }}}}\n'.lstrip())
    (root / "docs" / "reference" / "benchmark-distances.md").write_text(page(results))


def page(results: dict[str, Any]) -> str:
    """Text of the page."""
    text, open_rows = HEAD.format(machine=results["machine"]), list[Row]()
    for group, rows in results["groups"].items():
        for name in dict.fromkeys(row["name"] for row in rows):
            same = [row for row in rows if row["name"] == name]
            text += f"| {group} | {name} | {same[0]['limit']:g} s | {_summary(same)} |\n"
            open_rows += [row for row in same if not row["exact"]]
    text += "\n## Intervals left open\n\n| instance | seed | lower | upper | upper / lower | lower bound by |\n"
    text += "|---|--:|--:|--:|--:|---|\n"
    for row in open_rows:
        bounds = f"{row['lower']:.5g} | {row['upper']:.5g} | {_gap(row):.3f}"
        text += f"| {row['name']} | {row['seed']} | {bounds} | {row['by']} |\n"
    return text


def _summary(rows: list[Row]) -> str:
    """Share of exact results, largest gap, seconds."""
    seconds = sorted(row["seconds"] for row in rows)
    gap = max(_gap(row) for row in rows)
    times = f"{seconds[len(seconds) // 2]:.1f}, {seconds[-1]:.1f}"
    return f"{sum(row['exact'] for row in rows)} of {len(rows)} | {gap:.3f} | {times}"


def _gap(row: Row) -> float:
    """Upper bound divided by the lower one."""
    if row["lower"] > 0:
        return row["upper"] / row["lower"]
    return math.inf if row["upper"] > 0 else 1.0
