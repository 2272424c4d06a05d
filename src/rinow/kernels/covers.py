"""Centres that cover a surface, chosen so that the choice is local and knows neither axes nor numbering."""

import math

import numpy as np

from rinow.kernels import stencils
from rinow.kernels._jit import kernel, lean, parallel_kernel, prange

QUANTA = 2.0**26
"""Steps in a shape ratio of 1: far above rounding, so that motions change no key, and below chance coincidence."""


@lean
def mixed(x):
    """A hash of a 64-bit number (the finaliser of splitmix64)."""
    x = np.uint64(x)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


@parallel_kernel
def shape_keys(vertices, offsets, neighbours, out):
    """Write a hash of the shape of each star: equal for congruent and similar stars, else as good as random."""
    for v in prange(len(offsets) - 1):
        total = squares = 0.0
        for i in range(offsets[v], offsets[v + 1]):
            d2 = stencils.squared_distance(vertices, v, neighbours[i])
            squares += d2
            total += math.sqrt(d2)
        ratio = squares / (total * total) if total > 0.0 else 0.0
        out[v] = np.uint32(mixed(np.uint64(ratio * QUANTA + 0.37)) >> np.uint64(32))


@lean
def disc(v, radius, epoch, vertices, offsets, neighbours, marks, members):
    """Write the vertices within a distance of v, reached over such vertices, to members (n + 1,); how many.

    Which neighbours are new, and which of them near, is as good as random: no branch depends on it.
    """
    members[0] = v
    marks[v] = epoch
    far, first, last = radius * radius, 0, 1
    while first < last:
        n = last
        for m in range(first, last):
            for i in range(offsets[members[m]], offsets[members[m] + 1]):
                q = neighbours[i]
                members[n] = q
                n += marks[q] != epoch
                marks[q] = epoch
        first, kept = last, last
        for m in range(first, n):
            q = members[m]
            members[kept] = q
            kept += stencils.squared_distance(vertices, v, q) < far
        last = kept
    return last


@kernel
def next_uncovered(candidates, first, most, is_covered, found):
    """Write the next candidates that no disc covers, about so many; how many, and the place of the one after them.

    A negative number ~v is that of a vertex v tied with the one before; candidates that are tied stay together.
    """
    count, is_tied = 0, False
    while first < len(candidates) and (count < most or candidates[first] < 0):
        c = candidates[first]
        is_tied &= c < 0
        if not is_covered[max(c, ~c)]:
            found[count] = ~max(c, ~c) if is_tied else max(c, ~c)
            count, is_tied = count + 1, True
        first += 1
    return count, first


@parallel_kernel
def small_discs(candidates, radii, sheet, counts, members):
    """Write the disc of each candidate to a row of members (n, room), as far as there is room, and its size.

    A disc with more than room for it has a negative size.
    """
    vertices, offsets, neighbours, room = sheet.vertices, sheet.offsets, sheet.neighbours, members.shape[1]
    for i in prange(len(candidates)):
        own, v = members[i], max(candidates[i], ~candidates[i])
        own[0] = v
        far, first, last = radii[v] * radii[v], 0, 1
        while first < last:
            p, first = own[first], first + 1
            for q in neighbours[offsets[p] : offsets[p + 1]]:
                if last < 0 or not stencils.squared_distance(vertices, v, q) < far:
                    continue
                k = 0
                while k < last and own[k] != q:
                    k += 1
                if k == last:
                    if last < room:
                        own[last] = q
                    last = last + 1 if last < room else -1
        counts[i] = last


@kernel
def settle(candidates, counts, members, radii, sheet, marks, room, epoch, is_covered):
    """Move the candidates in the disc of none before those that they are tied with to the front; how many.

    All their discs are covered then.  Those that had no room are grown again, with marks (n,) and room (n + 1,).
    """
    surface, count, first = (sheet.vertices, sheet.offsets, sheet.neighbours), 0, 0
    kept = np.empty(len(candidates), np.intp)
    for i in range(len(candidates)):
        v = max(candidates[i], ~candidates[i])
        if not is_covered[v]:
            candidates[count], kept[count] = v, i
            count += 1
        if i + 1 == len(candidates) or candidates[i + 1] >= 0:
            for k in range(first, count):
                own, size = members[kept[k]], counts[kept[k]]
                if size < 0:
                    v = candidates[k]
                    own, size = room, disc(v, radii[v], epoch + k, *surface, marks, room)
                for m in range(size):
                    is_covered[own[m]] = True
            first = count
    return count


