"""Singular points of a surface: cone points, creases ("critical lines") and corners."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._printing import OneLine
from rinow.curvature.cone_points import LEAST_DEFECT, cone_defects
from rinow.curvature.creases import CreaseLines, EdgeTurnings, crease_lines_of
from rinow.curvature.hull_slivers import without_hull_slivers
from rinow.curvature.notes import mesh_notes
from rinow.curvature.repairs import repaired
from rinow.mesh import IntrinsicMesh, TriangleMesh, as_mesh

__all__ = ["SingularFeatures", "singular_features"]

Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

CORNER_TURN = np.radians(60.0)
"""A crease that turns by more than this from one edge to the next has a corner there; circles of six edges do not."""
BRANCHES = 3
"""Creases that meet at a corner."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SingularFeatures(OneLine):
    """Points and lines where a surface has no curvature, by vertices of its mesh, ascending.

    Attributes
    ----------
    cone_points : (n_cones,) ndarray of intp
        Vertices where curvature is concentrated at one point: apexes, and corners with a defect.
    cone_angles : (n_cones,) ndarray of float
        Total angle around each, in radians: below 2π where the curvature is positive.
    crease_edges : (n_creases, 2) ndarray of intp
        Edges of creases, each with its smaller vertex first.
    crease_angles : (n_creases,) ndarray of float
        Angle by which the normal jumps across each, in radians, convex positive, between -π and π.
    crease_errors : (n_creases,) ndarray of float
        One standard error of `crease_angles`.
    crease_exponents : (n_creases,) ndarray of float
        Power of r by which the sectional curvature across each edge scales: -1 for a crease, 0 for a smooth surface.
    corners : (n_corners,) ndarray of intp
        Vertices where three or more creases meet, or one turns sharply.
    notes : tuple of str
        What was found and done about the mesh, one sentence each.
    """

    cone_points: Indices
    cone_angles: Floats
    crease_edges: Indices
    crease_angles: Floats
    crease_errors: Floats
    crease_exponents: Floats
    corners: Indices
    notes: tuple[str, ...] = ()

    def _repr_html_(self) -> str:
        """Counts and ranges, as a table."""
        rows = [
            ("cone points", len(self.cone_points), self.cone_angles),
            ("crease edges", len(self.crease_edges), self.crease_angles),
            ("corners", len(self.corners), np.empty(0)),
        ]
        cells = "".join(
            f"<tr><th>{name}</th><td>{n}</td><td>{_range_in_degrees(angles)}</td></tr>" for name, n, angles in rows
        )
        return f"<table><tr><th></th><th>number</th><th>angles</th></tr>{cells}</table>"


def _range_in_degrees(angles: Floats) -> str:
    return f"{np.degrees(angles.min()):.4g}° … {np.degrees(angles.max()):.4g}°" if len(angles) else ""


