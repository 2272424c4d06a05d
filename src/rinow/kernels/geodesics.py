"""Exact geodesic balls on a surface of flat triangles.

A shortest path is a chain of straight lines in the unfolded plane that bends only at saddles, at the boundary and at
singular vertices.  From the source, and from each such vertex in the order of distance, windows of straight lines are
followed from face to face, depth first within a shell; those that leave the shell wait for the next one.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.kernels import heaps
from rinow.kernels._jit import kernel
from rinow.kernels.fans import PLAIN, SADDLE, SINGULAR, following
from rinow.kernels.unfolding import cross, dot, square
from rinow.kernels.windows import (
    WINDOW,
    beyond,
    comes_within,
    corner_window,
    entry_distance,
    is_open,
    is_seen,
    lay_by,
    taken,
    through,
)
from rinow.tolerances import DETOUR, SEEN_ANGLE

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

_WORK_PER_ITEM = 64
_WORK_AT_LEAST = 4096
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
    """Record a path to a vertex within the radius; return whether a clearly shorter one was known."""
    if distance > radius:
        return False
    slot = np.intp(ball.slots[vertex])
    if slot == 0:
        ball.counts[N_REACHED] += 1
        slot = ball.counts[N_REACHED]
        ball.slots[vertex] = slot
        ball.reached[slot]["vertex"], ball.reached[slot]["distance"] = vertex, np.inf
    record = ball.reached[slot]
    if distance < record["distance"]:
        record["distance"], record["arrival"], record["origin"] = distance, arrival, origin
        record["position"], record["side"] = place
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
def is_detour(window, offset, at_start, at_end):
    """Whether the far point of a window on its edge has a shorter path along the edge, from either end of it.

    By the triangle inequality so has every point where a line of the window enters its face (Xin and Wang 2009).
    """
    height = cross(window.edge, window.start)
    slope_left, slope_right = cross(window.edge, window.left), cross(window.edge, window.right)
    if slope_left <= 0.0 or slope_right <= 0.0:
        return False
    to_left, to_right = window.left * (height / slope_left), window.right * (height / slope_right)
    from_start, from_end = to_right - window.start, to_left - window.start - window.edge
    far = 1.0 - DETOUR
    return far * (offset + math.sqrt(square(to_right))) > at_start + math.sqrt(square(from_start)) or far * (
        offset + math.sqrt(square(to_left))
    ) > at_end + math.sqrt(square(from_end))


@kernel
def defer(waiting, counts, window, offset, origin):
    """Keep a window for a later shell."""
    if counts[N_DEFERRED] < waiting.deferred.shape[0]:
        distance = offset + entry_distance(window)
        lay_by(waiting.deferred[counts[N_DEFERRED]], window, offset, distance, origin, False)
        counts[N_DEFERRED] += 1
    else:
        counts[FULL] = 1


@kernel
def stays(waiting, counts, window, offset, origin, shell_square):
    """Whether a window belongs to this shell; otherwise it is deferred."""
    if comes_within(window, shell_square):
        return True
    defer(waiting, counts, window, offset, origin)
    return False


@kernel
def stacked(waiting, counts, depth, window, offset, origin, beaten):
    """Put a window on the stack, or defer it when the stack is full; return the new depth."""
    if depth == waiting.stack.shape[0]:
        defer(waiting, counts, window, offset, origin)
        counts[ALLOWANCE] = 0  # the shell is not finished
        return depth
    lay_by(waiting.stack[depth], window, offset, 0.0, origin, beaten)
    return depth + 1


@kernel
def trace(surface, ball, waiting, depth, radius, limit):
    """Follow the windows on the stack, depth first, to the edge of the shell; what exceeds the allowance waits."""
    counts, work, allowance = ball.counts, ball.counts[WORK], ball.counts[ALLOWANCE]
    while depth > 0:
        depth -= 1
        window, offset, origin, beaten = taken(waiting.stack[depth])
        reach_square, shell_square = (radius - offset) ** 2, max(limit - offset, 0.0) ** 2
        if work > allowance:
            defer(waiting, counts, window, offset, origin)
            continue
        while True:
            work += 1
            face = surface.halfedges[window.row]
            if face["sibling"] >= 0:
                other = through(window, np.intp(face["sibling"]))
                depth = stacked(waiting, counts, depth, other, offset, origin, beaten)
            apex, left, right = beyond(window, face)
            if square(apex) <= reach_square and is_seen(window, apex):
                vertex, arrival = np.intp(face["apex"]), np.intp(face["previous"])
                bend, distance, place = surface.vertices[vertex], offset + math.sqrt(square(apex)), (apex, -left.edge)
                beaten |= reach(ball, vertex, bend, distance, place, arrival, origin, radius)
            go_left = left.row >= 0 and comes_within(left, reach_square)
            go_right = right.row >= 0 and comes_within(right, reach_square)
            if beaten:
                at_start, at_end, at_apex = known_distances(surface, ball, window.row)
                go_left = go_left and not is_detour(left, offset, at_start, at_apex)
                go_right = go_right and not is_detour(right, offset, at_apex, at_end)
            if shell_square < reach_square:
                go_left = go_left and stays(waiting, counts, left, offset, origin, shell_square)
                go_right = go_right and stays(waiting, counts, right, offset, origin, shell_square)
            if go_left and go_right:
                depth = stacked(waiting, counts, depth, right, offset, origin, beaten)
            elif not (go_left or go_right):
                break
            window = left if go_left else right
    counts[WORK] = work


@kernel
def open_corners(surface, ball, waiting, slot, bearings, radius, depth):
    """Reach the neighbours of a vertex between two bearings and stack the windows between them; return the depth."""
    low, high = bearings
    offset, vertex = ball.reached[slot]["distance"], surface.vertices[ball.reached[slot]["vertex"]]
    for i in range(vertex["fan"], vertex["fan_end"]):
        fan = surface.fans[i]
        if fan["last"] < low - SEEN_ANGLE or fan["first"] > high + SEEN_ANGLE:
            continue
        row = fan["row"]
        face, origin = surface.halfedges[row], np.intp(row) if slot == 1 else -np.intp(slot)
        first = complex(fan["first_length"], 0.0)
        last, opposite = first * face["from_start"], first * face["from_end"]
        if fan["first"] >= low - SEEN_ANGLE:
            distance, arrival = offset + fan["first_length"], np.intp(following(row, surface.halfedges))
            end = np.intp(face["end"])
            reach(ball, end, surface.vertices[end], distance, (first, opposite), arrival, origin, radius)
        if fan["last"] <= high + SEEN_ANGLE:
            distance, arrival = offset + fan["last_length"], np.intp(face["previous"])
            apex = np.intp(face["apex"])
            reach(ball, apex, surface.vertices[apex], distance, (last, -last), arrival, origin, radius)
        sides, angle = (first, last, opposite), fan["last"] - fan["first"]
        window = corner_window(np.intp(face["right"]), sides, angle, low - fan["first"], high - fan["first"])
        if window.row >= 0 and is_open(window) and comes_within(window, (radius - offset) ** 2):
            depth = stacked(waiting, ball.counts, depth, window, offset, origin, surface.branches)
    return depth


@kernel
def arrival_bearing(surface, record):
    """Bearing, in the fan of a vertex, of the path that reached it."""
    back = -record["position"]
    turn = math.atan2(cross(record["side"], back), dot(record["side"], back))
    return abs(surface.halfedges[record["arrival"]]["bearing"] + turn)


@kernel
def radiate(surface, ball, waiting, slot, radius, limit):
    """Shoot from the source in all directions, from another vertex into its shadow: at least π from the path to it."""
    record = ball.reached[slot]
    vertex = surface.vertices[record["vertex"]]
    if slot == 1 or vertex["kind"] == SINGULAR:
        depth = open_corners(surface, ball, waiting, slot, (-np.inf, np.inf), radius, 0)
    else:
        total, bearing = vertex["total_angle"], arrival_bearing(surface, record)
        low, high = bearing + math.pi, bearing - math.pi
        if vertex["kind"] == SADDLE:
            low, high = (low, total + high) if low < total else (low - total, high)
            depth = open_corners(surface, ball, waiting, slot, (low, high), radius, 0)
            if high > total:
                depth = open_corners(surface, ball, waiting, slot, (0.0, high - total), radius, depth)
        else:
            depth = open_corners(surface, ball, waiting, slot, (-np.inf, high), radius, 0)
            depth = open_corners(surface, ball, waiting, slot, (low, np.inf), radius, depth)
    trace(surface, ball, waiting, depth, radius, limit)


@kernel
def resume(surface, ball, waiting, radius, limit):
    """Follow the deferred windows that enter the shell, unless a shorter path has become known."""
    i = 0
    while i < ball.counts[N_DEFERRED] and ball.counts[WORK] <= ball.counts[ALLOWANCE]:
        if waiting.deferred[i]["distance"] > limit:
            i += 1
            continue
        window, offset, origin, _ = taken(waiting.deferred[i])
        ball.counts[N_DEFERRED] -= 1
        waiting.deferred[i] = waiting.deferred[ball.counts[N_DEFERRED]]
        at_start, at_end, _ = known_distances(surface, ball, window.row)
        if not is_detour(window, offset, at_start, at_end):
            lay_by(waiting.stack[0], window, offset, 0.0, origin, surface.branches)
            trace(surface, ball, waiting, 1, radius, limit)


@kernel
def sweep(surface, ball, waiting, radius, limit):
    """Finish a shell as far as the allowance goes; return the least distance of what is left to do."""
    resume(surface, ball, waiting, radius, limit)
    while ball.counts[N_PENDING] > 0 and ball.counts[WORK] <= ball.counts[ALLOWANCE]:
        distance = ball.pending[0]["distance"]
        if distance > limit:
            break
        slot = heaps.pop(ball.pending, ball.counts[N_PENDING])
        ball.counts[N_PENDING] -= 1
        if distance == ball.reached[slot]["distance"]:  # otherwise a shorter path was found after this entry
            radiate(surface, ball, waiting, slot, radius, limit)
    least = ball.pending[0]["distance"] if ball.counts[N_PENDING] > 0 else np.inf
    for i in range(ball.counts[N_DEFERRED]):
        least = min(least, waiting.deferred[i]["distance"])
    return least


@kernel
def fill_ball(surface, ball, waiting, source, radius):
    """Reach all vertices within the radius of the source; return whether there was room for the work.

    A shell whose work gets out of hand, because many windows overlap there, is cut into thinner ones: the more
    distances are final, the more windows are known to be detours.  Once the whole component is reached, its farthest
    vertex bounds the radius.
    """
    ball.counts[:] = 0
    reach(ball, source, surface.vertices[source], 0.0, (0j, 0j), 0, 0, radius)
    ball.pending[0]["distance"], ball.pending[0]["slot"], ball.counts[N_PENDING] = 0.0, 1, 1
    least, stride = 0.0, surface.stride
    while least <= radius and least < np.inf and ball.counts[FULL] == 0:
        limit = min(radius, least + stride)
        items = ball.counts[N_REACHED] + ball.counts[N_DEFERRED]
        ball.counts[WORK], ball.counts[ALLOWANCE] = 0, _WORK_AT_LEAST + _WORK_PER_ITEM * items
        least = sweep(surface, ball, waiting, radius, limit)
        overrun = ball.counts[WORK] > ball.counts[ALLOWANCE]
        stride = stride / 8.0 if overrun else min(2.0 * stride, surface.stride)
        if ball.counts[N_REACHED] == surface.vertices[source]["component_size"]:
            radius = min(radius, farthest(ball))
    return ball.counts[FULL] == 0


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
