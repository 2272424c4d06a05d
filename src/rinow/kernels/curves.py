"""The arcs that the edges of a mesh stand for."""

from rinow.kernels._jit import lean, parallel_kernel, prange


@lean
def haantjes_lift(chord, curvature):
    """Length c (1 + (kappa c)^2 / 24) of the arc of curvature kappa over a chord c, up to O(kappa^4 c^5)."""
    return chord * (1.0 + (curvature * chord) ** 2 / 24.0)


@lean
def edge_curvature(vertices, normals, i, j):
    """Turning of the normal along an edge: (n_j - n_i).(p_j - p_i)/c^2, its mean normal curvature.

    Either half is the curvature of the circle that touches the surface at one end and runs through the other.
    Normals that point to opposite sides are made to agree.
    """
    n = normals
    sign = -1.0 if n[i, 0] * n[j, 0] + n[i, 1] * n[j, 1] + n[i, 2] * n[j, 2] < 0.0 else 1.0
    turning = squared = 0.0
    for k in range(3):
        x = vertices[j, k] - vertices[i, k]
        turning += (sign * n[j, k] - n[i, k]) * x
        squared += x * x
    return turning / squared if squared > 0.0 else 0.0


@parallel_kernel
def lifted_edge_lengths(vertices, faces, normals, edge_lengths, out):
    """Write the lengths of the arcs over the sides of each face, column k opposite corner k."""
    for f in prange(faces.shape[0]):
        for k in range(3):
            i, j = faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
            out[f, k] = haantjes_lift(edge_lengths[f, k], edge_curvature(vertices, normals, i, j))


@parallel_kernel
def chord_errors(vertices, offsets, neighbours, frames, out):
    """Write the largest (k c)^2 / 12 over the edges at each vertex, k the normal curvature along a chord of length c.

    A chord is short by the share (k c)^2 / 24 of its arc, and curvature has the dimension 1/length^2: this is the
    relative error of a curvature computed from chords.
    """
    for v in prange(len(offsets) - 1):
        worst = 0.0
        for i in range(offsets[v], offsets[v + 1]):
            w = neighbours[i]
            first = second = 0.0
            for j in range(3):
                x = vertices[w, j] - vertices[v, j]
                first, second = first + x * frames.direction1[v, j], second + x * frames.direction2[v, j]
            c2 = first * first + second * second
            if c2 > 0.0:
                k = (frames.k1[v] * first * first + frames.k2[v] * second * second) / c2
                worst = max(worst, k * k * c2 / 12.0)
        out[v] = worst
