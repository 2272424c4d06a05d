"""The faces around each vertex in their order, and what geodesics must know of a vertex."""

import math

import numpy as np

from rinow.kernels._jit import kernel
from rinow.kernels.unfolding import dot, square

FAN = np.dtype(
    [
        ("first", np.float64),  # bearings of the two sides of the corner, counter-clockwise
        ("last", np.float64),
        ("first_length", np.float64),  # their lengths
        ("last_length", np.float64),
        ("row", np.int64),  # half-edge along the first side
    ]
)
"""A corner of a fan: the faces at a vertex, counter-clockwise."""

VERTEX = np.dtype(
    [
        ("total_angle", np.float64),
        ("clearance", np.float64),  # distance to the sides opposite the vertex
        ("fan", np.int32),  # its corners are fans[fan:fan_end]
        ("fan_end", np.int32),
        ("component_size", np.int32),  # number of vertices of its component
        ("kind", np.int32),
    ]
)
"""What geodesics must know of a vertex."""

PLAIN, SADDLE, BOUNDARY, SINGULAR = range(4)
"""Kinds of vertices: shortest paths bend at a saddle (total angle above 2π), at the boundary and at singular vertices,
where the faces form several fans or more than two of them share an edge."""


@kernel
def following(row, halfedges):
    """The half-edge that starts where `row` ends, in the same face."""
    return halfedges[halfedges[row]["previous"]]["previous"]


@kernel
def first_of_fan(row, halfedges):
    """The half-edge from the same vertex that comes first counter-clockwise; `row` itself if the fan closes."""
    r = row
    while True:
        across = halfedges[following(r, halfedges)]["left"]
        if across < 0:
            return r
        r = following(across, halfedges)
        if r == row:
            return r


@kernel
def order_fans(offsets, corners, vertex_is_manifold, angles, halfedges, fans, vertices):
    """Write the fans, the total angles and the bearings; the corners of a singular vertex keep their order."""
    n_front = offsets[-1]  # the half-edges from here on are the same ones seen from behind
    for v in range(offsets.shape[0] - 1):
        vertices[v]["fan"], vertices[v]["fan_end"] = offsets[v], offsets[v + 1]
        bearing = 0.0
        row = first_of_fan(corners[offsets[v]], halfedges) if vertex_is_manifold[v] else -1
        for i in range(offsets[v], offsets[v + 1]):
            if not vertex_is_manifold[v]:
                row, bearing = corners[i], 0.0
            last = bearing + angles[row]
            fans[i]["row"], fans[i]["first"], fans[i]["last"] = row, bearing, last
            halfedges[row]["bearing"] = bearing
            if halfedges.shape[0] > n_front:
                behind = halfedges[row]["previous"]
                behind = behind + n_front if behind < n_front else behind - n_front
                halfedges[behind]["bearing"] = -last
            row, bearing = halfedges[row]["left"], last
        vertices[v]["total_angle"] = bearing


@kernel
def distance_to_segment(start, edge):
    """Distance from the origin to the segment from `start` along `edge`."""
    length_square = square(edge)
    t = -dot(start, edge) / length_square if length_square > 0.0 else 0.0
    return math.sqrt(square(start + min(max(t, 0.0), 1.0) * edge))


@kernel
def write_clearances(halfedges, fans, vertices):
    """Write the distance from each vertex to the sides opposite it: what lies nearer needs no unfolding."""
    for v in range(vertices.shape[0]):
        least = np.inf
        for i in range(vertices[v]["fan"], vertices[v]["fan_end"]):
            length, shape = fans[i]["first_length"], halfedges[fans[i]["row"]]
            least = min(least, distance_to_segment(complex(length, 0.0), length * shape["from_end"]))
        vertices[v]["clearance"] = least