def singular_features(mesh: Any) -> SingularFeatures:
    r"""Cone points, creases and corners of a triangulated surface.

    A point is singular when the curvature grows without bound as the scale r shrinks: as r⁻² at a cone point, as
    r⁻¹ across a crease, while it stays where the surface is smooth.

    Parameters
    ----------
    mesh : TriangleMesh, IntrinsicMesh, (V, F) pair, or object with vertices and faces
        The surface.  Edge lengths alone tell the cone points; creases and corners need positions.  A soup of
        separate triangles is welded for the computation, seams and cracks are closed, and each face counts once;
        features are named by the first vertex at each place.

    Returns
    -------
    features : SingularFeatures
        Empty arrays where there is nothing of a kind.

    Raises
    ------
    InvalidMeshError
        If `mesh` is none of the above.

    See Also
    --------
    surface_curvature : Curvature where it is defined.

    Notes
    -----
    *Creases.*  A straight section runs from each edge to both sides, up to the next crease, or, while creases are not
    known, up to a turn of 20° after three faces that hardly turn.  On each side the normal is taken as a linear
    function of the distance; the jump J between the two values at the edge is the angle of the crease.  The turning
    over the distance r to both sides is Θ(r) = J + c r, the curvature of the section Θ/(2 r), and its exponent
    d log κ / d log r = -J/Θ; below -½ the edge is a candidate.  It starts a line when J exceeds 20°
    and 4.5 standard errors, and continues one above 12° and 2.5; the errors come from the sections' deviation from
    their lines, their lengths, and the noise of the vertices' heights, which edges that turn to and fro tell.
    Between flat sides, where J has an error below 1° and is the turning at the edge itself to a twentieth, 8° are
    enough.  Where a facet of eight faces or more that is flat to rounding ends at 60° or more, and not with a step,
    there is a crease whatever the noise around.  Lines of fewer than four edges, and open ends of fewer than six that
    do not end at a boundary or another crease, are dropped; edges of 40° and nine standard errors count for two there.

    *Cone points.*  The defect of a disc of two rings, less the mean curvature density of the next two rings times
    its area, must exceed 0.08 rad and 12 standard deviations of the defects around, and most of it must lie at the
    vertex itself: a rounded tip has it spread over several.  Rings stop at creases.  At a corner it is the defect.

    Creases below these angles, features smaller than two edges, and facets of 35° or more in a smooth round (there
    the mesh does not say whether it is a prism or a cylinder) are beyond the method.  Edges with one face, or more
    than two, are never creases, nor are those of triangles that lie along the boundary with an angle above 140°: such
    ones Delaunay's triangulation of scattered points has over the dents of its hull.

    References
    ----------
    .. [1] E. Saucan, "Surface triangulation: the metric approach", arXiv:cs/0401023, Section 1 (critical points
           and lines).

    Examples
    --------
    A cube has twelve creases of 90° and eight corners with three right angles:

    >>> import numpy as np
    >>> V = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    >>> F = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1),
    ...      (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    >>> features = singular_features((V, F))
    >>> len(features.crease_edges), len(features.corners), len(features.cone_points)
    (12, 8, 8)
    >>> np.degrees(features.crease_angles[0]).round(9), np.degrees(features.cone_angles[0]).round(9)
    (np.float64(90.0), np.float64(270.0))
    """
    surface = _in_safe_unit(as_mesh(mesh))
    surface, index, notes = repaired(surface)
    names = np.arange(surface.n_vertices) if index is None else np.unique(index, return_index=True)[1]
    notes += mesh_notes(surface, oriented=isinstance(surface, TriangleMesh))
    if isinstance(surface, TriangleMesh):
        surface = without_hull_slivers(surface)
    t = surface.topology
    closed = t.vertex_is_boundary | ~t.vertex_is_manifold
    if isinstance(surface, IntrinsicMesh):
        points, defects = cone_defects(surface, closed)
        return _features(names, points, defects, np.empty((0, 2), np.intp), np.empty((3, 0)), points[:0], notes)
    lines = crease_lines_of(EdgeTurnings(surface))
    corners = np.flatnonzero((lines.degrees >= BRANCHES) | (lines.turns > CORNER_TURN))
    points, defects = _all_cone_points(surface, lines, corners, closed)
    values = np.stack([lines.angles, lines.errors, lines.exponents])[:, lines.is_crease]
    return _features(names, points, defects, t.edges[lines.is_crease], values, corners, notes)


def _in_safe_unit(mesh: TriangleMesh | IntrinsicMesh) -> TriangleMesh | IntrinsicMesh:
    """The mesh in a unit in which no product of lengths overflows or underflows; angles do not depend on it."""
    longest = float(np.fmax.reduce(mesh.edge_lengths, axis=None))
    if not longest > 0.0 or 2.0**-100 < longest < 2.0**100:
        return mesh
    exponent = -int(np.frexp(longest)[1])
    if isinstance(mesh, IntrinsicMesh):
        return IntrinsicMesh(mesh.faces, np.ldexp(mesh.edge_lengths, exponent), mesh.n_vertices)
    with np.errstate(over="ignore"):
        return TriangleMesh(np.ldexp(mesh.vertices, exponent), mesh.faces)


def _all_cone_points(mesh: TriangleMesh, lines: CreaseLines, corners: Indices, closed: Bools) -> tuple[Indices, Floats]:
    """Cone points off the creases, and corners with a defect; ascending."""
    apexes, apex_defects = cone_defects(mesh, closed | (lines.degrees >= 2))
    own = mesh.vertex_angle_defects[corners]
    singular = (np.abs(own) > LEAST_DEFECT) & ~closed[corners] & ~np.isin(corners, apexes)
    points = np.concatenate([apexes, corners[singular]])
    order = np.argsort(points)
    return points[order], np.concatenate([apex_defects, own[singular]])[order]


def _features(
    names: Indices,
    points: Indices,
    defects: Floats,
    edges: Indices,
    values: Floats,
    corners: Indices,
    notes: tuple[str, ...],
) -> SingularFeatures:
    """The result with the vertices named as in the given mesh, all rows ascending."""
    edges = np.sort(names[edges], axis=1)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    angles, errors, exponents = values[:, order]
    cones = np.argsort(names[points])
    return SingularFeatures(
        names[points][cones], 2.0 * np.pi - defects[cones], edges[order], angles, errors, exponents,
        np.sort(names[corners]), notes,
    )  # fmt: skip
