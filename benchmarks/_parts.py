"""Generated parts whose creases, corners, cone points and curvatures are known."""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from _sides import (
    Curvature,
    Floats,
    Indices,
    Loop,
    Map,
    Sampling,
    Side,
    all_creases,
    closed_line,
    cut_up,
    filled,
    flat,
    plane,
)  # fmt: skip

__all__ = ["Floats", "Part", "Piece", "Sampling", "lathe", "polyhedron", "prism"]

WELD_DECIMALS = 9
LEAST_DEFECT = 0.2
"""Corners of a part with less than this are no cone points."""


class Part(NamedTuple):
    """A mesh, its features by indices, and the exact curvature inside its sides, nan on creases and at cone points."""

    vertices: Floats
    faces: Indices
    creases: Indices
    corners: Indices
    cone_points: Indices
    gaussian: Floats
    mean: Floats


def welded(sides: list[Side], corners: Floats, apexes: Floats, sampling: Sampling) -> Part:
    """The part with the given sides; corners with an angle defect are cone points, like the apexes."""
    P, F, creases, mean, n = [], [], [], [], 0
    for side in sides:
        points, faces = cut_up(side) if sampling.is_coarse else filled(side, sampling)
        P.append(side.place(points))
        F.append(faces + n)
        mean.append(side.mean(P[-1]))
        start = n
        for loop in side.loops:
            k, m = np.flatnonzero(loop.is_crease), len(loop.points)
            creases.append(start + np.stack([k, (k + 1) % m], axis=1))
            start += m
        n += len(points)
    rounded = np.round(np.concatenate(P), WELD_DECIMALS) + 0.0
    V, first, index = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    index = index.ravel()
    faces, edges = index[np.concatenate(F)], np.unique(np.sort(index[np.concatenate(creases)], axis=1), axis=0)
    nearest = [np.array([np.argmin(np.linalg.norm(V - p, axis=1)) for p in ps], np.intp) for ps in (corners, apexes)]
    singular = nearest[0][np.abs(angle_defects(V, faces)[nearest[0]]) > LEAST_DEFECT]
    H = np.concatenate(mean)[first]
    H[np.concatenate([edges.ravel(), nearest[1]])] = np.nan
    K = np.where(np.isfinite(H), 0.0, np.nan)
    return Part(V, faces, edges, nearest[0], np.union1d(singular, nearest[1]), K, H)


def angle_defects(V: Floats, F: Indices) -> Floats:
    """2π less the angles at each vertex."""
    defects = np.full(len(V), 2.0 * np.pi)
    for i in range(3):
        u, v = V[F[:, i - 2]] - V[F[:, i]], V[F[:, i - 1]] - V[F[:, i]]
        np.subtract.at(defects, F[:, i], np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(axis=1)))
    return defects


def polyhedron(polygons: list[Floats], sampling: Sampling) -> Part:
    """A polyhedron by its sides, each counter-clockwise from outside."""
    sides = []
    for polygon in polygons:
        e1 = polygon[1] - polygon[0]
        e1 = e1 / np.linalg.norm(e1)
        normal = sum(np.cross(a, b) for a, b in zip(polygon, np.roll(polygon, -1, axis=0), strict=True))
        e2 = np.cross(normal / np.linalg.norm(normal), e1)
        outline = np.stack([(polygon - polygon[0]) @ e1, (polygon - polygon[0]) @ e2], axis=1)
        loop = closed_line(outline, [True] * len(polygon), sampling)
        sides.append(Side([loop], plane(polygon[0], e1, e2), flat))
    return welded(sides, np.unique(np.round(np.concatenate(polygons), 9), axis=0), np.empty((0, 3)), sampling)


class Piece(NamedTuple):
    """A piece of an outline: the line from `start` to `end`, or with a centre the arc by `angle` about it."""

    start: tuple[float, float]
    end: tuple[float, float]
    is_smooth: bool = False
    """The next piece continues without a corner."""
    centre: tuple[float, float] | None = None
    angle: float = 0.0


def sampled(piece: Piece, sampling: Sampling) -> Floats:
    """Points of a piece, with both ends."""
    start, end = np.array(piece.start), np.array(piece.end)
    if piece.centre is None:
        return np.concatenate([sampling.line(start, end), [end]])
    x, y = start - piece.centre
    t = sampling.arc(piece.angle, float(np.hypot(x, y)))
    c, s = np.cos(t), np.sin(t)
    return np.concatenate([piece.centre + np.stack([c * x - s * y, s * x + c * y], axis=1)[:-1], [end]])


def prism(outlines: list[list[Piece]], height: float, sampling: Sampling) -> Part:
    """A right prism over a region of the plane, the outer outline counter-clockwise, those of holes clockwise."""
    sides, corners = [], []
    for outline in outlines:
        for before, piece in zip([outline[-1], *outline[:-1]], outline, strict=True):
            sides.append(wall(piece, height, not before.is_smooth, not piece.is_smooth, sampling))
            if not piece.is_smooth:
                corners += [(*piece.end, 0.0), (*piece.end, height)]
    outer = [np.concatenate([sampled(p, sampling)[:-1] for p in outline]) for outline in outlines]
    top, bottom = [all_creases(p) for p in outer], [all_creases((p * (1, -1))[::-1]) for p in outer]
    sides.append(Side(top, plane((0, 0, height), (1, 0, 0), (0, 1, 0)), flat))
    sides.append(Side(bottom, plane((0, 0, 0), (1, 0, 0), (0, -1, 0)), flat))
    return welded(sides, np.reshape(corners, (-1, 3)), np.empty((0, 3)), sampling)


