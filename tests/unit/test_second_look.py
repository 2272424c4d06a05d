"""A bump on a plane under noise: balls much larger than it say that there is none, and are not believed."""

import numpy as np
import pytest

import shapes
from rinow import TriangleMesh
from rinow.curvature.second_look import missed
from rinow.curvature.sheet import patch_sheet
from surface_methods import curvature, relative_error


@pytest.mark.parametrize("quality", ["best", "fast"])
@pytest.mark.parametrize("noise", [0.05, 0.1])
def test_a_small_bump_on_a_large_plane_is_not_flat(noise, quality):
    """It is three spacings high and five wide.  Most balls of most samples say that K = H = 0, and agree on that."""
    errors, held = [], []
    for seed in range(3):
        shape = shapes.noisy(shapes.bump_on_plane(seed=seed), noise, seed)
        distance = np.linalg.norm(shape.vertices[:, :2], axis=1)
        c, on_bump = curvature(shape, quality=quality), distance < 0.6
        pairs = (c.gaussian, shape.gaussian), (c.mean, shape.mean)
        errors.append([relative_error(found[on_bump], exact[on_bump]) for found, exact in pairs])
        held.append(np.mean((np.abs(c.gaussian - shape.gaussian) < 2 * c.spread)[on_bump]))
        # Far from it the plane stays one, to a fiftieth of the curvature on top.
        assert np.abs(c.mean[(distance > 1.2) & (distance < 1.8)]).mean() < 0.1
    assert np.all(np.mean(errors, axis=0) < (0.6, 0.4))
    assert np.mean(held) > 0.8


def sheet_of(n=2000):
    shape = shapes.irregular_sphere(n)
    return patch_sheet(TriangleMesh(shape.vertices, shape.faces), np.zeros(n, np.bool_))[0]


def test_noise_and_single_vertices_beside_the_surface_are_not_missed():
    sheet, rng = sheet_of(), np.random.default_rng(5)
    variance = np.square(0.2 * sheet.spacing)
    heights = np.sqrt(variance) * rng.normal(size=len(variance))
    assert not missed(sheet, heights, variance).any()
    heights[rng.choice(len(heights), 20, replace=False)] += 5 * sheet.spacing.mean()
    assert not missed(sheet, heights, variance).any()


def test_stars_beside_their_fits_are_missed():
    sheet = sheet_of()
    away = np.linalg.norm(sheet.vertices - sheet.vertices[0], axis=1) / sheet.spacing
    heights = 0.4 * sheet.spacing * (away < 3.0)
    found = missed(sheet, heights, np.square(0.05 * sheet.spacing))
    assert found[away < 1.5].all()
    assert not found[away > 5.0].any()
    # On a surface without orientation heights have no sign.
    assert not missed(sheet._replace(is_oriented=False), heights, np.square(0.05 * sheet.spacing)).any()
    # What is small against the spacings is no reason, however sure.
    assert not missed(sheet, heights / 10, np.square(1e-4 * sheet.spacing)).any()
