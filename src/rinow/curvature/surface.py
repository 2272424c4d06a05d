"""Curvature at the vertices of a triangulated surface."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow._arrays import as_radius
from rinow._executor import Executor
from rinow._printing import OneLine
from rinow.curvature.angle_defect import angle_defect
from rinow.curvature.auto import auto
from rinow.curvature.cut import one_sided
from rinow.curvature.estimate import Estimate
from rinow.curvature.geodesic_stars import geodesic_wald, robinson
from rinow.curvature.intrinsic import intrinsic
from rinow.curvature.lifted import lifted
from rinow.curvature.notes import crease_notes, left_out_notes, mesh_notes, quality_notes, step_notes
from rinow.curvature.repairs import repair, sheets_of
from rinow.curvature.sectional import sectional
from rinow.curvature.status import VertexStatus, vertex_status
from rinow.curvature.units import with_safe_lengths
from rinow.curvature.vertex_removal import give_values, without_edge_points, without_strays
from rinow.curvature.wald import wald
from rinow.errors import InvalidInputError
from rinow.mesh import IntrinsicMesh, TriangleMesh, as_mesh, as_triangle_mesh

__all__ = ["SurfaceCurvature", "assembled", "relabelled", "rescaled", "surface_curvature"]

Floats = NDArray[np.float64]

INTRINSIC = {"angle_defect": angle_defect, "intrinsic": intrinsic, "wald": wald}
BY_POSITIONS = {"auto": auto, "sectional": sectional}
BY_LENGTHS = (*INTRINSIC, "robinson")
WITH_RADIUS = ("auto", "sectional", "intrinsic", "wald", "robinson")
METHODS = ("auto", "sectional", "lifted", "intrinsic", "wald", "robinson", "angle_defect")
QUALITIES = ("best", "fast")
NO_VALUE = (VertexStatus.ISOLATED, VertexStatus.DEGENERATE, VertexStatus.NONFINITE)
SCALARS = ("gaussian", "mean", "k1", "k2", "shape_index", "curvedness", "radius", "spread")
DIRECTIONS = ("direction1", "direction2")
QUARTILES = {"min": 0, "25 %": 25, "50 %": 50, "75 %": 75, "max": 100}
POWERS = {"gaussian": 2, "spread": 2, "mean": 1, "k1": 1, "k2": 1, "curvedness": 1, "radius": -1}
"""Power of 1/length of each field that has a unit."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SurfaceCurvature(OneLine):
    """Curvature at every vertex of a surface, in the order of its vertices; nan where undefined.

    Attributes
    ----------
    gaussian : (n_vertices,) ndarray of float
        Gaussian curvature, in 1/length².
    mean, k1, k2 : (n_vertices,) ndarray of float
        Mean and principal curvatures, in 1/length, k1 >= k2.  Convex with outward normal is positive.  K and H are
        estimated each by itself; where noise makes H² < K, k1 = k2 = H and their product is not K.
    shape_index : (n_vertices,) ndarray of float
        (2/π) atan((k1 + k2)/(k1 - k2)): 1 for a cap, 0.5 a ridge, 0 a saddle or a plane, -1 a cup.
    curvedness : (n_vertices,) ndarray of float
        √((k1² + k2²)/2), in 1/length.
    direction1, direction2 : (n_vertices, 3) ndarray of float
        Unit principal directions, orthogonal to each other; their signs mean nothing.
    status : (n_vertices,) ndarray of uint8
        Values of `VertexStatus`.  With OK, `gaussian` is finite.  Vertices on creases have BOUNDARY.
    radius : (n_vertices,) ndarray of float
        Scale the values are taken from, in units of length.
    spread : (n_vertices,) ndarray of float
        One standard error of `gaussian`, as the method can tell from the data.
    method : str
        The method used.
    notes : tuple of str
        What was found and done about the mesh, one sentence each.
    """

    gaussian: Floats
    mean: Floats
    k1: Floats
    k2: Floats
    shape_index: Floats
    curvedness: Floats
    direction1: Floats
    direction2: Floats
    status: NDArray[np.uint8]
    radius: Floats
    spread: Floats
    method: str
    notes: tuple[str, ...] = ()

    def _repr_html_(self) -> str:
        """Counts of each status and quartiles of each scalar field, as a table."""
        counts = ", ".join(f"{np.count_nonzero(self.status == s)} {s.name}" for s in VertexStatus if s in self.status)
        rows = [f"<caption>Curvature by {self.method}: {counts}</caption>", _table_row("", QUARTILES)]
        for name in SCALARS:
            finite = getattr(self, name)[np.isfinite(getattr(self, name))]
            if len(finite):
                rows.append(_table_row(name, [f"{q:.4g}" for q in np.percentile(finite, list(QUARTILES.values()))]))
        return f"<table>{''.join(rows)}</table>"


