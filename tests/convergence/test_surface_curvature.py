"""Rates at which the curvature of irregular meshes approaches that of the surface, against exact values."""

import numpy as np
import pytest

import shapes
from rinow import surface_curvature

SURFACES = {
    "sphere": shapes.irregular_sphere,
    "ellipsoid": shapes.irregular_ellipsoid,
    "torus": shapes.irregular_torus,
    "saddle": shapes.open_patch,
}
SIZES = (1000, 4000, 16000)


def errors(surface, method, field="gaussian"):
    """Root mean square error over that of the exact values, for each size; the boundary left out."""
    result = []
    for n in SIZES:
        shape = SURFACES[surface](n)
        c = surface_curvature((shape.vertices, shape.faces), method=method)
        exact, inner = getattr(shape, field), c.status == 0
        error = (getattr(c, field) - exact)[inner]
        result.append(np.sqrt(np.mean(error**2) / np.mean(exact[inner] ** 2)))
    return np.array(result)


def order(e):
    """Mean order in the edge length, which halves from one size to the next."""
    return np.log2(e[0] / e[-1]) / (len(e) - 1)


@pytest.mark.parametrize("surface", SURFACES)
def test_lifted_converges_on_irregular_meshes(surface):
    # Between order 1, what normals of a plain quadric promise, and 2, where the errors of neighbours cancel.
    e = errors(surface, "lifted")
    assert order(e) > 1
    assert e[-1] < 0.02


@pytest.mark.parametrize("surface", SURFACES)
def test_sectional_converges_with_its_order(surface):
    # A jet of order 4 leaves h^3 of second derivatives, h^4 where the stencil is nearly symmetric.
    e, mean = errors(surface, "sectional"), errors(surface, "sectional", "mean")
    assert order(e) > 2.7
    assert order(mean) > 2.7
    assert e[-1] < 1e-3


@pytest.mark.parametrize("method", ("wald", "angle_defect"))
@pytest.mark.parametrize("surface", SURFACES)
def test_stars_of_chords_do_not_converge(surface, method):
    # A theorem of the paper needs geodesic distances: the chords of an irregular star are short by as much as
    # the curvature changes its angles.  This is why the other methods exist.
    e = errors(surface, method)
    assert order(e) < 0.2
    assert e[-1] > 0.1
