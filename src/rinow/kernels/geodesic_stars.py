"""Points around a vertex in eight directions at a geodesic radius, and their curvature by distances."""

import math

import numpy as np

from rinow.kernels._jit import kernel, parallel_kernel, prange
from rinow.kernels.robinson import robinson
from rinow.kernels.spaceform import is_triangle
from rinow.kernels.stars import star_curvature

LINES = 4
"""Lines through the centre, each with two ends: 0 to 3 and, opposite, 4 to 7."""
NEAREST, FARTHEST = 0.5, 1.3
"""Distances of ends, over the radius."""
SECTOR = 1.0 / 16.0
"""Half the angle in which the first end of a line is looked for, over a full turn."""
BEND, BEND_WEIGHT = 0.6, 44.0
"""Largest angle, in radians, between the second end and the straight continuation; what its square costs against that
of the relative error of the radius: an angle of 0.15 costs as much as the whole radius."""
ASIDE_WEIGHT = 3.0
"""What the squared angle to the middle of the sector costs for a first end."""
MISSING = 100.0
"""What an end costs that is not there: more than any other."""
TIE = 1e-12
"""Costs, angles and shares of the radius this near each other are equal: rounding of geodesic distances."""
FEWEST, WIDEST = 5, 0.45
"""A star needs so many points, and no gap of so much of the full turn."""


@kernel
def turned(angle, full):
    """An angle reduced to [-full/2, full/2)."""
    return angle - full * np.floor(angle / full + 0.5)


@kernel
def nearest_boundary(ball, begin, end, is_boundary):
    """Distance to the nearest boundary vertex of the ball; inf without one."""
    vertices, distances, _ = ball
    least = np.inf
    for j in range(begin, end):
        if is_boundary[vertices[j]]:
            least = min(least, distances[j])
    return least


@kernel
def best_end(ball, begin, end, radius, towards, full, widest, weight):
    """The entry of the ball near a distance and a direction that costs least, its cost and its angle to the left.

    Of several that cost the same, as mirror images do, it is the one farthest to the left, and of these the nearest.
    Without one they are -1, `MISSING` and 0.
    """
    _, distances, directions = ball
    best, least, left = -1, MISSING, 0.0
    for j in range(begin, end):
        off, size = turned(directions[j] - towards, full), distances[j] / radius
        if NEAREST - TIE <= size <= FARTHEST + TIE and abs(off) <= widest + TIE:
            cost = (size - 1.0) ** 2 + weight * off * off
            is_lefter = off > left + TIE or (off >= left - TIE and distances[j] < distances[best])
            if cost < least - TIE or (cost <= least + TIE and is_lefter):
                best, least, left = j, cost, off
    return best, least, left


@kernel
def write_lines(ball, begin, end, radius, first, full, entries, bends):
    """Write the ends of four lines, the first one towards `first`, and their bends; their cost, how far they are left.

    Each end that is not there costs `MISSING`.
    """
    total, leftness = 0.0, 0.0
    for k in range(LINES):
        towards = first + 0.5 * full * k / LINES
        a, cost, left = best_end(ball, begin, end, radius, towards, full, SECTOR * full, ASIDE_WEIGHT)
        entries[k], entries[k + LINES], bends[k] = a, -1, np.nan
        total, leftness = total + cost, leftness + left
        if a >= 0:
            straight = ball[2][a] + 0.5 * full
            b, cost, left = best_end(ball, begin, end, radius, straight, full, BEND, BEND_WEIGHT)
            entries[k + LINES] = b
            bends[k] = turned(ball[2][b] - straight, full) if b >= 0 else np.nan
            total, leftness = total + cost, leftness + left
        else:
            total += MISSING
    return total, leftness


@kernel
def choose_lines(ball, begin, end, radius, full, entries, bends):
    """Write the ends of four lines, the first one towards the entry nearest to the radius.

    Of several that are as near, as on a lattice, it is the one whose lines cost least, and of these the one whose ends
    are farthest to the left: the choice knows neither a numbering of the vertices nor how their distances are rounded.
    """
    _, distances, directions = ball
    nearest = np.inf
    for j in range(begin, end):
        nearest = min(nearest, abs(distances[j] / radius - 1.0))
    best, last, least, most = -1, -1, np.inf, -np.inf
    for j in range(begin, end):
        if abs(distances[j] / radius - 1.0) <= nearest + TIE:
            cost, leftness = write_lines(ball, begin, end, radius, directions[j], full, entries, bends)
            last = j
            if cost < least - TIE or (cost <= least + TIE and leftness > most + TIE):
                best, least, most = j, cost, leftness
    if best != last:
        write_lines(ball, begin, end, radius, directions[best], full, entries, bends)


