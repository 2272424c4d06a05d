"""Rates at which the curvature of irregular meshes approaches that of the surface, against exact values."""

import numpy as np
import pytest

import shapes
from rinow import TriangleMesh, surface_curvature

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
def test_fits_converge_with_the_orders_they_choose(surface):
    # Orders 6 to 8 leave h^5 to h^7 of second derivatives.  The sphere is its own osculating torus.
    e, mean = errors(surface, "auto"), errors(surface, "auto", "mean")
    if surface == "sphere":
        assert max(*e, *mean) < 1e-11
    else:
        least = 3 if surface == "saddle" else 4  # one-sided balls beside the boundary decide there
        assert order(e) > least
        assert order(mean) > least
        assert e[-1] < 1e-4


@pytest.mark.parametrize("surface", SURFACES)
def test_averaged_defects_converge_on_irregular_meshes(surface):
    # What chords do is removed as far as their normal curvature varies little over some spacings: measured 2.2 on the
    # sphere and the ellipsoid, 1.7 on the torus, 1.57 on the saddle.
    e = errors(surface, "intrinsic")
    assert order(e) > 1.5
    assert e[-1] < (1e-5 if surface == "sphere" else 0.005)


@pytest.mark.parametrize("quality", ("best", "fast"))
@pytest.mark.parametrize("surface", ("ellipsoid", "torus", "saddle"))
def test_spread_is_calibrated_on_noisy_meshes(surface, quality):
    # Nominally 95 % of errors are below two standard errors; fits of few patches err together.
    shape = SURFACES[surface](4000)
    spacing = TriangleMesh(shape.vertices, shape.faces).mean_edge_length
    noisy = shapes.noisy(shape, 0.03 * spacing)
    c = surface_curvature((noisy.vertices, noisy.faces), quality=quality)
    inner = c.status == 0
    share = np.mean((np.abs(c.gaussian - shape.gaussian) < 2 * c.spread)[inner])
    assert 0.9 < share <= 1


@pytest.mark.parametrize("quality", ("best", "fast"))
def test_balls_stay_small_where_curvature_varies(quality):
    # Over balls as large as the tips of this ellipsoid all orders fail; two odd ones agree by chance.  The best fixed
    # radius of all, five spacings, has an error of 0.041 here, ten spacings 0.109.
    axes = (3.0, 2.0, 1.0)
    V, F = shapes.icosphere(4)[:2]
    V = V * axes
    exact = 1.0 / (np.prod(axes) * ((V / np.square(axes)) ** 2).sum(axis=1)) ** 2
    mesh = TriangleMesh(V, F)
    noise = 0.005 * mesh.mean_edge_length * np.random.default_rng(5).normal(size=(len(V), 1))
    found = surface_curvature((V + noise * mesh.vertex_normals, F), quality=quality).gaussian
    assert np.linalg.norm(found - exact) < 0.07 * np.linalg.norm(exact)


@pytest.mark.parametrize("method", ("wald", "angle_defect"))
@pytest.mark.parametrize("surface", SURFACES)
def test_stars_of_chords_do_not_converge(surface, method):
    # A theorem of the paper needs geodesic distances: the chords of an irregular star are short by as much as
    # the curvature changes its angles.  This is why the other methods exist.
    e = errors(surface, method)
    assert order(e) < 0.2
    assert e[-1] > 0.1


@pytest.mark.parametrize("method", ("wald", "robinson"))
@pytest.mark.parametrize("surface", ("sphere", "torus"))
def test_stars_of_geodesic_distances_converge(surface, method):
    # With r ~ √h the bias r² and the error of the polyhedron, (h/r)² or less, are of order 1 in h.
    e = []
    for n in (1000, 4000, 16000)[: 3 if method == "wald" else 2]:
        shape = SURFACES[surface](n)
        radius = (1.0 if method == "wald" else 1.5) * n**-0.25  # 1.7 to 5 spacings
        c = surface_curvature((shape.vertices, shape.faces), method=method, radius=radius)
        assert (c.status == 0).all()
        e.append(np.sqrt(np.mean((c.gaussian - shape.gaussian) ** 2) / np.mean(shape.gaussian**2)))
    assert order(np.array(e)) > 0.8
    assert e[-1] < 0.1
