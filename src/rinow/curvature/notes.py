"""What a user should know about a mesh before reading its curvature, in words."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow import tolerances
from rinow._printing import counted
from rinow.curvature.levels import levels_of
from rinow.curvature.rounding import coordinate_rounding
from rinow.mesh import IntrinsicMesh, TriangleMesh

__all__ = [
    "crack_notes",
    "crease_notes",
    "left_out_notes",
    "merge_notes",
    "mesh_notes",
    "repeat_notes",
    "sheet_notes",
    "step_notes",
    "weld_notes",
]

ROUNDED = 0.002
"""Share of the mean edge from which on the rounding of coordinates is told: its noise is one percent of K then."""

FEW_STEPS = 0.01
"""Share of the vertices up to which steps are not worth a note."""


def weld_notes(before: int, after: int) -> tuple[str, ...]:
    """What welding a soup of `before` vertices into one of `after` did."""
    if before == after:
        return ()
    return (
        f"The faces share no edge: vertices closer than {tolerances.WELD_DISTANCE:g} of the diagonal were taken as one "
        f"for the computation, {after} points for {before} vertices.",
    )


def merge_notes(n_merged: int) -> tuple[str, ...]:
    """What was done about vertices at the place of another one."""
    if not n_merged:
        return ()
    return (
        f"{counted(n_merged, 'vertex lies on another', 'vertices lie on others')}, across a seam or an edge without "
        "length: those at one place were taken as one for the computation, and have the same values.",
    )


def crack_notes(n_cracks: int) -> tuple[str, ...]:
    """What was done about cracks, the two sides of which have different vertices."""
    if not n_cracks:
        return ()
    where, done = "where vertices lie on an edge of the faces beside", "closed for the computation"
    what = counted(n_cracks, f"crack, {where}, was", f"cracks, {where}, were")
    return (f"{what} {done}: these faces were split there.",)


def sheet_notes(n_fins: int, n_meet: int) -> tuple[str, ...]:
    """What was done where more than one sheet meets, at so many vertices."""
    notes: tuple[str, ...] = ()
    if n_fins:
        where = "on an edge of two others and"
        notes += (f"{counted(n_fins, f'face stands {where} was', f'faces stand {where} were')} left out.",)
    if n_meet:
        notes += (
            f"At {counted(n_meet, 'vertex', 'vertices')} sheets of the surface meet: each was computed by itself, and "
            "the values there are those of one that goes on beyond, or of the largest (status NONMANIFOLD).",
        )
    return notes


def repeat_notes(n_repeated: int) -> tuple[str, ...]:
    """What was done about faces that are listed more than once."""
    if not n_repeated:
        return ()
    what = "the same vertices as another one, and"
    return (f"{counted(n_repeated, f'face has {what} was', f'faces have {what} were')} left out.",)


def crease_notes(on_crease: NDArray[np.bool_]) -> tuple[str, ...]:
    """What was done at vertices on creases."""
    n = int(np.count_nonzero(on_crease))
    if not n:
        return ()
    where = "where the two sides differ"
    what = counted(n, f"vertex lies on a crease, {where}: its", f"vertices lie on creases, {where}: their")
    return (
        f"{what} values are those of the side that bends most (status BOUNDARY), and none is taken across a crease.",
    )


def left_out_notes(left_out: NDArray[np.bool_] | None, n_removed: int) -> tuple[str, ...]:
    """What was done at vertices that tell nothing about the surface, also those taken out of the mesh before."""
    n = n_removed + (0 if left_out is None else int(np.count_nonzero(left_out)))
    if not n:
        return ()
    if n == 1:
        return (
            "1 vertex was left out, far beside the surface or in the middle of an edge: it has the values of "
            "its neighbours.",
        )
    return (
        f"{n} vertices were left out, single ones far beside the surface or in the middle of an edge: they have the "
        "values of their neighbours.",
    )


def step_notes(has_steps: NDArray[np.bool_] | None, n_known: int) -> tuple[str, ...]:
    """What was done about low steps, if there are more than a few among the vertices with a value."""
    n = 0 if has_steps is None else int(np.count_nonzero(has_steps))
    if n <= FEW_STEPS * n_known:
        return ()
    what = "have steps of less than a spacing or so around them, as surfaces of voxels have"
    return (f"{n} vertices {what}: these were taken for noise. If they are shape, give a radius of a few spacings.",)


def quality_notes(quality: str, method: str) -> tuple[str, ...]:
    """That a quality changes nothing."""
    return (f"quality {quality!r} changes nothing: method {method!r} has only one.",)


def mesh_notes(mesh: TriangleMesh | IntrinsicMesh, *, oriented: bool) -> tuple[str, ...]:
    """Faults of a mesh that concern its curvature; those of its orientation only if the method looks at it."""
    t = mesh.topology
    notes: list[str] = []
    n_unused = int(np.count_nonzero(~t.face_used))
    if n_unused:
        what = f"{n_unused} of {counted(mesh.n_faces, 'face', 'faces')} {'takes' if n_unused == 1 else 'take'} no part"
        notes.append(f"{what}: a repeated vertex or an undefined length.")
    if isinstance(mesh, TriangleMesh):
        notes += _rounding_notes(mesh)
        n_seam = _seam_size(mesh)
        if n_seam:
            where = "where sheets cover each other or more than two edges meet"
            notes.append(f"{n_seam} boundary vertices lie on others, {where}: they stay open.")
        if oriented:
            notes += _orientation_notes(mesh) + _level_notes(mesh)
    return tuple(notes)


def _level_notes(mesh: TriangleMesh) -> list[str]:
    """Heights that were rounded to steps."""
    levels = levels_of(mesh)
    if levels is None:
        return []
    share = levels.step / mesh.mean_edge_length
    return [f"Heights are whole multiples of a step of {share:.2f} edge lengths: it was taken for rounding, as noise."]


def _rounding_notes(mesh: TriangleMesh) -> list[str]:
    """Coordinates that are so large that their rounding is noise."""
    used = mesh.topology.face_used
    lengths = mesh.edge_lengths if used.all() else mesh.edge_lengths[used]
    share = coordinate_rounding(mesh) / float(np.mean(lengths)) if lengths.any() else 0.0
    if not ROUNDED < share < np.inf:
        return []
    return [
        f"The coordinates are rounded by up to {share:.1%} of the mean edge, which is noise of the curvature: they are "
        "far larger than the mesh; move it to the origin before its coordinates are rounded."
    ]


def _seam_size(mesh: TriangleMesh) -> int:
    """Number of boundary vertices at the same place as another one."""
    places, counts = np.unique(mesh.vertices[mesh.boundary_vertices], axis=0, return_counts=True)
    return int(counts[counts > 1].sum()) if len(places) else 0


def _orientation_notes(mesh: TriangleMesh) -> list[str]:
    """What was turned so that normals agree and point outwards, or why they cannot agree."""
    t = mesh.topology
    notes: list[str] = []
    n_turned = int(np.count_nonzero(t.face_flips))
    if n_turned:
        what = counted(n_turned, "face was turned to agree with its", "faces were turned to agree with their")
        notes.append(f"{what} neighbours.")
    if not t.is_orientable:
        notes.append("The surface has no consistent orientation: the sign of the mean curvature changes along a cut.")
    elif np.count_nonzero(mesh.outward_flips) > n_turned:
        notes.append("The faces of the closed surface pointed inwards; the normals were turned outwards.")
    return notes
