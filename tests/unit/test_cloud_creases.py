"""Clouds of points on bodies with sharp edges, what an edge leaves beside it and the faces keep; and on few points."""

import numpy as np
import pytest

import rinow

N_ROWS = 28
"""Points along an edge, so that the spacing is 1/28."""


def points_of_a_cube(noise, seed=31):
    """Random points on the faces of the unit cube, with noise in spacings; their distances from the next edge."""
    rng = np.random.default_rng(seed)
    faces = []
    for axis in range(3):
        for side in (-0.5, 0.5):
            face = np.full((N_ROWS**2, 3), side)
            face[:, [(axis + 1) % 3, (axis + 2) % 3]] = rng.uniform(-0.5, 0.5, (N_ROWS**2, 2))
            faces.append(face)
    P = np.concatenate(faces)
    from_edge = (0.5 - np.sort(np.abs(P), axis=1)[:, 1]) * N_ROWS
    return P + rng.normal(size=P.shape) * noise / N_ROWS, from_edge


@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_edges_do_not_bend_the_faces_beside_them(noise):
    # The edges carry the whole of 4π; what fits miss there was once taken off the faces, up to 8 spacings away.
    P, from_edge = points_of_a_cube(noise)
    found = rinow.point_cloud_curvature(P)
    error, known = np.abs(found.gaussian), np.isfinite(found.gaussian)
    away, far = known & (from_edge > 3.0), known & (from_edge > 5.0)
    # Three rings reach the edge from nearer points; 0.3 is 0.0004 in units of the inverse squared spacing.
    assert np.quantile(error[far], 0.9) < 0.3
    assert np.mean(error[away] <= 2.0 * found.spread[away]) > 0.9


@pytest.mark.parametrize(("n", "seed"), [(60, 3), (80, 16), (100, 34), (120, 21)])
def test_no_spread_is_not_a_spread_of_nothing(n, seed):
    # Where no ball has a fit, nor a neighbour one, a quadric is taken whose error nothing tells: not 0.
    rng = np.random.default_rng(seed)
    u, v = rng.uniform(0.0, 2.0 * np.pi, (2, n))
    w = 1.0 + 0.4 * np.cos(v)
    found = rinow.point_cloud_curvature(np.stack([w * np.cos(u), w * np.sin(u), 0.4 * np.sin(v)], axis=1))
    known = np.isfinite(found.gaussian)
    assert known.any()
    assert not (found.spread[known] == 0.0).any()