@parallel_kernel
def choose_ends(ball, offsets, totals, is_boundary, share, radii, entries, bends):
    """Write the ends of four lines through each centre as entries of its ball, -1 for none, and the bends of the lines.

    A bend is the angle by which the second end is beyond the straight continuation.  The radii are cut short at the
    boundary, and to `share` of that.
    """
    for i in prange(radii.shape[0]):
        begin, end = offsets[i], offsets[i + 1]
        radii[i] = share * min(radii[i], nearest_boundary(ball, begin, end, is_boundary))
        choose_lines(ball, begin, end, radii[i], totals[i], entries[i], bends[i])


@parallel_kernel
def order_stars(ends, directions, totals, order, counts):
    """Write the columns of the different ends by direction, and their number; 0 for an open star."""
    for i in prange(ends.shape[0]):
        order[i] = 0
        n = 0
        for k in range(2 * LINES):
            place = n
            while place > 0 and directions[i, order[i, place - 1]] > directions[i, k]:
                place -= 1
            if ends[i, k] >= 0 and (place == 0 or ends[i, order[i, place - 1]] != ends[i, k]):
                for m in range(n, place, -1):
                    order[i, m] = order[i, m - 1]
                order[i, place] = k
                n += 1
        counts[i] = n if n >= FEWEST else 0
        for m in range(n):
            gap = directions[i, order[i, (m + 1) % n]] - directions[i, order[i, m]]
            if gap + (totals[i] if m == n - 1 else 0.0) > WIDEST * totals[i]:
                counts[i] = 0


@parallel_kernel
def look_up(offsets, vertices, distances, rows, targets, out):
    """Write the distance of a target in a row of balls; nan where it is not there or the row is below 0."""
    for p in prange(rows.shape[0]):
        out[p] = np.nan
        if rows[p] >= 0:
            for j in range(offsets[rows[p]], offsets[rows[p] + 1]):
                if vertices[j] == targets[p]:
                    out[p] = distances[j]


@parallel_kernel
def star_values(counts, radii, chords, out):
    """Write the embedding curvature of each star; nan for an open one."""
    for i in prange(counts.shape[0]):
        n = counts[i]
        out[i] = np.nan
        sides = np.empty((n, 3))
        is_star = n > 0
        for k in range(n):
            sides[k, 0], sides[k, 1], sides[k, 2] = chords[i, k], radii[i, k], radii[i, (k + 1) % n]
            is_star &= is_triangle(sides[k, 0], sides[k, 1], sides[k, 2])
        if is_star:
            out[i] = star_curvature(sides)


@kernel
def turned_side(b, q, side, turn):
    """Side opposite the centre of the plane triangle with the sides b, q there, after its angle grew by `turn`."""
    cosine = min(max((b * b + q * q - side * side) / (2.0 * b * q), -1.0), 1.0)
    angle = min(max(math.acos(cosine) + turn, 0.0), math.pi)
    return math.sqrt(max(b * b + q * q - 2.0 * b * q * math.cos(angle), (b - q) ** 2))


@kernel
def line_value(radii, across, bends, k, order):
    """Sum and number of the approximations by the line k and the two ends of the line across it.

    `across[e, f]` is the distance of the end e of line k % 2 from the end f of line k % 2 + 2.
    """
    first, other = k % 2, 1 - k // 2
    a, b, bend = radii[k], radii[k + LINES], bends[k]
    across_line = first + 2 * other
    total, count = 0.0, 0
    quadruple = np.empty(6)
    for f in range(2):
        q = radii[across_line + LINES * f]
        to_a = across[0, f] if k < 2 else across[f, 0]
        to_b = across[1, f] if k < 2 else across[f, 1]
        side = 1.0 if (f == 0) == (k < 2) else -1.0  # the line across leaves to the left of the first line
        straight = turned_side(b, q, to_b, -side * bend)
        quadruple[:] = a, a + b, to_a, b, q, straight
        value = robinson(quadruple, order)[0]
        if math.isfinite(value):
            total += value
            count += 1
    return total, count


@parallel_kernel
def robinson_values(radii, across, bends, order, out):
    """Write the mean of Robinson's approximations over four lines and both sides; nan without any."""
    for i in prange(out.shape[0]):
        total, count = 0.0, 0
        for k in range(LINES):
            value, n = line_value(radii[i], across[i, k % 2], bends[i], k, order)
            total += value
            count += n
        out[i] = total / count if count > 0 else np.nan
