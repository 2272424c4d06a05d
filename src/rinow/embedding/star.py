"""Closed stars: a point, and others around it in cyclic order."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow._arrays import as_floats, in_unit, rows_in_own_unit
from rinow.errors import InvalidInputError
from rinow.kernels import stars

__all__ = ["star_curvature"]


def star_curvature(radii: ArrayLike, chords: ArrayLike) -> NDArray[np.float64]:
    r"""Curvature k at which the angles around the centre of a star, taken in S_k, sum to 2π.

    A star is a centre and n points around it in cyclic order.  It embeds in the surface S_k of constant curvature for
    this k only; for n = 3 that is the planar embedding curvature of four points.

    Parameters
    ----------
    radii : (..., n) array_like of float
        Distances of the n >= 3 points from the centre.
    chords : (..., n) array_like of float
        Distances between neighbours: chord i joins points i and i + 1, the last one the last and the first point.

    Returns
    -------
    curvature : (...) ndarray of float
        In 1/length²; nan where a triangle fails the triangle inequality, where linear triangles alone make up more than
        2π, or where the angles sum to less than 2π in every surface that admits the triangles.

    Raises
    ------
    InvalidInputError
        If a shape or a type is wrong, or n < 3.

    See Also
    --------
    embedding_curvatures : All values for four points.

    Notes
    -----
    Each angle increases with k, so the root is unique.  At k = 0 the angles grow by a third of the area, so that angle
    defect over a third of the area, the usual curvature of a vertex of a mesh, is the first step of Newton's method.

    Examples
    --------
    Six points at distance 1 from the centre and from their neighbours are flat; five are not:

    >>> abs(round(float(star_curvature([1] * 6, [1] * 6)), 12))
    0.0
    >>> round(float(star_curvature([1] * 5, [1] * 5)), 6)
    1.225778
    """
    r, c = as_floats(radii, "radii"), as_floats(chords, "chords")
    if r.ndim == 0 or r.shape != c.shape or r.shape[-1] < 3:
        raise InvalidInputError(
            f"radii and chords have shapes {r.shape} and {c.shape}; give n >= 3 of each, shape (..., n)."
        )
    n = r.shape[-1]
    out = np.empty(r.shape[:-1])
    rows, exponents = rows_in_own_unit(np.concatenate([r.reshape(-1, n), c.reshape(-1, n)], axis=1))
    flat = out.reshape(-1)
    stars.closed_star_curvatures(np.ascontiguousarray(rows[:, :n]), np.ascontiguousarray(rows[:, n:]), flat)
    return in_unit(flat, -2 * exponents).reshape(out.shape)[()]
