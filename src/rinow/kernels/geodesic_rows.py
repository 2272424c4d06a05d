"""Geodesic balls of many sources, as rows of varying length or as full rows of distances."""

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.geodesics import N_REACHED, ball_of_row, direction, empty_ball, fill_ball, waiting_of_row

DONE, NO_ROOM, NO_SPACE = range(3)
"""Status of a source: done, too many windows waited, its part of the output is full."""


@kernel
def part_of(i, deal):
    """The part that computes source i: blocks of neighbours are dealt in turn, so that the parts stay even."""
    block, n_parts = deal
    return i // block % n_parts


@kernel
def write_ball(surface, ball, order, unit, start, output):
    """Copy a ball to the output from `start` on, in the user's numbering; directions only if there is space for any."""
    vertices, distances, directions = output
    for k in range(ball.counts[N_REACHED]):
        record = ball.reached[k + 1]
        vertices[start + k], distances[start + k] = order[record["vertex"]], unit * record["distance"]
        if directions.shape[0] > 0:
            directions[start + k] = direction(surface, ball, k + 1)


@kernel
def balls_of_part(surface, ball, waiting, queries, part, deal, numbering, output, rows):
    """Write the balls of one part of the sources to its output, one after the other, while there is space."""
    (sources, radii), (order, unit), (starts, counts, status) = queries, numbering, rows
    end, has_space = 0, True
    for i in range(sources.shape[0]):
        if part_of(i, deal) != part:
            continue
        status[i] = NO_SPACE
        if has_space:
            enough = fill_ball(surface, ball, waiting, sources[i], radii[i])
            starts[i], counts[i] = end, ball.counts[N_REACHED]
            has_space = end + counts[i] <= output[0].shape[0]
            if has_space and enough:
                write_ball(surface, ball, order, unit, end, output)
                end += counts[i]
            status[i] = NO_ROOM if not enough else DONE if has_space else NO_SPACE
            empty_ball(ball)


@parallel_kernel
def balls_of_sources(surface, queries, balls, waiting, deal, numbering, arenas, rows):
    """Write the balls of all sources; row p of the arenas and of the scratch memory belongs to part p."""
    vertices, distances, directions = arenas
    for p in prange(vertices.shape[0]):
        ball, later = ball_of_row(balls, p), waiting_of_row(waiting, p)
        output = vertices[p], distances[p], directions[p]
        balls_of_part(surface, ball, later, queries, p, deal, numbering, output, rows)


@parallel_kernel
def gather_rows(arena, deal, starts, counts, targets, out):
    """Copy the row of source i from the part that computed it to out[targets[i]:]; a target below 0 is left out."""
    for i in prange(counts.shape[0]):
        if targets[i] >= 0:
            part = part_of(i, deal)
            out[targets[i] : targets[i] + counts[i]] = arena[part, starts[i] : starts[i] + counts[i]]


@kernel
def rows_of_part(surface, ball, waiting, queries, part, n_parts, numbering, out, status):
    """Write the distances from one part of the sources to the vertices reached."""
    (sources, radii), (order, unit) = queries, numbering
    for i in range(part, sources.shape[0], n_parts):
        status[i] = DONE if fill_ball(surface, ball, waiting, sources[i], radii[i]) else NO_ROOM
        for k in range(ball.counts[N_REACHED]):
            record = ball.reached[k + 1]
            out[i, order[record["vertex"]]] = unit * record["distance"]
        empty_ball(ball)


@parallel_kernel
def rows_of_sources(surface, queries, balls, waiting, numbering, out, status):
    """Write the distances from all sources, one row each; row p of the scratch memory belongs to part p."""
    n_parts = balls.slots.shape[0]
    for p in prange(n_parts):
        ball, later = ball_of_row(balls, p), waiting_of_row(waiting, p)
        rows_of_part(surface, ball, later, queries, p, n_parts, numbering, out, status)
