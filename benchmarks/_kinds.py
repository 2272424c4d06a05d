"""Kinds of generated parts, by name, as functions of how they are sampled."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from _parts import Floats, Part, Piece, Sampling, lathe, polyhedron, prism
from scipy.spatial import HalfspaceIntersection, QhullError

__all__ = ["COARSE_LIMIT", "KINDS"]

LEAST_TURN, LEAST_EDGE = np.radians(30.0), 0.4
"""Of random polyhedra: less is beyond the method, or smaller than two edges."""


def polygon(points: object) -> list[Piece]:
    """An outline of straight pieces."""
    P = [(float(x), float(y)) for x, y in np.asarray(points)]
    return [Piece(a, b) for a, b in zip(P, P[1:] + P[:1], strict=True)]


def regular(n: int, radius: float = 1.0) -> Floats:
    """The regular polygon with n corners."""
    t = 2.0 * np.pi * np.arange(n) / n
    return radius * np.stack([np.cos(t), np.sin(t)], axis=1)


def hole(x: float, y: float, radius: float) -> list[Piece]:
    """A round hole."""
    start = (x + radius, y)
    return [Piece(start, start, is_smooth=True, centre=(x, y), angle=-2.0 * np.pi)]


def rounded_outline(a: float, b: float, r: float) -> list[Piece]:
    """A rectangle with round corners."""
    pieces = []
    for k, (x, y) in enumerate(((a - r, b - r), (r, b - r), (r, r), (a - r, r))):
        t = k * np.pi / 2.0
        c, s = round(np.cos(t)), round(np.sin(t))
        start, end = (x + r * c, y + r * s), (x - r * s, y + r * c)
        if pieces:
            pieces.append(Piece(pieces[-1].end, start, is_smooth=True))
        pieces.append(Piece(start, end, is_smooth=True, centre=(x, y), angle=np.pi / 2.0))
    return [*pieces, Piece(pieces[-1].end, pieces[0].start, is_smooth=True)]


def pyramid(n: int, height: float, sampling: Sampling) -> Part:
    """A pyramid over a regular polygon."""
    base, apex = np.column_stack([regular(n), np.zeros(n)]), np.array([0.0, 0.0, height])
    flanks = [np.stack([a, b, apex]) for a, b in zip(base, np.roll(base, -1, axis=0), strict=True)]
    return polyhedron([base[::-1], *flanks], sampling)


def random_polyhedron(sampling: Sampling) -> Part:
    """A convex polyhedron with ten to fourteen sides, turns of 30° or more and edges of 0.4 or more."""
    rng = sampling.rng
    while True:
        N = rng.normal(size=(rng.integers(7, 12), 3))
        N /= np.linalg.norm(N, axis=1)[:, None]
        d = rng.uniform(0.9, 1.1, len(N))
        try:
            V = HalfspaceIntersection(np.column_stack([N, -d]), np.zeros(3)).intersections
        except QhullError:  # unbounded
            continue
        if np.abs(V).max() > 3.0:
            continue
        V = np.unique(np.round(V, 7), axis=0)
        on = np.abs(V @ N.T - d) < 1e-6
        if (on.sum(axis=1) != 3).any() or (on.sum(axis=0) < 3).any():
            continue
        V = np.stack([np.linalg.solve(N[row], d[row]) for row in on])
        joined = np.triu((on.T.astype(int) @ on) == 2, 1)
        ends = [np.flatnonzero(on[:, i] & on[:, j]) for i, j in np.argwhere(joined)]
        if min(np.linalg.norm(V[a] - V[b]) for a, b in ends) < LEAST_EDGE:
            continue
        if np.arccos((N @ N.T)[joined]).min() > LEAST_TURN:
            return polyhedron([around(V[on[:, k]], N[k]) for k in range(len(N))], sampling)


def around(points: Floats, normal: Floats) -> Floats:
    """The corners of a convex polygon in order, counter-clockwise about its normal."""
    e1 = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    e2 = np.cross(normal, e1)
    centred = points - points.mean(axis=0)
    return points[np.argsort(np.arctan2(centred @ e2, centred @ e1))]


L_OUTLINE = [(0, 0), (1.6, 0), (1.6, 0.7), (0.7, 0.7), (0.7, 1.5), (0, 1.5)]
T_OUTLINE = [(0.6, 0), (1.2, 0), (1.2, 1), (1.8, 1), (1.8, 1.6), (0, 1.6), (0, 1), (0.6, 1)]
U_OUTLINE = [(0, 0), (2, 0), (2, 1.4), (1.4, 1.4), (1.4, 0.6), (0.6, 0.6), (0.6, 1.4), (0, 1.4)]
THIN_OUTLINE = [(0, 0), (1.5, 0), (1.5, 1), (1.37, 1), (1.37, 0.13), (0.13, 0.13), (0.13, 1), (0, 1)]
CHAMFERED = [(0.15, 0), (1.35, 0), (1.5, 0.15), (1.5, 0.85), (1.35, 1), (0.15, 1), (0, 0.85), (0, 0.15)]
SHAFT = [(0, 0), (1, 0), (1, 0.8), (0.6, 0.8), (0.6, 2), (0, 2)]
Kind = Callable[[Sampling], Part]
KINDS: dict[str, Kind] = {
    "box 1:1:1": lambda s: prism([polygon([(0, 0), (1, 0), (1, 1), (0, 1)])], 1.0, s),
    "box 2:1:0.4": lambda s: prism([polygon([(0, 0), (2, 0), (2, 1), (0, 1)])], 0.4, s),
    "box 3:0.5:0.5": lambda s: prism([polygon([(0, 0), (3, 0), (3, 0.5), (0, 0.5)])], 0.5, s),
    **{f"prism, {n} sides": lambda s, n=n: prism([polygon(regular(n))], 1.2, s) for n in range(3, 13)},
    "cylinder 1:1.5": lambda s: lathe([(0, 0), (1, 0), (1, 1.5), (0, 1.5)], s),
    "cylinder 0.5:2": lambda s: lathe([(0, 0), (0.5, 0), (0.5, 2), (0, 2)], s),
    "cone, slope 0.5": lambda s: lathe([(0, 0), (1, 0), (0, 0.5)], s),
    "cone, slope 1": lambda s: lathe([(0, 0), (1, 0), (0, 1)], s),
    "cone, slope 2": lambda s: lathe([(0, 0), (1, 0), (0, 2)], s),
    "frustum": lambda s: lathe([(0, 0), (1, 0), (0.5, 1), (0, 1)], s),
    "L": lambda s: prism([polygon(L_OUTLINE)], 0.8, s),
    "T": lambda s: prism([polygon(T_OUTLINE)], 0.8, s),
    "U": lambda s: prism([polygon(U_OUTLINE)], 0.8, s),
    "rounded plate": lambda s: prism([rounded_outline(2.0, 1.5, 0.5)], 0.5, s),
    "wedge": lambda s: prism([polygon([(0, 0), (1.6, 0), (1.6, 0.9)])], 1.0, s),
    "pyramid, 4 sides": lambda s: pyramid(4, 1.2, s),
    "pyramid, 5 sides": lambda s: pyramid(5, 0.9, s),
    "shaft": lambda s: lathe(SHAFT, s),
    "plate with hole": lambda s: prism([polygon([(0, 0), (2, 0), (2, 2), (0, 2)]), hole(1, 1, 0.6)], 0.5, s),
    "nut": lambda s: prism([polygon(regular(6)), hole(0, 0, 0.5)], 0.7, s),
    "ring": lambda s: lathe([(0.5, 0), (1, 0), (1, 0.4), (0.5, 0.4), (0.5, 0)], s),
    "countersink": lambda s: lathe([(0.3, 0), (1, 0), (1, 0.5), (0.7, 0.5), (0.3, 0.25), (0.3, 0)], s),
    "boss": lambda s: lathe([(0, 0), (1, 0), (1, 0.3), (0.4, 0.3), (0.4, 0.8), (0, 0.8)], s),
    "thin plate": lambda s: prism([polygon([(0, 0), (2, 0), (2, 1.5), (0, 1.5)])], 0.12, s),
    "thin U": lambda s: prism([polygon(THIN_OUTLINE)], 0.8, s),
    "chamfered box": lambda s: prism([polygon(CHAMFERED)], 0.8, s),
    "thin tube": lambda s: lathe([(0.6, 0), (0.7, 0), (0.7, 1.5), (0.6, 1.5), (0.6, 0)], s),
    "polyhedron": random_polyhedron,
}
COARSE_LIMIT = 9
"""Sides of prisms of which every side is two triangles: with more they are coarse cylinders."""
