"""Geodesics of finer and finer meshes tend to those of the surface; paths along edges do not."""

import numpy as np

import rinow
import shapes


def test_great_circles_at_order_two_but_not_along_edges():
    exact, edges = [], []
    for level in (1, 2, 3, 4):
        V, F, *_ = shapes.icosphere(level)
        great_circle = np.arctan2(np.linalg.norm(np.cross(V[0], V), axis=1), V @ V[0])
        exact.append(np.abs(rinow.geodesic_distances((V, F), [0])[0] - great_circle).max())
        edges.append(np.abs(rinow.geodesic_distances((V, F), [0], method="edges")[0] - great_circle).max())
    orders = np.log2(np.array(exact[:-1]) / exact[1:])
    assert (orders[1:] > 1.8).all() and exact[-1] < 0.01
    assert edges[-1] > 0.05  # the edges of a regular pattern leave out most directions, however short they are