def _table_row(name: str, cells: Iterable[str]) -> str:
    return f"<tr><th>{name}</th>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>"


def surface_curvature(
    mesh: Any,
    *,
    method: str = "auto",
    quality: str = "best",
    radius: float | None = None,
    progress: Callable[[int, int], object] | None = None,
    executor: Executor | None = None,
) -> SurfaceCurvature:
    r"""Gaussian, mean and principal curvatures at the vertices of a triangulated surface.

    Parameters
    ----------
    mesh : TriangleMesh, IntrinsicMesh, (V, F) pair, or object with vertices and faces
        The surface.  Vertices may be unused or not finite, faces degenerate, misoriented or not manifold: `status`
        tells where no value is defined.  Soups are welded for the computation, seams and cracks closed, sheets that
        meet computed apart; vertices amid an edge or a face, or far beside the surface, get those of their neighbours.
    method : {"auto", "sectional", "lifted", "intrinsic", "wald", "robinson", "angle_defect"}, optional
        "sectional" fits polynomials of order 2 to 8 to the deviations from an osculating torus or a mean plane;
        "lifted" takes the angles of the star after its edges were lifted to arcs; "intrinsic" averages angle defects;
        "wald" is the embedding curvature of the star, or with `radius` of a star of geodesic distances; "robinson" is
        the mean of Robinson's formula over quadruples of geodesic distances with a linear triple; "angle_defect" is the
        defect over a third of the area.  The last four need edge lengths only and give `gaussian` only.  "auto" blends
        "sectional" and "intrinsic" at each vertex by their expected errors, and takes small rings where folds are too
        narrow for both; of a mesh without positions it is "intrinsic".  "auto", "sectional" and "intrinsic" choose
        order and scale at each place from the data.
    quality : {"best", "fast"}, optional
        "fast" lets a sample of the vertices decide about order and scale around it, with fewer patches; it is about
        twice as fast and less accurate.  With methods other than "sectional" and "auto" it changes nothing, as a note
        says.
    radius : float, optional
        Radius of all balls of "sectional" and "auto", of the averages of "intrinsic", or of the stars of "wald" and
        "robinson", positive, in the unit of length.  By default the data decide; "wald" takes the triangles around
        each vertex, "robinson" four local spacings, or less beside finer parts of the mesh.
    progress : callable, optional
        Called with the number of vertices done and their total.
    executor : Executor, optional
        Where blocks of vertices run: any pool with a `map`.  By default they run here, on the threads of numba.

    Returns
    -------
    curvature : SurfaceCurvature
        Values in the order of the vertices.

    Raises
    ------
    InvalidMeshError
        If `mesh` is none of the above, or has no positions and `method` needs them.
    InvalidInputError
        If `method` or `quality` is unknown, or `radius` is not positive or not for this method.

    See Also
    --------
    singular_features : Cone points, creases and corners, where there is no curvature.
    point_cloud_curvature : The same at points without faces.
    metric_space_curvature : At points known by their distances.

    Notes
    -----
    All values are unchanged by rotations, shifts and renumbering, up to rounding, and scale as powers of length.
    Only where a vertex is reached by several geodesics of one length, as on symmetric meshes, the order of the faces
    decides which of them "robinson", and "wald" with a radius, take.
    "auto" and "sectional" take no data from beyond a crease.  A vertex on a crease has one curvature on each side: that
    of the side that bends most is given, so that the rim of a hole in a plate has the curvature of its wall.  Flat
    facets have 0, also at corners, whose curvature as points is infinite; `singular_features` has their angles.
    Steps of surfaces of masks, of up to half a voxel, count as noise with "auto" and "sectional", as a note says.
    Lengths from 1e-150 to 1e150 neither overflow nor underflow.  Results do not depend on the number of threads.

    References
    ----------
    .. [1] E. Saucan, "Surface triangulation: the metric approach", arXiv:cs/0401023.

    Examples
    --------
    A sphere of radius 2 has Gaussian curvature 1/4 and mean curvature 1/2 everywhere:

    >>> import numpy as np
    >>> t = (1 + 5**0.5) / 2
    >>> V = np.array([(0, s, u * t) for s in (-1, 1) for u in (-1, 1)])
    >>> V = np.concatenate([np.roll(V, k, axis=1) for k in range(3)]) * 2 / (1 + t * t) ** 0.5
    >>> from scipy.spatial import ConvexHull
    >>> curvature = surface_curvature((V, ConvexHull(V).simplices))
    >>> bool(np.allclose(curvature.gaussian, 0.25) and np.allclose(curvature.mean, 0.5))
    True
    """
    surface, unit = with_safe_lengths(as_mesh(mesh))
    chosen = _chosen_method(method, quality, surface)
    if radius is not None:
        radius = _checked_radius(radius, chosen) * unit
    surface, index, notes, amid = repair(surface)
    surface, removed = (without_edge_points if chosen == "angle_defect" else without_strays)(surface, amid)
    sheets = sheets_of(surface)
    estimate, on_crease = _estimate(sheets.mesh, chosen, quality, radius, progress, executor)
    estimate, on_crease = sheets.largest(estimate, on_crease, surface.n_vertices)
    status = vertex_status(surface)
    status[on_crease & (status == VertexStatus.OK)] = VertexStatus.BOUNDARY
    give_values(estimate, status, removed)
    result = assembled(estimate, status, chosen)
    notes += mesh_notes(surface, oriented=chosen not in BY_LENGTHS) + sheets.notes + crease_notes(on_crease)
    notes += left_out_notes(estimate.left_out, len(removed))
    notes += step_notes(estimate.has_steps, int(np.count_nonzero(np.isfinite(estimate.gaussian))))
    if quality != "best" and chosen not in BY_POSITIONS:
        notes += quality_notes(quality, chosen)
    return replace(relabelled(rescaled(result, unit), index), notes=notes)


