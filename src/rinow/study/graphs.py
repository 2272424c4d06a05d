"""The curvature of a graph as users want to read it: counts, percentiles, units, times."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rinow.curvature.graph import GraphCurvature, graph_curvature
from rinow.study.surface import PERCENTILES

__all__ = ["GraphStudy", "study_graph"]

Floats = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class GraphStudy:
    """Curvature of a graph with what is needed to read it.

    Attributes
    ----------
    curvature : GraphCurvature
        The values.
    labels : tuple of str
        Of the nodes.
    weighted : bool
        Whether edges have lengths other than 1.
    unit : str
        Name of the unit of length.
    seconds : float
        Wall time.
    """

    curvature: GraphCurvature
    labels: tuple[str, ...]
    weighted: bool
    unit: str
    seconds: float

    @property
    def curvature_unit(self) -> str:
        """Unit of the values."""
        return f"1/{self.unit}²" if self.curvature.kind == "wald" else f"1/{self.unit}"

    def nodes(self) -> dict[str, NDArray[Any]]:
        """Columns of a table of the nodes."""
        found = self.curvature
        columns: dict[str, NDArray[Any]] = {"label": np.array(self.labels), "curvature": found.nodes}
        return columns | ({"spread": found.spread, "radius": found.radius} if found.kind == "wald" else {})

    def edges(self) -> dict[str, NDArray[Any]]:
        """Columns of a table of the edges."""
        sources, targets = np.array(self.labels)[self.curvature.edge_index].T
        return {"source": sources, "target": targets, "curvature": self.curvature.edges}

    def counts(self) -> dict[str, int]:
        """Nodes, edges, and values that are no finite numbers."""
        found = self.curvature
        values = found.nodes if found.kind == "wald" else found.edges
        return {
            "nodes": len(found.nodes),
            "edges": len(found.edges),
            "undefined": int(np.isnan(values).sum()),
            "minus_infinity": int(np.isneginf(values).sum()),
        }

    def percentiles(self) -> dict[str, dict[str, float]]:
        """Of the finite values at nodes and edges: percentile -> value."""
        found = {"nodes": self.curvature.nodes, "edges": self.curvature.edges}
        finite = {name: values[np.isfinite(values)] for name, values in found.items()}
        return {
            name: {str(p): float(v) for p, v in zip(PERCENTILES, np.percentile(values, PERCENTILES), strict=True)}
            for name, values in finite.items()
            if len(values)
        }


def study_graph(
    lengths: Any,
    labels: tuple[str, ...],
    *,
    kind: str,
    directed: bool | None = None,
    unit: str = "length",
    progress: Callable[[int, int], object] | None = None,
) -> GraphStudy:
    """Compute the curvature of a graph and time it.

    Parameters
    ----------
    lengths : scipy sparse matrix of shape (n, n)
        The lengths of the edges.
    labels : tuple of str
        Of the nodes.
    kind : str
        As for `rinow.graph_curvature`.
    directed : bool, optional
        Whether edges lead one way.
    unit : str, optional
        Name of the unit of length.
    progress : callable, optional
        As for `rinow.graph_curvature`.

    Returns
    -------
    study : GraphStudy
        The curvature and what is needed to read it.
    """
    start = time.perf_counter()
    found = graph_curvature(lengths, kind=kind, directed=directed, progress=progress)
    return GraphStudy(found, labels, bool((lengths.data != 1.0).any()), unit, time.perf_counter() - start)
