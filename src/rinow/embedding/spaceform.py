"""The model surfaces: plane, spheres and hyperbolic planes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rinow import tolerances
from rinow._arrays import as_floats
from rinow.errors import InvalidInputError
from rinow.kernels import spaceform, spaceform_model

__all__ = ["SpaceForm"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class SpaceForm:
    r"""The plane, a sphere or a hyperbolic plane: the surface S_k of constant curvature k.

    It is the sphere of radius :math:`1/\sqrt{k}` for k > 0, the plane for k = 0 and the hyperbolic plane for k < 0.
    All methods work on arrays of any shape, broadcast against each other, and pass smoothly through k = 0.

    Parameters
    ----------
    curvature : float
        Curvature k in 1/length², of any sign.

    Raises
    ------
    InvalidInputError
        If `curvature` is not a finite number.

    Notes
    -----
    Points are rows (x, y, z) with :math:`x^2 + y^2 + k z^2 = 2z`: at distance r and direction θ from the origin they
    are :math:`(s_k(r)\cos\theta,\ s_k(r)\sin\theta,\ 2 s_k(r/2)^2)`, where :math:`s_k(r) = \sin(\sqrt k r)/\sqrt k`.
    For k = 0 that is the plane point (x, y) with half its squared norm.

    Examples
    --------
    An equilateral triangle with right angles fills one eighth of the unit sphere:

    >>> sphere = SpaceForm(1.0)
    >>> side = np.pi / 2
    >>> bool(np.isclose(sphere.angle(side, side, side), np.pi / 2))
    True
    >>> bool(np.isclose(sphere.area(side, side, side), 4 * np.pi / 8))
    True
    """

    curvature: float

    def __post_init__(self) -> None:
        k = as_floats(self.curvature, "curvature")
        if k.ndim or not math.isfinite(k):
            raise InvalidInputError(f"curvature = {self.curvature!r} is not one finite number; give one, in 1/length².")
        object.__setattr__(self, "curvature", float(k))

    @property
    def diameter(self) -> float:
        """Largest distance of two points: π/√k, or inf for k <= 0."""
        return math.pi / math.sqrt(self.curvature) if self.curvature > 0 else math.inf

    def distance(self, x: ArrayLike, y: ArrayLike) -> Floats:
        """Distance of points in model coordinates.

        Parameters
        ----------
        x, y : (..., 3) array_like of float
            Points, as `sample` and `embed` return them.

        Returns
        -------
        distance : (...) ndarray of float
            In [0, `diameter`], with the relative accuracy of the coordinates however near the points are.

        Raises
        ------
        InvalidInputError
            If a shape or a type is wrong.
        """
        shape, (p, q) = _rows((3, 3), x=x, y=y)
        out = np.empty(len(p))
        spaceform_model.distances(p, q, self.curvature, out)
        return out.reshape(shape)[()]

    def angle(self, a: ArrayLike, b: ArrayLike, c: ArrayLike) -> Floats:
        r"""Angle opposite the side a of the triangle with the sides a, b, c.

        Parameters
        ----------
        a, b, c : (...) array_like of float
            Side lengths.

        Returns
        -------
        angle : (...) ndarray of float
            In radians, in [0, π]; 0 or π for linear sides.  It is nan for sides that fail the triangle inequality and
            for a perimeter above 2π/√k.  A side of length 0 leaves the limit of isosceles triangles: 0 opposite it,
            π/2 at its ends.

        Raises
        ------
        InvalidInputError
            If a shape or a type is wrong.

        Notes
        -----
        :math:`\tan^2(\alpha/2) = s_k(s-b) s_k(s-c) / (s_k(s) s_k(s-a))` with half the perimeter s.
        """
        shape, (a, b, c) = _rows((0, 0, 0), a=a, b=b, c=c)
        out = np.empty(len(a))
        spaceform.angles(a, b, c, self.curvature, out)
        return out.reshape(shape)[()]

    def side(self, b: ArrayLike, c: ArrayLike, angle: ArrayLike) -> Floats:
        r"""Length of the side opposite `angle`, which the sides b and c enclose.

        Parameters
        ----------
        b, c : (...) array_like of float
            Side lengths; nan is returned where one is negative.
        angle : (...) array_like of float
            In radians.

        Returns
        -------
        side : (...) ndarray of float
            In [abs(b - c), b + c] and at most `diameter`.

        Raises
        ------
        InvalidInputError
            If a shape or a type is wrong.

        Notes
        -----
        :math:`s_k(a/2)^2 = s_k((b-c)/2)^2\cos^2(\alpha/2) + s_k((b+c)/2)^2\sin^2(\alpha/2)`: no term is negative.
        """
        shape, (b, c, alpha) = _rows((0, 0, 0), b=b, c=c, angle=angle)
        out = np.empty(len(b))
        spaceform.sides(b, c, alpha, self.curvature, out)
        return out.reshape(shape)[()]

    def area(self, a: ArrayLike, b: ArrayLike, c: ArrayLike) -> Floats:
        r"""Area of the triangle with the sides a, b, c.

        Parameters
        ----------
        a, b, c : (...) array_like of float
            Side lengths.

        Returns
        -------
        area : (...) ndarray of float
            In length², in [0, 2π/k]; nan where `angle` is.

        Raises
        ------
        InvalidInputError
            If a shape or a type is wrong.

        Notes
        -----
        L'Huilier's formula for the excess kA, divided by k: :math:`\tan(kA/4)/k` is the square root of the product of
        :math:`t_k = s_k/s_k'` at s/2, (s-a)/2, (s-b)/2 and (s-c)/2; Heron's formula is its value at k = 0.
        """
        shape, (a, b, c) = _rows((0, 0, 0), a=a, b=b, c=c)
        out = np.empty(len(a))
        spaceform.areas(a, b, c, self.curvature, out)
        return out.reshape(shape)[()]

    def embed(self, quadruple: ArrayLike, *, rtol: float = tolerances.EMBEDDING) -> Floats:
        """Four points of the surface with given distances.

        Parameters
        ----------
        quadruple : (..., 6) array_like of float
            Distances d12, d13, d14, d23, d24, d34.
        rtol : float, default 1e-9
            Error allowed in a distance, relative to the largest one.

        Returns
        -------
        points : (..., 4, 3) ndarray of float
            Model coordinates, unique up to an isometry; nan where the curvature is not an embedding curvature.

        Raises
        ------
        InvalidInputError
            If a shape or a type is wrong.

        Examples
        --------
        The unit square is flat:

        >>> square = [1, 2**0.5, 1, 1, 2**0.5, 1]
        >>> plane = SpaceForm(0.0)
        >>> points = plane.embed(square)
        >>> bool(np.isclose(plane.distance(points[0], points[2]), 2**0.5))
        True
        >>> bool(np.isnan(SpaceForm(1.0).embed(square)).all())
        True
        """
        shape, (Q,) = _rows((6,), quadruple=quadruple)
        points = np.empty((len(Q), 4, 3))
        spaceform_model.place_quadruples(Q, self.curvature, float(rtol), points)
        return points.reshape(*shape, 4, 3)

    def sample(self, n: int, radius: float, rng: np.random.Generator) -> Floats:
        r"""Points spread evenly over the disk of the given radius about the origin.

        Parameters
        ----------
        n : int
            Number of points.
        radius : float
            Radius of the disk, in [0, `diameter`].
        rng : numpy.random.Generator
            Source of random numbers.

        Returns
        -------
        points : (n, 3) ndarray of float
            Model coordinates.

        Raises
        ------
        InvalidInputError
            If `n` is negative or `radius` is outside its range.

        Notes
        -----
        The disk of radius r has the area :math:`2\pi z` with :math:`z = 2 s_k(r/2)^2` (Archimedes), so z and the
        direction are uniform.
        """
        if n < 0 or not 0 <= radius <= self.diameter * (1 + 1e-15):
            raise InvalidInputError(f"n = {n}, radius = {radius}: give n >= 0 and 0 <= radius <= {self.diameter:.17g}.")
        z = 2 * spaceform.sine(0.5 * radius, self.curvature) ** 2 * rng.random(n)
        rho = np.sqrt(z * np.maximum(2 - self.curvature * z, 0.0))
        theta = 2 * np.pi * rng.random(n)
        return np.stack([rho * np.cos(theta), rho * np.sin(theta), z], axis=1)


def _rows(widths: tuple[int, ...], **arrays: ArrayLike) -> tuple[tuple[int, ...], list[Floats]]:
    """Common shape of the arrays, and each as flat rows of its width (0: as numbers) broadcast to that shape."""
    values = [as_floats(array, name) for name, array in arrays.items()]
    for name, value, width in zip(arrays, values, widths, strict=True):
        if width and value.shape[-1:] != (width,):
            raise InvalidInputError(f"{name} has shape {value.shape}; its last length must be {width}.")
    tails = [(width,) if width else () for width in widths]
    heads = [value.shape[: value.ndim - len(tail)] for value, tail in zip(values, tails, strict=True)]
    try:
        shape = np.broadcast_shapes(*heads)
    except ValueError:
        raise InvalidInputError(f"{', '.join(arrays)} have shapes {heads}, which do not fit together.") from None
    full = zip(values, tails, strict=True)
    return shape, [np.ascontiguousarray(np.broadcast_to(v, shape + tail)).reshape(-1, *tail) for v, tail in full]
