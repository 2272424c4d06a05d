"""Work on the centres of patches, cut into tasks for an executor."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._executor import Executor, SerialExecutor
from rinow.kernels import balls, patch_driver, patch_fits, patches
from rinow.kernels.nested_fits import N_ORDERS

__all__ = ["Tasks", "add_patches", "fill_tables", "fit_frames"]

Floats = NDArray[np.float64]

CENTRES_PER_TASK = 1 << 16
VALUES_PER_TASK = 200_000
"""Values of patches at vertices that are kept at a time: the memory of more than 32 MiB is never used twice."""
ADDING = 8
"""Pieces that vertices are cut into when values are added."""
NO_FRAMES = np.empty((0, 11))
NO_PATCHES = patch_driver.Patches(
    np.empty(0), np.empty(0), np.empty(0), np.empty(0, np.int32), np.empty((0, patches.N_VALUES))
)


@dataclass
class Tasks:
    """An executor, the share of the work done so far, and the part of it that shares are of."""

    executor: Executor = field(default_factory=SerialExecutor)
    report: Callable[[float], object] = lambda share: None
    done: float = 0.0
    part: float = 1.0

    def run(self, function: Callable[..., Any], parts: list[slice], share: float) -> Iterator[tuple[slice, Any]]:
        """Each part with the result of the function; `share` of all work is done afterwards."""
        results = iter(self.executor.map(function, parts))
        for part in parts:
            yield part, next(results)  # without a name, which would keep it while the next one is made
            self.done += self.part * share / len(parts)
            self.report(self.done)


@dataclass(frozen=True)
class Fitting:
    """One kernel call for a part of the centres; a value that any pool can send elsewhere."""

    task: int
    errors_of: int
    reaches: Floats
    most: int
    sheet: balls.Sheet
    centres: patch_driver.Centres

    def of(self, part: slice, tables: patch_fits.Tables, frames: Floats, out: patch_driver.Patches) -> None:
        """Run the kernel on a part of the centres."""
        c = self.centres
        rows = c.rows[part.start : part.stop + 1] - c.rows[part.start]
        own = patch_driver.Centres(
            c.vertices[part], c.frames[part], c.low[part], c.high[part], c.factors[part], c.orders[part], rows,
            c.noise[part], c.curvedness[part],
        )  # fmt: skip
        patch_driver.treat_all(self.task, self.errors_of, self.reaches, self.most, own, self.sheet, tables, frames, out)


def fill_tables(fitting: Fitting, known: bool, tasks: Tasks, share: float) -> patch_fits.Tables:
    """The tables of all centres."""
    rows = fitting.centres.rows
    tables = _empty_tables(int(rows[-1]), known)
    for part, found in tasks.run(partial(_tables_of, fitting, known), _parts(len(rows) - 1), share):
        for i, whole in enumerate(tables):
            whole[rows[part.start] : rows[part.stop]] = found[i]
        del found
    return tables


def _tables_of(fitting: Fitting, known: bool, part: slice) -> patch_fits.Tables:
    rows = fitting.centres.rows
    tables = _empty_tables(int(rows[part.stop] - rows[part.start]), known)
    fitting.of(part, tables, NO_FRAMES, NO_PATCHES)
    return tables


def fit_frames(fitting: Fitting, tasks: Tasks, share: float) -> Floats:
    """(n, 11): the frames of the tori that osculate the fits; the given frame where there is no fit."""
    frames = np.empty_like(fitting.centres.frames)
    for part, found in tasks.run(partial(_frames_of, fitting), _parts(len(frames)), share):
        frames[part] = found
    return frames


def _frames_of(fitting: Fitting, part: slice) -> Floats:
    frames = np.empty((part.stop - part.start, 11))
    fitting.of(part, _empty_tables(0, True), frames, NO_PATCHES)
    return frames


def add_patches(
    fitting: Fitting, cores: Floats, risks: Floats, weights: Floats, totals: Floats, tasks: Tasks, share: float
) -> None:
    """Add the weighted values of all patches to the totals of their vertices, in the order of the centres."""
    rows = fitting.centres.rows
    parts: list[slice] = []
    first = 0
    while first < len(cores):
        last = int(np.searchsorted(rows, rows[first] + VALUES_PER_TASK, "right")) - 1
        parts.append(slice(first, min(max(last, first + 1), len(cores))))
        first = parts[-1].stop
    for _, (vertices, values) in tasks.run(partial(_values_of, fitting, cores, risks, weights), parts, share):
        least = int(vertices.view(np.uint32).min(initial=len(totals)))  # no value has the vertex -1, then the greatest
        patches.add_values(vertices, values, least, int(vertices.max(initial=-1)), ADDING, totals)
        del vertices, values


def _values_of(fitting: Fitting, cores: Floats, risks: Floats, weights: Floats, part: slice) -> tuple[Any, Floats]:
    rows = fitting.centres.rows
    n = rows[part.stop] - rows[part.start]
    vertices, values = np.empty(n, np.int32), np.empty((n, patches.N_VALUES))
    out = patch_driver.Patches(cores[part], risks[part], weights[part], vertices, values)
    fitting.of(part, _empty_tables(0, True), NO_FRAMES, out)
    return vertices, values


def _parts(n: int) -> list[slice]:
    return [slice(i, min(i + CENTRES_PER_TASK, n)) for i in range(0, n, CENTRES_PER_TASK)]


def _empty_tables(n_rows: int, known: bool) -> patch_fits.Tables:
    n_unknown = 0 if known else n_rows
    widths = (N_ORDERS, patch_fits.N_BIASES, patch_fits.N_BIASES, N_ORDERS, N_ORDERS)
    return patch_fits.Tables(
        *(np.empty((n_rows, width), np.float32) for width in widths),
        *(np.empty((n_unknown, N_ORDERS), np.float32) for _ in range(3)),
    )
