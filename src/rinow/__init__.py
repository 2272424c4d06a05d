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
    "ExactGeodesics": "geodesics.exact",
    "EpsilonIsometry": "comparison.approximation",
    "FileFormatError": "errors",
    "EpsilonGraph": "nets.epsilon_graph",
    "FarthestPointNet": "nets.farthest_point",
    "HausdorffDistance": "comparison.hausdorff",
    "GeodesicBalls": "geodesics.exact",
    "GromovHausdorff": "comparison.gromov_hausdorff",
    "GraphCurvature": "curvature.graph",
    "IntrinsicMesh": "mesh",
    "InvalidInputError": "errors",
    "LipschitzDistance": "comparison.lipschitz",
    "InvalidMeshError": "errors",
    "MissingDependencyError": "errors",
    "MetricSpace": "metric_space",
    "NotAMetricError": "errors",
    "RinowError": "errors",
    "RobinsonCurvature": "embedding.semidependent",
    "MetricSpaceCurvature": "curvature.metric_space",
    "RinowCurvature": "curvature.rinow",
    "RinowPointCurvature": "curvature.rinow",
    "SingularFeatures": "curvature.singular",
    "SpaceForm": "embedding.spaceform",
    "SurfaceCurvature": "curvature.surface",
    "TriangleMesh": "mesh",
    "VertexStatus": "curvature.status",
    "WaldCurvature": "curvature.wald_point",
    "angle_at": "curvature.polar",
    "polar_coordinates": "curvature.polar",
    "regular_radius": "curvature.regular",
    "rinow_curvature": "curvature.rinow",
    "rinow_point_curvature": "curvature.rinow",
    "surface_curvature": "curvature.surface",
    "wald_curvature": "curvature.wald_point",
    "read_mesh": "io.mesh_files",
    "write_mesh": "io.mesh_files",
    "alt_curvature": "curvature.alt",
    "arc_length": "curvature.haantjes",
    "curve_curvature": "curvature.curves",
    "graph_curvature": "curvature.graph",
    "metric_space_curvature": "curvature.metric_space",
    "point_cloud_curvature": "curvature.point_cloud",
    "haantjes_curvature": "curvature.haantjes",
    "menger_curvature": "curvature.menger",
    "cayley_menger_determinant": "embedding.cayley_menger",
    "circumradius": "embedding.cayley_menger",
    "is_cospherical": "embedding.cayley_menger",
    "is_euclidean_simplex": "embedding.cayley_menger",
    "simplex_volume": "embedding.cayley_menger",
    "embedding_curvatures": "embedding.quadruple",
    "fit_curvature": "embedding.point_set",
    "is_linear": "embedding.quadruple",
    "is_planar": "embedding.quadruple",
    "is_semidependent": "embedding.semidependent",
    "robinson_curvature": "embedding.semidependent",
    "semidependent_order": "embedding.semidependent",
    "singular_features": "curvature.singular",
    "star_curvature": "embedding.star",
    "hausdorff_distance": "comparison.hausdorff",
    "epsilon_graph": "nets.epsilon_graph",
    "farthest_point_net": "nets.farthest_point",
    "intrinsic_metric": "geodesics.length_space",
    "is_epsilon_net": "nets.farthest_point",
    "length_defect": "geodesics.length_space",
    "midpoints": "geodesics.length_space",
    "geodesic_distances": "geodesics.distances",
    "geodesic_space": "geodesics.distances",
    "dilatation": "comparison.lipschitz",
    "distance_matrix": "comparison.collection",
    "distortion": "comparison.correspondence",
    "find_approximation": "comparison.approximation",
    "find_epsilon_isometry": "comparison.approximation",
    "gromov_hausdorff": "comparison.gromov_hausdorff",
    "lipschitz_distance": "comparison.lipschitz",
    "uniform_distance": "comparison.correspondence",
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
