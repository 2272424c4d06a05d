"""Geodesic distances from many sources; balls come in batches as large as the earlier ones let expect."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rinow.errors import InvalidMeshError
from rinow.geodesics.unfolding import UnfoldedMesh
from rinow.kernels import geodesic_rows
from rinow.kernels._parallel import number_of_threads
from rinow.kernels.geodesic_balls import new_balls

__all__ = ["ball_rows", "distance_rows"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

_ROOM = 4096, 4  # windows that may wait at first, at least and per vertex of the mesh; memory is touched only where
# they do wait, and a source that needs more is computed again with four times as many
_ROOM_AT_MOST = 64  # times the first room
_PILOTS = 16  # sources of the first batch, spread evenly
_ENTRIES = 1 << 24  # of a batch
_BLOCK = 64  # neighbouring sources that a thread takes in a row


class _Size(NamedTuple):
    """Sources of a batch, entries each thread has space for, windows that may wait."""

    n_sources: int
    capacity: int
    room: int


class _Batch(NamedTuple):
    """Balls as the threads left them; see `geodesic_rows.balls_of_sources`."""

    chosen: Indices
    deal: tuple[int, int]
    arenas: tuple[NDArray[np.int32], Floats, Floats]
    starts: Indices
    counts: Indices
    status: NDArray[np.int8]


def distance_rows(u: UnfoldedMesh, sources: Indices, room: int = 0) -> Floats:
    """(n_sources, n_vertices): distances from the sources to all vertices; inf where no path leads."""
    room = max(room, _first_room(u))
    out = np.full((len(sources), len(u.order)), np.inf)
    status = np.empty(len(sources), np.int8)
    scratch = new_balls(max(min(number_of_threads(), len(sources)), 1), len(u.order), room)
    queries = u.rank[sources], np.full(len(sources), np.inf)
    geodesic_rows.rows_of_sources(u.surface, queries, *scratch, (u.order, u.unit), out, status)
    late = np.flatnonzero(status != geodesic_rows.DONE)
    if len(late):
        _check_room(u, room, sources[late])
        out[late] = distance_rows(u, sources[late], 4 * room)
    return out


def _first_room(u: UnfoldedMesh) -> int:
    return max(_ROOM[0], _ROOM[1] * len(u.order))


def _check_room(u: UnfoldedMesh, room: int, late: Indices) -> None:
    """Refuse to go on when windows multiply beyond any use, as they may between many sheets at one edge."""
    if room > _ROOM_AT_MOST * _first_room(u):
        raise InvalidMeshError(
            f"the geodesics from vertex {late[0]} branch too often, at edges of three or more faces or in needles; "
            "remove the surplus sheets or needles, or take method='edges'."
        )


def ball_rows(
    u: UnfoldedMesh, sources: Indices, radii: Floats, *, with_directions: bool = False
) -> tuple[Indices, NDArray[np.int32], Floats, Floats]:
    """Offsets, vertices, distances and directions of the balls; directions only if asked for, else none."""
    queue = np.argsort(u.rank[sources], kind="stable")
    pilots = np.arange(0, len(queue), max(len(queue) // _PILOTS, 1))
    queue = np.concatenate([queue[pilots], np.delete(queue, pilots)])
    size, batches = _Size(len(pilots), 1 << 20, _first_room(u)), list[_Batch]()
    counts = np.zeros(len(sources), np.intp)
    while len(queue):
        chosen, queue = queue[: size.n_sources], queue[size.n_sources :]
        batch = _run(u, chosen, (u.rank[sources[chosen]], radii[chosen] / u.unit), size, with_directions)
        done = batch.status == geodesic_rows.DONE
        counts[chosen[done]] = batch.counts[done]
        queue = np.concatenate([chosen[~done], queue])
        if (batch.status == geodesic_rows.NO_ROOM).any():
            _check_room(u, size.room, sources[chosen[batch.status == geodesic_rows.NO_ROOM]])
        size = _next_size(batch, size)
        batches.append(batch)
    offsets = np.concatenate([[0], np.cumsum(counts)])
    vertices, distances = np.empty(offsets[-1], np.int32), np.empty(offsets[-1])
    directions = np.empty(offsets[-1] if with_directions else 0)
    for batch in batches:
        targets = np.where(batch.status == geodesic_rows.DONE, offsets[batch.chosen], -1)
        for arena, out in zip(batch.arenas, (vertices, distances, directions), strict=True):
            if len(out):
                geodesic_rows.gather_rows(arena, batch.deal, batch.starts, batch.counts, targets, out)
    return offsets, vertices, distances, directions


def _run(
    u: UnfoldedMesh, chosen: Indices, queries: tuple[Indices, Floats], size: _Size, with_directions: bool
) -> _Batch:
    """Compute a batch; some sources may lack space or room."""
    n, n_parts = len(chosen), number_of_threads()
    deal = max(1, min(_BLOCK, n // (4 * n_parts))), n_parts
    space = n_parts, size.capacity
    arenas = np.empty(space, np.int32), np.empty(space), np.empty(space if with_directions else (n_parts, 0))
    batch = _Batch(chosen, deal, arenas, np.zeros(n, np.intp), np.zeros(n, np.intp), np.zeros(n, np.int8))
    scratch = new_balls(n_parts, len(u.order), size.room)
    rows = batch.starts, batch.counts, batch.status
    geodesic_rows.balls_of_sources(u.surface, queries, *scratch, deal, (u.order, u.unit), arenas, rows)
    return batch


def _next_size(batch: _Batch, size: _Size) -> _Size:
    """A quarter more space than the mean of the balls computed, and never less than for two of the largest."""
    sizes, n_parts = batch.counts[batch.counts > 0], batch.deal[1]
    n_sources = int(np.clip(_ENTRIES / sizes.mean(), n_parts, _ENTRIES))
    capacity = int(1.25 * sizes.mean() * n_sources / n_parts) + 2 * int(sizes.max())
    short = bool((batch.status == geodesic_rows.NO_ROOM).any())
    return _Size(n_sources, capacity, 4 * size.room if short else size.room)
