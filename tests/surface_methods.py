"""The methods of `surface_curvature`, and calls of it with the surfaces of `shapes` and `parts`."""

from functools import partial

import numpy as np

import shapes
from rinow import surface_curvature

METHODS = ("sectional", "lifted", "wald", "angle_defect")
WITH_POSITIONS = ("sectional", "lifted")
SPHERE = shapes.irregular_sphere(1000)
NOISY_TORUS = shapes.noisy(shapes.irregular_torus(1500), 0.05)


def curvature(shape, **options):
    return surface_curvature((shape.vertices, shape.faces), **options)


curvature_by_lengths = partial(curvature, method="intrinsic")


def relative_error(found, exact):
    """Root mean square of the errors by that of the exact values."""
    return np.linalg.norm(found - exact) / np.linalg.norm(exact)
