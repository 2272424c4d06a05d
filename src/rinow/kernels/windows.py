"""Cones of straight lines in the unfolded plane: how they pass through a face, and how far they look."""

import math
from typing import NamedTuple

import numpy as np

from rinow.kernels._jit import kernel
from rinow.kernels.unfolding import cross, dot, square
from rinow.tolerances import SEEN_ANGLE

NO_ROW = -1
_SEEN_SQUARE = SEEN_ANGLE * SEEN_ANGLE


class Window(NamedTuple):
    """Straight lines from the origin that enter a face between two rays, through one of its half-edges."""

    row: int
    """The half-edge, `NO_ROW` for no window."""
    start: complex
    """Its start, on the left seen from the origin."""
    edge: complex
    """From its start to its end; kept by itself, for the difference of two positions loses the shape of a needle."""
    left: complex
    """A point on the left ray."""
    right: complex
    """A point on the right ray."""


WINDOW = np.dtype(
    [
        ("start", np.complex128),
        ("edge", np.complex128),
        ("left", np.complex128),
        ("right", np.complex128),
        ("offset", np.float64),  # distance of the origin from the source
        ("distance", np.float64),  # least distance from the source at which the window enters its face
        ("row", np.int64),
        ("origin", np.int32),  # where the origin is: a half-edge at the source, or minus the slot of a vertex
        ("beaten", np.int32),  # it saw a vertex to which a shorter path was known
    ]
)
"""A window laid by, with the history it needs when it is taken up again."""


@kernel
def lay_by(record, window, offset, distance, origin, beaten):
    """Write a window and its history to a record."""
    record["row"], record["start"], record["edge"] = window.row, window.start, window.edge
    record["left"], record["right"] = window.left, window.right
    record["offset"], record["distance"] = offset, distance
    record["origin"], record["beaten"] = origin, beaten


@kernel
def taken(record):
    """Window, offset, origin and whether it was beaten."""
    window = Window(record["row"], record["start"], record["edge"], record["left"], record["right"])
    return window, record["offset"], np.intp(record["origin"]), record["beaten"] != 0


@kernel
def through(window, row):
    """The same window, entering another face through the same edge."""
    return Window(row, window.start, window.edge, window.left, window.right)


@kernel
def beyond(window, face):
    """Apex of a face and the windows that leave it on the left and on the right."""
    to_apex = face["from_start"] * window.edge
    apex = window.start + to_apex
    to_left, to_right = cross(window.left, apex) < 0.0, cross(window.right, apex) > 0.0
    left_row = np.intp(face["left"]) if to_left else np.intp(NO_ROW)
    right_row = np.intp(face["right"]) if to_right or not to_left else np.intp(NO_ROW)
    left = Window(left_row, window.start, to_apex, window.left, apex if to_right else window.right)
    right = Window(right_row, apex, -(face["from_end"] * window.edge), apex if to_left else window.left, window.right)
    return apex, left, right


@kernel
def is_seen(window, point):
    """Whether a point lies in the cone, or beside it by no more than rounding can explain.

    A vertex exactly behind another one may fall between the cones on either side of it.  The cones are never widened.
    """
    n = square(point)
    from_left, from_right = cross(window.left, point), cross(window.right, point)
    return (from_left <= 0.0 or from_left * from_left <= _SEEN_SQUARE * n * square(window.left)) and (
        from_right >= 0.0 or from_right * from_right <= _SEEN_SQUARE * n * square(window.right)
    )


@kernel
def is_open(window):
    """Whether the rays hold an angle between them, up to π: so wide is the corner of a vertex on the opposite edge."""
    turn = cross(window.right, window.left)
    return turn > 0.0 or (turn == 0.0 and dot(window.right, window.left) < 0.0)


@kernel
def nearest_ray(window):
    """Direction from the origin to the nearest point of the edge inside the cone."""
    foot = complex(-window.edge.imag, window.edge.real)
    beside = foot if dot(window.right, window.edge) >= 0.0 else window.right
    return beside if dot(window.left, window.edge) <= 0.0 else window.left


@kernel
def comes_within(window, radius_square):
    """Whether some line of the window meets its edge, from the near side, within the radius: no root, no division."""
    ray = nearest_ray(window)
    height, slope = cross(window.edge, window.start), cross(window.edge, ray)
    return slope > 0.0 and height * height * square(ray) <= radius_square * slope * slope


@kernel
def entry_distance(window):
    """Least distance at which a line of the window meets its edge, which `comes_within` some radius."""
    ray = nearest_ray(window)
    return abs(cross(window.edge, window.start)) * math.sqrt(square(ray)) / cross(window.edge, ray)


@kernel
def corner_window(row, sides, angle, low, high):
    """The part of a corner at the origin between two bearings, counted from its first side.

    Bounds beyond the corner leave its sides as rays, free of rounding.
    """
    first, last, opposite = sides
    right = first if low <= 0.0 else complex(math.cos(low), math.sin(low))
    left = last if high >= angle else complex(math.cos(high), math.sin(high))
    return Window(row, last, -opposite, left, right)
