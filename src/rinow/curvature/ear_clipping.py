"""Ear clipping: triangles of a plane polygon whose corners are vertices of a mesh."""

from __future__ import annotations

from math import acos, hypot

from rinow.curvature.edits import EditedFaces, Face

__all__ = ["Place", "angle_between", "triangulated"]

Place = tuple[float, float]


def triangulated(edited: EditedFaces, flat: dict[int, Place], polygon: list[int]) -> list[Face] | None:
    """Triangles that fill a polygon given counter-clockwise, without an edge that the mesh has; None if there are none.

    The ear with the largest least angle is cut off first.
    """
    found, rest = list[Face](), list(polygon)
    while len(rest) > 2:
        ears = [i for i in range(len(rest)) if _is_ear(edited, flat, rest, i)]
        if not ears:
            return None
        i = max(ears, key=lambda i: _least_angle([flat[rest[(i + k) % len(rest)]] for k in (-1, 0, 1)]))
        found.append((rest[i - 1], rest[i], rest[(i + 1) % len(rest)]))
        del rest[i]
    return found


def angle_between(a: float, b: float, c: float) -> float:
    """Angle between the sides a and b of a triangle."""
    return acos(min(max((a * a + b * b - c * c) / (2.0 * a * b), -1.0), 1.0))


def _is_ear(edited: EditedFaces, flat: dict[int, Place], rest: list[int], i: int) -> bool:
    """Three vertices in a row are a triangle inside of a polygon, whose new edge is not one of the mesh."""
    u, v, w = (rest[(i + k) % len(rest)] for k in (-1, 0, 1))
    if len(rest) > 3 and edited.on_edge(u, w):
        return False
    corners = [flat[x] for x in (u, v, w)]
    others = [flat[x] for x in rest if x not in (u, v, w)]
    if _turn(*corners) <= 0.0:
        return False
    return not any(all(_turn(corners[k - 1], corners[k], p) >= 0.0 for k in range(3)) for p in others)


def _turn(p: Place, q: Place, r: Place) -> float:
    """Twice the area of a triangle, positive to the left."""
    return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])


def _least_angle(corners: list[Place]) -> float:
    a, b, c = (hypot(p[0] - q[0], p[1] - q[1]) for p, q in zip(corners, corners[1:] + corners[:1], strict=True))
    return min(angle_between(a, b, c), angle_between(b, c, a), angle_between(c, a, b))
