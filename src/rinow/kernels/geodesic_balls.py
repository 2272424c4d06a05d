"""The data of geodesic balls: the prepared surface, the vertices reached, the windows that wait."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.kernels import heaps
from rinow.kernels._jit import kernel
from rinow.kernels.fans import PLAIN, SINGULAR
from rinow.kernels.unfolding import cross, dot
from rinow.kernels.windows import WINDOW
from rinow.tolerances import DETOUR, EQUAL_PATHS

REACHED = np.dtype(
    [
        ("distance", np.float64),
        ("position", np.complex128),  # in the plane of the window that reached it
        ("side", np.complex128),  # from there, along `arrival`
        ("vertex", np.int32),
        ("arrival", np.int32),  # a half-edge from the vertex, in the face the path came through
        ("origin", np.int32),  # of the window: a half-edge at the source, or minus the slot of a vertex
    ],
    align=True,
)
"""A vertex of the ball."""

N_REACHED, N_PENDING, N_DEFERRED, WORK, ALLOWANCE, FULL = range(6)
"""Places of `Ball.counts`: numbers of records, faces crossed in this shell and how many may be, room exhausted."""

_STACK = 1024


class Surface(NamedTuple):
    """A surface prepared for geodesics."""

    halfedges: NDArray[np.void]
    fans: NDArray[np.void]
    vertices: NDArray[np.void]
    stride: float
    """Width of a shell."""
    branches: bool
    """Whether three or more faces meet at some edge: windows then multiply, so that each is tested for a detour."""


class Ball(NamedTuple):
    """Vertices reached from a source, and those of them from which paths go on."""

    slots: NDArray[np.int32]
    """(n_vertices,): place of each vertex in `reached`, counted from 1; 0 where it is not reached."""
    reached: NDArray[np.void]
    """Place 0 is infinitely far, place 1 holds the source."""
    pending: NDArray[np.void]
    """Heap of the vertices where paths bend."""
    counts: NDArray[np.int64]


class Waiting(NamedTuple):
    """Windows still to follow."""

    stack: NDArray[np.void]
    """In this shell."""
    deferred: NDArray[np.void]
    """In later shells."""


def new_balls(n_balls, n_vertices, room):
    """Empty balls, one per row; memory is touched only where a ball reaches, `room` bounds what may wait."""
    reached = np.empty((n_balls, n_vertices + 1), REACHED)
    reached["distance"][:, 0] = np.inf
    slots, pending = np.zeros((n_balls, n_vertices), np.int32), np.empty((n_balls, room), heaps.ENTRY)
    stack, deferred = np.empty((n_balls, _STACK), WINDOW), np.empty((n_balls, room), WINDOW)
    return Ball(slots, reached, pending, np.zeros((n_balls, 6), np.int64)), Waiting(stack, deferred)


@kernel
def ball_of_row(balls, i):
    """One of several balls."""
    return Ball(balls.slots[i], balls.reached[i], balls.pending[i], balls.counts[i])


@kernel
def waiting_of_row(waiting, i):
    """What waits for one of several balls."""
    return Waiting(waiting.stack[i], waiting.deferred[i])


@kernel
def reach(ball, vertex, bend, distance, place, arrival, origin, radius):
    """Record a path to a vertex within the radius; return whether a clearly shorter one was known.

    Of paths of one length, as symmetric surfaces have them, the one with the least half-edge of arrival is kept: else
    rounding would choose the direction.  One whose last step has no length is not taken then, for two vertices at one
    place could become the origins of each other.
    """
    if distance > radius:
        return False
    slot = np.intp(ball.slots[vertex])
    if slot == 0:
        ball.counts[N_REACHED] += 1
        slot = ball.counts[N_REACHED]
        ball.slots[vertex] = slot
        ball.reached[slot]["vertex"], ball.reached[slot]["distance"] = vertex, np.inf
    record = ball.reached[slot]
    known = record["distance"]
    if distance <= known * (1.0 + EQUAL_PATHS) and (
        distance < known * (1.0 - EQUAL_PATHS)
        or (arrival < record["arrival"] and abs(place[0]) > 4.0 * EQUAL_PATHS * known)
    ):
        record["arrival"], record["origin"] = arrival, origin
        record["position"], record["side"] = place
    if distance < known:
        record["distance"] = distance
        if bend["kind"] != PLAIN and distance + bend["clearance"] <= radius:
            if ball.counts[N_PENDING] < ball.pending.shape[0]:
                heaps.push(ball.pending, ball.counts[N_PENDING], distance, slot)
                ball.counts[N_PENDING] += 1
            else:
                ball.counts[FULL] = 1
    return distance * (1.0 - DETOUR) > record["distance"]


@kernel
def known_distances(surface, ball, row):
    """Distances recorded for start, end and apex of a half-edge; inf where there is none."""
    face = surface.halfedges[row]
    start = ball.slots[surface.halfedges[face["previous"]]["end"]]
    end, apex = ball.slots[face["end"]], ball.slots[face["apex"]]
    return ball.reached[start]["distance"], ball.reached[end]["distance"], ball.reached[apex]["distance"]


@kernel
def arrival_bearing(surface, record):
    """Bearing, in the fan of a vertex, of the path that reached it."""
    back = -record["position"]
    turn = math.atan2(cross(record["side"], back), dot(record["side"], back))
    return abs(surface.halfedges[record["arrival"]]["bearing"] + turn)


@kernel
def farthest(ball):
    """Largest distance reached."""
    distance = 0.0
    for slot in range(1, ball.counts[N_REACHED] + 1):
        distance = max(distance, ball.reached[slot]["distance"])
    return distance


@kernel
def empty_ball(ball):
    """Forget the vertices reached, at the cost of the ball, not of the mesh."""
    for slot in range(1, ball.counts[N_REACHED] + 1):
        ball.slots[ball.reached[slot]["vertex"]] = 0


@kernel
def direction(surface, ball, slot):
    """Bearing at the source of the path to a vertex; nan for the source itself and from a singular source."""
    if slot == 1 or surface.vertices[ball.reached[1]["vertex"]]["kind"] == SINGULAR:
        return np.nan
    while ball.reached[slot]["origin"] < 0:
        slot = -np.intp(ball.reached[slot]["origin"])
    position = ball.reached[slot]["position"]
    return surface.halfedges[ball.reached[slot]["origin"]]["bearing"] + math.atan2(position.imag, position.real)