@parallel_kernel
def link(places, sources, radii, starts, sheet, counts, links):
    """Write the number of targets in the disc of each source, and their numbers to links[starts[i] : starts[i + 1]].

    places[v] is the number of the target at vertex v, or -1.
    """
    marks, members = np.zeros(len(sheet.vertices), np.int32), np.empty(len(sheet.vertices) + 1, np.int32)
    surface = (sheet.vertices, sheet.offsets, sheet.neighbours)
    for i in prange(len(sources)):
        m, k, room = disc(sources[i], radii[i], i + 1, *surface, marks, members), 0, starts[i + 1] - starts[i]
        for j in range(m):
            target = places[members[j]]
            if target >= 0:
                if k < room:
                    links[starts[i] + k] = target
                k += 1
        counts[i] = k


@lean
def steps_between(sample, vertex, rung):
    """Steps of the ladder by which a radius in spacings of a sample is farther up in spacings of a vertex."""
    return math.floor(math.log(sample / vertex) / rung + 0.5)


@parallel_kernel
def windows(starts, samples, radius, order, noise, spacing, at_samples, rung, n_radii, low, high, top, sigma2):
    """Write the range of radii and the highest order of the samples near each vertex, and the noise between them."""
    for v in prange(len(starts) - 1):
        low[v], high[v], top[v] = 127, -1, 0  # no sample
        total, count = 0.0, 0
        for i in range(starts[v], starts[v + 1]):
            s = samples[i]
            if radius[s] < 0:
                continue
            same = min(max(radius[s] + steps_between(at_samples[s], spacing[v], rung[v]), 0), n_radii - 1)
            low[v], high[v] = min(low[v], same, radius[s]), max(high[v], same, radius[s])
            top[v] = max(top[v], order[s])
            total += math.log(max(noise[s], 1e-300))
            count += 1
        sigma2[v] = math.exp(total / count) if count else 0.0


@lean
def sum_logs(rows, logs, shifts, totals, counts):
    """Write the sums of those rows of logs (m, k) that have a value in a column, and how many there are.

    Columns of the i-th row are moved up by shifts[i].
    """
    totals[:], counts[:] = 0.0, 0.0
    n = len(totals)
    for i in range(len(rows)):
        up = max(min(shifts[i], n), -n)
        below, above = max(up, 0), min(n + up, n)
        own, total, count = logs[rows[i], below - up : above - up], totals[below:above], counts[below:above]
        for c in range(above - below):
            is_known = not math.isnan(own[c])
            total[c] += own[c] if is_known else 0.0
            count[c] += 1.0 if is_known else 0.0


@parallel_kernel
def choices(vertices, starts, samples, logs, spacing, at_samples, rung, n_orders, n_blocks, radius, order, risk):
    """Write the radius and order of the least mean logarithmic risk among the samples near each vertex; -1 without.

    Column j n_orders + d of the logs belongs to the radius j and the order d + 2.
    """
    n = len(vertices)
    for block in prange(n_blocks):
        totals, counts, shifts = np.empty(logs.shape[1]), np.empty(logs.shape[1]), np.empty(len(logs), np.int64)
        for i in range(n * block // n_blocks, n * (block + 1) // n_blocks):
            near = samples[starts[vertices[i]] : starts[vertices[i] + 1]]
            for k in range(len(near)):
                shifts[k] = n_orders * steps_between(at_samples[near[k]], spacing[vertices[i]], rung[vertices[i]])
            sum_logs(near, logs, shifts, totals, counts)
            best = np.inf
            radius[i], order[i], risk[i] = -1, 0, np.inf
            for c in range(logs.shape[1]):
                missing, mean = len(near) - counts[c], totals[c] / max(counts[c], 1.0)
                if counts[c] > missing and mean + missing < best:
                    best = mean + missing
                    radius[i], order[i], risk[i] = c // n_orders, c % n_orders + 2, math.exp(mean)
