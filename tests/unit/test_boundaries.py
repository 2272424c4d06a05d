"""Curvature at boundaries under noise, where fits see points on one side only."""

import numpy as np
import pytest

import shapes
from rinow import TriangleMesh, surface_curvature
from rinow.curvature.centres import flat_frames
from rinow.curvature.patch_tasks import Tasks, fill_tables
from rinow.curvature.scale import Ladder
from rinow.curvature.sheet import patch_sheet
from rinow.kernels import patch_driver, patch_fits

PITCH = 0.6


def helicoid(n=1600, seed=21):
    """A minimal surface: errors of H that leave K alone are all that H has."""
    patch = shapes.open_patch(n, seed=seed)
    u, v = patch.vertices[:, :2].T
    points = np.column_stack([v * np.cos(2 * u), v * np.sin(2 * u), 2 * PITCH * u])
    return shapes.Shape(points, patch.faces, -((PITCH / (PITCH**2 + v**2)) ** 2), np.zeros(n))


def pseudosphere(n=1600, seed=21):
    """A strip along its rim, where the radius is as large as some spacings and one-sided fits converge slowly."""
    patch = shapes.open_patch(n, seed=seed)
    v, u = 1.15 + 0.85 * patch.vertices[:, 0], 2.0 * patch.vertices[:, 1]
    points = np.column_stack([np.cos(u) / np.cosh(v), np.sin(u) / np.cosh(v), v - np.tanh(v)])
    return shapes.Shape(points, patch.faces, -np.ones(n), 0.5 * (np.sinh(v) - 1.0 / np.sinh(v)))


def cap(n=1600):
    """A square patch of the unit sphere, with corners."""
    patch = shapes.open_patch(n, seed=22)
    x, y = 0.6 * patch.vertices[:, :2].T
    return shapes.Shape(np.column_stack([x, y, np.sqrt(1 - x * x - y * y)]), patch.faces, np.ones(n), np.ones(n))


def stretched_catenoid(around=160, along=16):
    """A grid whose rows are three times as far apart as its columns at the waist, and as far at the ends."""
    angle, z = (x.ravel() for x in np.meshgrid(np.arange(around) * 2 * np.pi / around, np.linspace(-1, 1, along + 1)))
    i, j = (x.ravel() for x in np.meshgrid(np.arange(around), np.arange(along)))
    a, b = i + around * j, (i + 1) % around + around * j
    faces = np.concatenate([np.stack([a, b, b + around], 1), np.stack([a, b + around, a + around], 1)])
    points = np.column_stack([np.cosh(z) * np.cos(angle), np.cosh(z) * np.sin(angle), z])
    return shapes.Shape(points, faces, -(np.cosh(z) ** -4.0), np.zeros(len(z)))


def errors_at_boundary(shape, **options):
    """Root mean squares of the errors of K and |H| at boundary vertices."""
    found = surface_curvature((shape.vertices, shape.faces), **options)
    ends = TriangleMesh(shape.vertices, shape.faces).topology.vertex_is_boundary
    errors = found.gaussian - shape.gaussian, np.abs(found.mean) - shape.mean
    return np.array([np.sqrt(np.mean(e[ends] ** 2)) for e in errors])


@pytest.mark.parametrize("noise", [0.005, 0.02])
@pytest.mark.parametrize("surface", [helicoid, cap])
def test_choices_at_a_boundary_are_as_good_as_one_radius_for_all(surface, noise):
    ratios = {"best": [], "fast": []}
    for seed in range(23, 27):
        shape = shapes.noisy(surface(), noise, seed=seed)
        h = TriangleMesh(shape.vertices, shape.faces).mean_edge_length
        known = np.fmin.reduce([errors_at_boundary(shape, radius=r * h) for r in (3, 4, 5, 6, 8, 10, 13)])
        for quality, found in ratios.items():
            found.append(errors_at_boundary(shape, quality=quality) / known)
    # The best radius cannot be known without the errors, and a boundary errs in few stretches, each as a whole: single
    # samples have 0.2 to 5 times its error.  By K alone H of the helicoid has 4 to 9 times its error.
    for found in ratios.values():
        assert (np.exp(np.mean(np.log(found), axis=0)) < 3.0).all()


