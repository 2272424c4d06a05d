"""Plates with holes in rows, as models of parts have them."""

import numpy as np
from scipy.spatial import Delaunay


def perforated_plate(n, sides, radius=0.3, thickness=0.4):
    """A plate with n × n holes of so many sides, which turn on their way down, as in decimated models of parts.

    Its vertices and faces, and the edges of its rims.
    """
    place, count = np.arange(n * n * sides).reshape(-1, sides), n * n * sides + 8 * n
    layers, faces, rims = [], [], []
    for height, turn, first in ((thickness, 0.0, 0), (0.0, 0.5, count)):
        angles = 2 * np.pi * (np.arange(sides) + turn + 0.1) / sides
        hole = radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)
        centres = np.stack(np.meshgrid(np.arange(n), np.arange(n)), axis=-1).reshape(-1, 1, 2) + 0.5
        side = np.linspace(0, n, 2 * n, endpoint=False)
        border = [(side, 0 * side), (0 * side + n, side), (n - side, 0 * side + n), (0 * side, n - side)]
        points = np.concatenate([(centres + hole).reshape(-1, 2), *(np.stack(p, axis=1) for p in border)])
        flat = Delaunay(points).simplices
        middles = points[flat].mean(axis=1)
        flat = flat[np.linalg.norm(middles - np.floor(middles) - 0.5, axis=1) > radius * np.cos(np.pi / sides)]
        turned = (np.linalg.det(points[flat[:, 1:]] - points[flat[:, :1]]) < 0) != (first > 0)
        flat[turned] = flat[turned][:, ::-1]
        faces.append(flat + first)
        layers.append(np.column_stack([points, np.full(count, height)]))
        loops = place, np.arange(count - 8 * n, count)
        rim = [np.stack([loop, np.roll(loop, -1, axis=-1)], axis=-1).reshape(-1, 2) for loop in loops]
        rims.append(np.concatenate(rim) + first)
    (a, b), (c, d) = rims[0].T, rims[1].T
    inside = len(place) * sides
    walls = np.concatenate([np.stack([a, b, c], axis=1), np.stack([b, d, c], axis=1)])
    is_outer = np.tile(np.arange(len(a)) >= inside, 2)
    walls[is_outer] = walls[is_outer][:, ::-1]
    return np.concatenate(layers), np.concatenate([*faces, walls]), np.concatenate(rims)
