"""Surfaces of masks: around each voxel or by marching cubes, smoothed as medical tools do."""

import numpy as np
from scipy.sparse import coo_array


def lattice(reach, sides=(1.0, 1.0, 1.0)):
    """Points of a grid with voxels of some sides, about an origin between them: (i, j, k, 3)."""
    axes = [np.arange(-reach - 2 * h, reach + 2 * h, h) + 0.3 * h for h in sides]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def squares(is_inside):
    """The boundary of all unit cubes around the points of a mask, two triangles for each square."""
    found = []
    for axis in range(3):
        u, v = np.eye(3, dtype=int)[[(axis + 1) % 3, (axis + 2) % 3]]
        for step in (1, -1):
            corner = np.argwhere(is_inside & ~np.roll(is_inside, -step, axis))
            corner[:, axis] += step > 0
            found.append(np.stack([corner, corner + u, corner + u + v, corner + v], axis=1)[:, ::step])
    vertices, index = np.unique(np.concatenate(found).reshape(-1, 3), axis=0, return_inverse=True)
    index = index.reshape(-1, 4)
    return vertices.astype(float), np.concatenate([index[:, [0, 1, 2]], index[:, [0, 2, 3]]])


def marching_cubes(points, values):
    """The surface between values below and above one half, at the points of a lattice."""
    import pyvista

    shape, sides = values.shape, points[1, 1, 1] - points[0, 0, 0]
    grid = pyvista.ImageData(dimensions=shape, spacing=sides, origin=points[0, 0, 0])
    grid["values"] = values.ravel(order="F").astype(float)
    surface = grid.contour([0.5], scalars="values").triangulate().clean()
    return np.asarray(surface.points, float), surface.faces.reshape(-1, 4)[:, 1:].astype(int)


def smoothed(vertices, faces, steps, swell=0.0):
    """Vertices after steps half of the way to the mean of their neighbours, and after each a share outwards again."""
    a, b = np.unique(np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0).T
    n, ones = len(vertices), np.ones(2 * len(a))
    links = coo_array((ones, (np.r_[a, b], np.r_[b, a])), shape=(n, n)).tocsr()
    count = links.sum(axis=1)[:, None]
    for _ in range(steps):
        for share in (0.5, -swell):
            vertices = vertices + share * (links @ vertices / count - vertices)
    return vertices