def _chosen_method(method: str, quality: str, mesh: TriangleMesh | IntrinsicMesh) -> str:
    for name, value, allowed in (("method", method, METHODS), ("quality", quality, QUALITIES)):
        if value not in allowed:
            raise InvalidInputError(f"{name} = {value!r} is unknown; choose from {', '.join(allowed)}.")
    return "intrinsic" if method == "auto" and isinstance(mesh, IntrinsicMesh) else method


def _checked_radius(radius: float, method: str) -> float:
    length = as_radius(radius)
    if method not in WITH_RADIUS:
        raise InvalidInputError(
            f"radius = {radius!r} is not for method {method!r}, which takes the star of each vertex; leave it out."
        )
    return length


def _estimate(
    mesh: TriangleMesh | IntrinsicMesh,
    method: str,
    quality: str,
    radius: float | None,
    progress: Callable[[int, int], object] | None,
    executor: Executor | None,
) -> tuple[Estimate, NDArray[np.bool_]]:
    """The estimate, and where it is that of one side of a crease."""
    if method in BY_POSITIONS:
        options: dict[str, Any] = {"quality": quality, "radius": radius, "progress": progress, "executor": executor}
        return one_sided(BY_POSITIONS[method], as_triangle_mesh(mesh), **options)
    if method == "intrinsic":
        estimate = intrinsic(mesh, radius=radius)
    elif method == "robinson":
        estimate = robinson(mesh, radius)
    elif radius is not None:
        estimate = geodesic_wald(mesh, radius)
    else:
        estimate = INTRINSIC[method](mesh) if method in INTRINSIC else lifted(as_triangle_mesh(mesh))
    if progress is not None:
        progress(mesh.n_vertices, mesh.n_vertices)
    return estimate, np.zeros(mesh.n_vertices, np.bool_)


def assembled(estimate: Estimate, status: NDArray[np.uint8], method: str) -> SurfaceCurvature:
    """The result in the unit and order of the mesh computed with."""
    finite = np.isfinite(estimate.gaussian)
    status[(status == VertexStatus.OK) & ~finite] = VertexStatus.UNRESOLVED
    undefined = ~finite | np.isin(np.arange(len(VertexStatus)), NO_VALUE)[status]
    values: dict[str, Any] = {}
    for name in (*SCALARS, *DIRECTIONS):
        value = getattr(estimate, name, None)
        if value is None:
            value = np.broadcast_to(np.nan, (len(status), 3) if name in DIRECTIONS else len(status))
        elif undefined.any():
            value[undefined] = np.nan
        values[name] = value
    if estimate.k1 is not None and estimate.k2 is not None:
        k1, k2 = estimate.k1, estimate.k2
        values["shape_index"] = 2.0 / np.pi * np.arctan2(k1 + k2, k1 - k2)
        values["curvedness"] = np.sqrt(0.5 * (k1 * k1 + k2 * k2))
    return SurfaceCurvature(**values, status=status, method=method)


def rescaled(result: SurfaceCurvature, unit: float) -> SurfaceCurvature:
    """The result for lengths divided by `unit`."""
    if unit == 1.0:
        return result
    with np.errstate(over="ignore"):
        values: dict[str, Any] = {name: getattr(result, name) * unit**power for name, power in POWERS.items()}
    return replace(result, **values)


def relabelled(result: SurfaceCurvature, index: NDArray[np.intp] | None) -> SurfaceCurvature:
    """The result with row index[v] for vertex v."""
    if index is None:
        return result
    rows: dict[str, Any] = {name: getattr(result, name)[index] for name in (*SCALARS, *DIRECTIONS, "status")}
    return replace(result, **rows)
