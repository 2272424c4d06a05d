"""Creases of a mesh: edges whose turning is there at every scale, so that the curvature across them is J/(2 r)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import read_only
from rinow.curvature.exact_facets import ends_of_facets
from rinow.curvature.levels import Levels, levels_of
from rinow.curvature.stencils import N_BLOCKS, ring_means
from rinow.curvature.voxels import is_voxel_surface
from rinow.kernels import crease_lines, creases, edge_noise, edge_numbers
from rinow.mesh import TriangleMesh

__all__ = ["CreaseLines", "EdgeTurnings", "crease_lines_of"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

NOISE_RINGS = 2
"""Averages over rings of the noise of single stars, which ten edges tell badly."""
BARRIER_ANGLE = np.radians(35.0)
"""Sections stop at an edge that turns by more than this, and by `BARRIER_NOISE` standard deviations: facets of smooth
parts rarely turn by as much, and two creases closer than a section is long must not be taken for a round."""
BARRIER_NOISE = 4.5
STRONG_ANGLE, STRONG_NOISE = np.radians(20.0), 4.5
"""Least jump of an edge that starts a line, alone and in standard deviations."""
WEAK_ANGLE, WEAK_NOISE = np.radians(12.0), 2.5
"""The same for an edge that continues a line."""
EXACT_ANGLE, EXACT_SHARE = np.radians(8.0), 0.05
"""Least jump where both sides are flat, and how exactly the jump is the turning."""
EXACT_NOISE = np.radians(1.0)
"""Noise that a mesh with such sides may have around the edge."""
CREASE_EXPONENT = -0.5
"""Curvature across a crease scales as r to the power of -1, on a smooth surface of 0; halfway is the border."""
MOST_JUMP = 2.0
"""A jump above this multiple of the turning is made by the extrapolation, not by the edge."""
LEAST_LINE, LEAST_STRONG = 4, 2
"""Edges of a line, and strong ones among them, below which it is dropped."""
LEAST_OPEN_LINE = 6
"""Edges of a chain with a free end below which it is dropped: creases close, branch, or are long."""
SHARP_ANGLE, SHARP_NOISE = np.radians(40.0), 9.0
"""Least jump of an edge that counts for two there: no noise and no round makes it."""
PARALLEL_SHARE = 0.5
"""Of three crease edges around one face, the one with less than this share of the jump of the others is dropped."""


class EdgeTurnings:
    """Turning of the normal at each edge of a mesh, and how noisy it is.

    Parameters
    ----------
    mesh : TriangleMesh
        The surface; edges with other than two proper faces have no turning.
    """

    def __init__(self, mesh: TriangleMesh) -> None:
        self.mesh = mesh
        t = mesh.topology
        self.halfedges = t.edge_halfedges
        self.normals = np.empty((mesh.n_faces, 3))
        creases.face_normals(mesh.vertices, mesh.faces, self.normals)
        self.turnings = np.empty(t.n_edges)
        creases.edge_turnings(
            mesh.vertices, mesh.faces, mesh.outward_flips, self.normals, t.partners, self.halfedges, self.turnings
        )

    @cached_property
    def edge_of_halfedge(self) -> Indices:
        """(3 n_faces,): number of the edge of each half-edge; -1 for faces that take no part."""
        return self.mesh.topology.edge_of_halfedge()

    @cached_property
    def gains(self) -> Floats:
        """(n_edges,): standard deviation of each turning for heights of deviation 1; inf without two faces."""
        mesh, gains = self.mesh, np.empty(len(self.halfedges))
        edge_noise.edge_gains(mesh.vertices, mesh.faces, mesh.topology.partners, self.halfedges, gains)
        return read_only(gains)

    @cached_property
    def are_steps(self) -> bool:
        """The edges that turn are steps of voxels, and no crease."""
        return is_voxel_surface(self.mesh, self.turnings)

    @cached_property
    def levels(self) -> Levels | None:
        """Levels that heights were rounded to, whose treads are no facets."""
        return levels_of(self.mesh)

    @property
    def have_treads(self) -> bool:
        """What is flat are steps of voxels or of levels, and no facet."""
        return self.are_steps or self.levels is not None

    @cached_property
    def ends_facet(self) -> Bools:
        """(n_edges,): a large flat facet ends there, a crease beyond doubt whose jump is the turning."""
        if self.have_treads:
            return np.zeros(len(self.turnings), np.bool_)
        return ends_of_facets(self.mesh, self.turnings, self.gains, self.halfedges)

    @cached_property
    def height_noise(self) -> Floats:
        """(n_edges,): standard deviation of the heights of the vertices around each edge, a length."""
        t, noise = self.mesh.topology, np.empty(self.mesh.n_vertices)
        edge_noise.height_noise(
            self.turnings, self.gains, self.edge_of_halfedge, t.corner_offsets, t.vertex_corners, N_BLOCKS, noise
        )
        noise = ring_means(self.mesh, noise, NOISE_RINGS)
        if self.levels is not None:
            noise = np.maximum(noise, np.sqrt(self.levels.variances(self.mesh.vertex_normals)))
        noise[t.halfedge_ends(self.halfedges[self.ends_facet])] = 0.0
        at_edges = np.empty(len(self.halfedges))
        edge_numbers.means_of_ends(noise, self.mesh.faces, self.halfedges, at_edges)  # the mesh would keep `edges`
        return read_only(at_edges)

    @cached_property
    def noise(self) -> Floats:
        """(n_edges,): standard deviation of each turning, in radians; inf where it has none."""
        noise, gains = self.height_noise, self.gains
        return read_only(np.multiply(noise, gains, out=np.full_like(gains, np.inf), where=np.isfinite(gains)))

    @cached_property
    def least_errors(self) -> Floats:
        """(n_edges,): what the noise contributes to the standard error of a jump, in radians; inf without two faces."""
        mesh, errors = self.mesh, np.empty(len(self.halfedges))
        creases.least_errors(
            mesh.vertices, mesh.faces, mesh.topology.partners, self.halfedges, self.height_noise, errors
        )
        return read_only(errors)

    def jumps(self, candidates: Indices, ends: NDArray[np.int8]) -> tuple[Floats, Floats]:
        """(n_edges,) each: the turning that neither side explains, 0 off the candidates, and its standard error."""
        mesh, jumps, errors = self.mesh, np.zeros(len(self.halfedges)), np.zeros(len(self.halfedges))
        creases.edge_jumps(
            candidates,
            mesh.vertices,
            mesh.faces,
            mesh.outward_flips,
            self.normals,
            mesh.topology.partners,
            self.halfedges,
            self.edge_of_halfedge,
            ends,
            self.height_noise,
            N_BLOCKS,
            jumps,
            errors,
        )
        jumps[self.ends_facet], errors[self.ends_facet] = self.turnings[self.ends_facet], 0.0
        return jumps, errors


@dataclass(frozen=True, slots=True, eq=False)
class CreaseLines:
    """Creases of a mesh by its edges, in the order of ``mesh.topology.edges``.

    Attributes
    ----------
    is_crease : (n_edges,) ndarray of bool
        The edge is part of a crease.
    angles : (n_edges,) ndarray of float
        Angle of the crease in radians, by which the normal jumps, convex positive; 0 elsewhere.
    errors : (n_edges,) ndarray of float
        One standard error of `angles`.
    exponents : (n_edges,) ndarray of float
        Power of r by which the curvature across the edge scales: -1 for a crease, 0 for a smooth surface.
    degrees : (n_vertices,) ndarray of intp
        Number of creases at each vertex; 3 stands for more.
    turns : (n_vertices,) ndarray of float
        Angle in radians by which a crease turns at a vertex where two edges of it meet.
    """

    is_crease: Bools
    angles: Floats
    errors: Floats
    exponents: Floats
    degrees: Indices
    turns: Floats


def crease_lines_of(turnings: EdgeTurnings) -> CreaseLines:
    """The creases of a mesh, linked to lines.

    Sections across the edges are followed twice: first up to edges that turn by much, then up to the creases found.
    Edges whose jump could not exceed its standard error enough are not followed at all, nor the steps of voxels.
    """
    mesh, theta = turnings.mesh, np.nan_to_num(turnings.turnings)
    least = np.maximum(WEAK_ANGLE, WEAK_NOISE * turnings.least_errors) / MOST_JUMP
    flat = (turnings.least_errors < EXACT_NOISE) & (np.abs(theta) > EXACT_ANGLE / MOST_JUMP)
    candidates = np.flatnonzero(((np.abs(theta) >= least) | flat) & (not turnings.are_steps))
    ends = np.where(turnings.ends_facet, creases.END, _ends_of_sections(theta, turnings.noise)).astype(np.int8)
    is_crease, jumps, errors = np.zeros(len(theta), np.bool_), theta, theta
    for _ in range(2):
        jumps, errors = turnings.jumps(candidates, ends)
        strong, weak = _evidence(theta, jumps, errors)
        is_crease = _linked(turnings, strong, weak, jumps, errors)
        certain = is_crease | turnings.ends_facet
        ends = np.where(certain, creases.END, np.minimum(ends, creases.END_STRAIGHT)).astype(np.int8)
    degrees, turns = np.empty(mesh.n_vertices, np.intp), np.empty(mesh.n_vertices)
    t = mesh.topology
    crease_lines.junctions(
        is_crease, t.edges, turnings.edge_of_halfedge, t.corner_offsets, t.vertex_corners, mesh.vertices, degrees, turns
    )
    angles = np.where(is_crease, jumps, 0.0)
    return CreaseLines(is_crease, angles, errors, _exponents(theta, jumps), degrees, turns)


def _ends_of_sections(theta: Floats, noise: Floats) -> NDArray[np.int8]:
    """What each edge does to sections before anything is known of creases."""
    turning = np.abs(theta)
    clear = turning > BARRIER_NOISE * noise
    ends = np.where(clear & (turning > STRONG_ANGLE), creases.END_STRAIGHT, creases.PASS)
    return np.where(clear & (turning > BARRIER_ANGLE), creases.END, ends).astype(np.int8)


def _exponents(theta: Floats, jumps: Floats) -> Floats:
    """The power -J/Θ of r, with Θ the turning at the smallest scale, the two faces of the edge."""
    return np.clip(-np.divide(jumps, theta, out=np.zeros_like(theta), where=theta != 0.0), -MOST_JUMP, 0.0)


def _evidence(theta: Floats, jumps: Floats, errors: Floats) -> tuple[Bools, Bools]:
    """Edges that start a line, and edges that may continue one."""
    J, exponents = np.abs(jumps), _exponents(theta, jumps)
    scales = (exponents < CREASE_EXPONENT) & (exponents > -MOST_JUMP)
    exact = (J > EXACT_ANGLE) & (errors < EXACT_NOISE) & (np.abs(jumps - theta) < EXACT_SHARE * J)
    strong = scales & (exact | ((J > STRONG_ANGLE) & (J > STRONG_NOISE * errors)))
    weak = scales & (exact | ((J > WEAK_ANGLE) & (J > WEAK_NOISE * errors)))
    return strong, weak


def _linked(turnings: EdgeTurnings, strong: Bools, weak: Bools, jumps: Floats, errors: Floats) -> Bools:
    """Lines of strong edges continued by weak ones, without whiskers, doubled edges and crumbs.

    A crease is convex or concave all along, while lines of slivers bend to and fro: long is what is so with one sign.
    """
    strength = np.abs(jumps)
    mesh, index = turnings.mesh, turnings.edge_of_halfedge
    t = mesh.topology
    rows = (index, t.corner_offsets, t.vertex_corners)
    kept = strong.copy()
    crease_lines.spread_along_lines(kept, weak, t.edges, *rows, mesh.vertices)
    doubled = np.zeros_like(kept)
    crease_lines.weakest_sides(kept, strength, index, PARALLEL_SHARE, doubled)
    kept &= ~doubled
    may_end = t.vertex_is_boundary | t.vertex_is_on_nonmanifold_edge
    weights = np.where((strength > SHARP_ANGLE) & (strength > SHARP_NOISE * errors), 2, 1)
    crease_lines.remove_short_ends(kept, weights, t.edges, may_end, *rows, LEAST_OPEN_LINE)
    sides = [kept & (jumps > 0.0), kept & (jumps < 0.0)]
    labels = [crease_lines.line_components(side, t.edges, mesh.n_vertices) for side in sides]
    lines = [_long_lines(side, label, strong, mesh.n_vertices) for side, label in zip(sides, labels, strict=True)]
    found = lines[0] | lines[1]
    on_line = np.zeros(mesh.n_vertices, np.bool_)
    on_line[t.edges[found]] = True
    for side, label in zip(sides, labels, strict=True):
        found |= _between(side, label, t.edges, on_line)
    return found


def _long_lines(kept: Bools, labels: Indices, strong: Bools, n_vertices: int) -> Bools:
    """Edges in lines of enough edges, enough of them strong."""
    sizes = np.bincount(labels[kept], minlength=n_vertices)
    starts = np.bincount(labels[kept & strong], minlength=n_vertices)
    return kept & (sizes[labels] >= LEAST_LINE) & (starts[labels] >= LEAST_STRONG)


def _between(kept: Bools, labels: Indices, edges: Indices, on_line: Bools) -> Bools:
    """Edges in lines that end on long ones, such as the three edges of a step between two corners."""
    own = np.full(len(on_line), -1, np.intp)
    own[edges[kept]] = labels[kept][:, None]
    ends = np.bincount(own[on_line & (own >= 0)], minlength=len(on_line))
    return kept & (ends[labels] >= 2)