def ruled(low: Floats, high: Floats, ends: tuple[bool, bool], sampling: Sampling, place: Map, mean: Curvature) -> Side:
    """A side between two polylines of creases and two straight lines from the first to the first and last to last."""
    right, left = sampling.line(low[-1], high[-1]), sampling.line(high[0], low[0])
    points = np.concatenate([low[:-1], right, high[:0:-1], left])
    marks = np.repeat([True, ends[1], True, ends[0]], [len(low) - 1, len(right), len(high) - 1, len(left)])
    i, n = np.arange(len(low) - 1), len(low)
    above, before = 2 * n - 2 - i, 2 * n - 1 - i
    strip = np.concatenate([np.stack(c, axis=1) for c in ((i, i + 1, above), (i, above, before))])
    return Side([Loop(points, marks)], place, mean, coarse=strip)


def wall(piece: Piece, height: float, before: bool, after: bool, sampling: Sampling) -> Side:
    """The wall of a prism over a piece of its outline, with or without creases before and after it."""
    start, end = np.array(piece.start), np.array(piece.end)
    if piece.centre is None:
        width, radius, sign = float(np.linalg.norm(end - start)), np.inf, 1.0
        place = plane((*start, 0), (*((end - start) / width), 0), (0, 0, 1))
    else:
        x, y = start - piece.centre
        radius, sign, (cx, cy) = float(np.hypot(x, y)), np.sign(piece.angle), piece.centre
        width = radius * abs(piece.angle)

        def place(p: Floats) -> Floats:
            c, s = np.cos(sign * p[:, 0] / radius), np.sin(sign * p[:, 0] / radius)
            return np.stack([cx + c * x - s * y, cy + s * x + c * y, p[:, 1]], axis=1)

    n = len(sampled(piece, sampling))
    low = np.stack([np.linspace(0.0, width, n), np.zeros(n)], axis=1)
    mean = sign * 0.5 / radius
    return ruled(low, low + np.array((0.0, height)), (before, after), sampling, place, lambda p: np.full(len(p), mean))


def lathe(profile: list[tuple[float, float]], sampling: Sampling) -> Part:
    """A solid of revolution by (radius, height) of its corners, from the axis below to the axis above."""
    sides, apexes = [], []
    for (r, z), (s, w) in pairwise(profile):
        if z == w:
            loops = [all_creases(circle(x, sampling)) for x in (max(r, s), min(r, s)) if x > 0.0]
            sides.append(Side(loops, plane((0, 0, z), (1, 0, 0), (0, -1.0 if s > r else 1.0, 0)), flat))
        elif r == s:
            turn = 2.0 * np.pi if w > z else -2.0 * np.pi
            piece = Piece((r, 0.0), (r, 0.0), is_smooth=True, centre=(0.0, 0.0), angle=turn)
            side = wall(piece, abs(w - z), False, False, sampling)
            sides.append(side._replace(place=lifted(side.place, min(z, w))))
        else:
            sides.append(flank(r, z, s, w, sampling))
            apexes += [(0.0, 0.0, height) for radius, height in ((r, z), (s, w)) if radius == 0.0]
    return welded(sides, np.empty((0, 3)), np.reshape(apexes, (-1, 3)), sampling)


def circle(radius: float, sampling: Sampling) -> Floats:
    """Points of a circle, counter-clockwise."""
    t = sampling.arc(2.0 * np.pi, radius)[:-1]
    return radius * np.stack([np.cos(t), np.sin(t)], axis=1)


def lifted(place: Map, height: float) -> Map:
    """A map followed by a shift."""
    return lambda p: place(p) + np.array((0.0, 0.0, height))


def flank(r: float, z: float, s: float, w: float, sampling: Sampling) -> Side:
    """A cone between two circles or a circle and an apex, unrolled into a sector."""
    slant = np.hypot(s - r, w - z) / abs(s - r)
    opening, sign, most, least = 2.0 * np.pi / slant, -np.sign(s - r), max(r, s), min(r, s)

    def place(p: Floats) -> Floats:
        angle = np.arctan2(p[:, 1], p[:, 0]) % (2.0 * np.pi)
        a = sign * slant * np.where(angle > opening + 1e-6, 0.0, angle)
        radius = np.linalg.norm(p, axis=1) / slant
        height = z + (w - z) * (radius - r) / (s - r)
        return np.stack([radius * np.cos(a), radius * np.sin(a), height], axis=1)

    def mean(p: Floats) -> Floats:
        radius = np.maximum(np.hypot(p[:, 0], p[:, 1]), 1e-12)
        return 0.5 * (w - z) / (slant * abs(s - r)) / radius

    def ring(radius: float) -> Floats:
        t = sampling.arc(2.0 * np.pi, radius) / slant
        return radius * slant * np.stack([np.cos(t), np.sin(t)], axis=1)

    if least > 0.0:
        return ruled(ring(most), ring(least), (False, False), sampling, place, mean)
    rim = ring(most)
    down, back = sampling.line(np.zeros(2), rim[0]), sampling.line(rim[-1], np.zeros(2))
    points = np.concatenate([rim[:-1], back, down])
    marks = np.arange(len(points)) < len(rim) - 1
    i = np.arange(len(rim) - 1)
    fan = np.stack([i, i + 1, np.full(len(i), len(rim))], axis=1)
    t = opening * np.arange(1, 6) / 6.0
    around_apex = np.linalg.norm(down[1]) * np.stack([np.cos(t), np.sin(t)], axis=1) if len(down) > 1 else down[1:]
    return Side([Loop(points, marks)], place, mean, around_apex, fan)
