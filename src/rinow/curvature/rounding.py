"""Rounding of positions: what their digits show, and what files of 24 bits leave in meshes that were moved since."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rinow.mesh import TriangleMesh

__all__ = ["coordinate_rounding", "file_rounding"]

SINGLE, DOUBLE = 2.0**-24, 2.0**-53
"""Largest relative error of a number that is rounded to 24 bits, as most files keep them, and to 53 bits."""
PART = 1 << 14
"""Rows of coordinates that are looked at together."""
COORDINATES = 4.0
"""Errors of coordinates over their rounding at the size of the mesh that a position is off by at the most."""


def coordinate_rounding(mesh: TriangleMesh) -> float:
    """Rounding of the largest coordinate, in the unit of length: of 24 bits if all coordinates are such numbers.

    It is 0 for a mesh without any coordinate but 0.
    """
    V = mesh.vertices if mesh.vertex_is_finite.all() else mesh.vertices[mesh.vertex_is_finite]
    largest = max(float(V.max(initial=0.0)), -float(V.min(initial=0.0)))
    return largest * (SINGLE if 0.0 < largest < 1e38 and _are_single(V) else DOUBLE)


def _are_single(values: NDArray[np.float64]) -> bool:
    """Whether all are numbers of 24 bits; a part tells that they are not."""
    parts = (values[i : i + PART] for i in range(0, len(values), PART))
    return all(np.array_equal(part, part.astype(np.float32)) for part in parts)


def file_rounding(mesh: TriangleMesh) -> float:
    """Error of positions that a file of 24 bits may have left, in the unit of length, whatever digits they have now.

    A mesh that was turned or scaled after it was read still has the errors of its file, which `coordinate_rounding`
    no longer sees: flat facets are told by this one.  It is far too large to tell edges that were split from those of
    a fine mesh of a curved surface, whose turnings are as small.
    """
    return COORDINATES * SINGLE * mesh.diagonal
