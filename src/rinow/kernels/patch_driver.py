"""The loop over the centres of patches.

Growing balls and fitting is by far the most code to compile, so one kernel does all that is done with fits.
"""

from typing import NamedTuple

import numpy as np

from rinow.kernels import balls, nested_fits, patch_fits, patches
from rinow.kernels._jit import lean, parallel_kernel, prange
from rinow.kernels.nested_fits import MAX_ORDER, TERMS

TABLES, FRAMES, VALUES = 0, 1, 2


class Centres(NamedTuple):
    """Vertices (n,) about which balls grow, and what is to be fitted there.

    For each the frame (11,) of its torus, the first and last index of its radii, the factor of these radii, the highest
    order, the first row of its results (n + 1,), the variance of the noise, and the curvedness of the surface.
    """

    vertices: np.ndarray
    frames: np.ndarray
    low: np.ndarray
    high: np.ndarray
    factors: np.ndarray
    orders: np.ndarray
    rows: np.ndarray
    noise: np.ndarray
    curvedness: np.ndarray


class Patches(NamedTuple):
    """Radii of cores (n,), risks (n,) and weights (n,), and the values (m, N) at vertices (m,)."""

    cores: np.ndarray
    risks: np.ndarray
    weights: np.ndarray
    vertices: np.ndarray
    values: np.ndarray


class Work(NamedTuple):
    """Work space of one thread: beside a ball and its fits the radii and the coefficients of those of one centre."""

    ball: balls.Ball
    fit: nested_fits.Fits
    reaches: np.ndarray
    coefficients: np.ndarray


@lean
def treat(i, task, errors_of, reaches, centres, sheet, tables, frames, out, work, values, gradients, smaller):
    """Grow the balls about one centre, fit, and write what the task asks for."""
    ball, fit = work.ball, work.fit
    v, frame, order = centres.vertices[i], centres.frames[i], centres.orders[i]
    start, stop, spacing = centres.rows[i], centres.rows[i + 1], sheet.spacing[v]
    if task == FRAMES:
        for k in range(frame.shape[0]):
            frames[i, k] = frame[k]
    if task == VALUES:
        out.vertices[start:stop] = -1
    if order < 2:
        return
    own = work.reaches[: centres.high[i] + 1 - centres.low[i]]
    for k in range(len(own)):
        own[k] = reaches[centres.low[i] + k] * centres.factors[i]
    size = balls.grow(v, frame, own[-1], i + 1, sheet, ball)
    asked = order + 1 if task == VALUES and order % 2 == 0 and order < MAX_ORDER else order
    asked = nested_fits.highest_order(size, asked)
    if task == TABLES:
        k1, k2, s2 = frame[9] * spacing, frame[10] * spacing, centres.noise[i] / (spacing * spacing)
        share = patch_fits.shares(errors_of, centres.curvedness[i] * spacing)
        patch_fits.write_rows(
            start, ball.points, size, own, asked, share, k1, k2, s2, fit, tables, values, gradients, smaller
        )
        for t in range(start + len(own), stop):
            patch_fits.write_no_row(t, tables)
    elif asked >= 2:
        nested_fits.place_origin(ball.points, size, own[-1], fit)
        nested_fits.add_moments(ball.points, size, own, asked, fit)
        top = nested_fits.fit_orders(len(own) - 1, own[-1], asked, fit)  # a 0 would be compiled by itself
        if task == FRAMES and top >= 2:
            patches.write_frame(fit.jets[top], spacing, frame, frames[i])
        elif top >= 2:
            patch = patches.Patch(out.cores[i], centres.noise[i], out.risks[i], out.weights[i], order)
            patches.write_patch(
                start, stop, size, top, asked, own[-1], frame, patch, fit, sheet, ball, work.coefficients,
                out.vertices, out.values,
            )  # fmt: skip


@parallel_kernel
def treat_all(task, errors_of, reaches, most, centres, sheet, tables, frames, out):
    """Write rows of the tables, frames (n, 11) or values of patches for all centres."""
    ball, fit = balls.ball(sheet.vertices.shape[0], most), nested_fits.fits(len(reaches))
    work = Work(ball, fit, np.empty(len(reaches)), np.empty(TERMS[MAX_ORDER]))
    values, gradients = np.empty((MAX_ORDER + 1, 2)), np.empty((MAX_ORDER + 1, 2, 3))
    smaller = np.empty((MAX_ORDER + 1, 10))
    for i in prange(len(centres.vertices)):
        treat(i, task, errors_of, reaches, centres, sheet, tables, frames, out, work, values, gradients, smaller)