def test_the_worst_of_few_patches_does_not_decide():
    # Measured 0.0132; 0.0211 where patches weigh as inside, by the square root of their risk.
    errors = [errors_at_boundary(helicoid(900, seed))[0] for seed in range(31, 39)]
    assert np.exp(np.mean(np.log(errors))) < 0.017


@pytest.mark.parametrize("quality", ["best", "fast"])
@pytest.mark.parametrize(("around", "along"), [(140, 14), (195, 14), (195, 20), (300, 20)])
def test_charts_that_differ_show_in_the_spread(around, along, quality):
    """Of few rows the samples tell too little which chart is better.

    Measured: errors of 0.02 to 2.7 spreads; of 4.2 where the samples choose.
    """
    shape = stretched_catenoid(around, along)
    found = surface_curvature((shape.vertices, shape.faces), quality=quality)
    ends = TriangleMesh(shape.vertices, shape.faces).topology.vertex_is_boundary
    errors = (found.gaussian - shape.gaussian)[ends]
    assert np.sqrt(np.mean(errors**2)) < 3.0 * np.sqrt(np.mean(found.spread[ends] ** 2))


@pytest.mark.parametrize(("noise", "most"), [(0.005, 0.1), (0.02, 0.18)])
def test_odd_terms_show_in_the_next_order(noise, most):
    # Measured .083 and .088 (best, fast), .154 and .155; by the order two above alone .156, .116 and .241, .217.
    samples = [shapes.noisy(helicoid(), noise, seed=seed) for seed in range(23, 31)]
    for quality in ("best", "fast"):
        errors = [errors_at_boundary(sample, quality=quality)[0] for sample in samples]
        assert np.exp(np.mean(np.log(errors))) < most


def test_a_drift_over_several_orders_shows():
    # Measured .65; .85 where an order is held against the next and the one after only.
    samples = [shapes.noisy(pseudosphere(seed=seed), 0.02, seed=seed) for seed in range(31, 39)]
    errors = [errors_at_boundary(sample)[0] for sample in samples]
    assert np.exp(np.mean(np.log(errors))) < 0.74


def test_errors_of_both_are_the_sum_of_those_of_each():
    shape = shapes.noisy(shapes.irregular_torus(600), 0.02)
    sheet, _ = patch_sheet(TriangleMesh(shape.vertices, shape.faces))
    centres = np.array([5, 300, 590], np.int32)
    frames = flat_frames(sheet, centres)
    frames[:, 9:] = 0.4, -1.1
    low, high, orders = (np.full(3, k, np.int32) for k in (3, 6, 6))
    rows, noise = np.arange(4) * 4, (0.02 * sheet.spacing[centres]) ** 2

    def tables(errors_of):
        place = (patch_driver.TABLES, sheet, centres, frames, low, high, orders, rows, noise, errors_of)
        return fill_tables(Ladder.free(sheet).fitting(*place), True, Tasks(), 1.0)

    gaussian, mean, both = (tables(k) for k in (patch_fits.GAUSSIAN, patch_fits.MEAN, patch_fits.BOTH))
    curvedness = 0.5 * (0.4**2 + 1.1**2) * np.repeat(sheet.spacing[centres], 4)[:, None] ** 2
    for name in ("variance", "bias", "bias_variance", "step"):
        of_both, of_gaussian, of_mean = (getattr(t, name) for t in (both, gaussian, mean))
        assert np.isfinite(of_both).any()
        # Tables are of single precision, and biases differences of what they sum.
        expected = of_gaussian + curvedness * of_mean
        np.testing.assert_allclose(of_both, expected, rtol=1e-4, atol=1e-5 * np.nanmax(of_both))
