"""Curvature at points, of curves and of surfaces.

Curves in any metric space
    `curves`, over `menger`, `haantjes`, `alt` and `polyline`.
Points of any metric space
    `wald_point` and `wald_limit`, `regular`, `polar`, `rinow`; `metric_space`; `metric_rows`, `regions`, `space_fit`.
Graphs
    `graph`, over `graph_rows` and `graph_wald`.
Surfaces
    `surface` takes a method and gives a result with a status (`status`, `notes`) for the mesh as `repairs` leave it
    (over `cracks`, `caps`, `edits`, `crossings`) and `vertex_removal` (`subdivided` over `split_edges`, `redundant`
    vertices and `outliers`, by `ear_clipping`), in `units` that are safe; each method makes an `estimate`.

    - Edge lengths alone: `angle_defect`, `wald`, `geodesic_stars`; `intrinsic` with `flow`, `waves`, `arcs`,
      `averages`, `length_noise`, `margins`, `disagreement`, `unseen`.
    - Fits: `sectional` with `sheet` and `stencils`, `centres`, `scale` with `charts` and `lack_of_fit`, `searches`,
      `second_look`, `patch_tasks`, `ends`.
    - Both: `lifted`; `auto` with `unresolved`.
    - What is not smooth: `singular` with `creases` and `cone_points`; `barriers`, `tangent_edges`, `cut`, `facets`,
      `rims`, `star_bounds`, `exact_facets`, `flat`, `hull_slivers`, `strays`; `voxels` and `terraces` of masks;
      `levels` of heights; `rounding` of positions.
Points without a mesh
    `point_cloud`, over `cloud_facing` with `cloud_signs` and `cloud_stars`, `cloud_layers`, `cloud_sheet`,
    `cloud_hands`, `cloud_faces`, `cloud_holes`, `cloud_fit`; `clouds` as metric spaces.
"""
