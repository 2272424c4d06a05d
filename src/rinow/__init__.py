"""Metric geometry of surfaces and finite metric spaces: distances in, curvature and shape distance out.

Every public name is listed here and loaded on first use.
"""

from __future__ import annotations

import importlib
from typing import Any

from rinow._version import __version__

_HOME = {
    "Approximation": "comparison.approximation",
    "ConvergenceError": "errors",
    "CurvatureFit": "embedding.point_set",
    "DistanceMatrix": "comparison.collection",
    "EmbeddingCurvatures": "embedding.quadruple",
    "EpsilonGraph": "nets.epsilon_graph",
    "EpsilonIsometry": "comparison.approximation",
    "ExactGeodesics": "geodesics.exact",
    "FarthestPointNet": "nets.farthest_point",
    "FileFormatError": "errors",
    "GeodesicBalls": "geodesics.exact",
    "GraphCurvature": "curvature.graph",
    "GromovHausdorff": "comparison.gromov_hausdorff",
    "HausdorffDistance": "comparison.hausdorff",
    "IntrinsicMesh": "mesh",
    "InvalidInputError": "errors",
    "InvalidMeshError": "errors",
    "LipschitzDistance": "comparison.lipschitz",
    "MetricSpace": "metric_space",
    "MetricSpaceCurvature": "curvature.metric_space",
    "MissingDependencyError": "errors",
    "NotAMetricError": "errors",
    "RinowCurvature": "curvature.rinow",
    "RinowError": "errors",
    "RinowPointCurvature": "curvature.rinow",
    "RobinsonCurvature": "embedding.semidependent",
    "SingularFeatures": "curvature.singular",
    "SpaceForm": "embedding.spaceform",
    "SurfaceCurvature": "curvature.surface",
    "TriangleMesh": "mesh",
    "VertexStatus": "curvature.status",
    "WaldCurvature": "curvature.wald_point",
    "alt_curvature": "curvature.alt",
    "angle_at": "curvature.polar",
    "arc_length": "curvature.haantjes",
    "cayley_menger_determinant": "embedding.cayley_menger",
    "circumradius": "embedding.cayley_menger",
    "curve_curvature": "curvature.curves",
    "dilatation": "comparison.lipschitz",
    "distance_matrix": "comparison.collection",
    "distortion": "comparison.correspondence",
    "embedding_curvatures": "embedding.quadruple",
    "epsilon_graph": "nets.epsilon_graph",
    "farthest_point_net": "nets.farthest_point",
    "find_approximation": "comparison.approximation",
    "find_epsilon_isometry": "comparison.approximation",
    "fit_curvature": "embedding.point_set",
    "geodesic_distances": "geodesics.distances",
    "geodesic_space": "geodesics.distances",
    "graph_curvature": "curvature.graph",
    "gromov_hausdorff": "comparison.gromov_hausdorff",
    "haantjes_curvature": "curvature.haantjes",
    "hausdorff_distance": "comparison.hausdorff",
    "intrinsic_metric": "geodesics.length_space",
    "is_cospherical": "embedding.cayley_menger",
    "is_epsilon_net": "nets.farthest_point",
    "is_euclidean_simplex": "embedding.cayley_menger",
    "is_linear": "embedding.quadruple",
    "is_planar": "embedding.quadruple",
    "is_semidependent": "embedding.semidependent",
    "length_defect": "geodesics.length_space",
    "lipschitz_distance": "comparison.lipschitz",
    "menger_curvature": "curvature.menger",
    "metric_space_curvature": "curvature.metric_space",
    "midpoints": "geodesics.length_space",
    "point_cloud_curvature": "curvature.point_cloud",
    "polar_coordinates": "curvature.polar",
    "read_mesh": "io.mesh_files",
    "regular_radius": "curvature.regular",
    "rinow_curvature": "curvature.rinow",
    "rinow_point_curvature": "curvature.rinow",
    "robinson_curvature": "embedding.semidependent",
    "semidependent_order": "embedding.semidependent",
    "simplex_volume": "embedding.cayley_menger",
    "singular_features": "curvature.singular",
    "star_curvature": "embedding.star",
    "surface_curvature": "curvature.surface",
    "uniform_distance": "comparison.correspondence",
    "wald_curvature": "curvature.wald_point",
    "write_mesh": "io.mesh_files",
}

__all__ = ["__version__", *sorted(_HOME)]  # pyright: ignore[reportUnsupportedDunderAll]


def __getattr__(name: str) -> Any:
    if name in _HOME:
        value = getattr(importlib.import_module(f"rinow.{_HOME[name]}"), name)
    elif name == "errors":
        value = importlib.import_module("rinow.errors")
    else:
        raise AttributeError(f"module 'rinow' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
