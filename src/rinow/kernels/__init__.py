"""Compiled kernels: numbers and flat arrays only, no objects, no errors, no printing.

Policy
    `_jit` compiles, `_notice` says so on a terminal, `_parallel` shares loops out among threads.
Meshes
    `adjacency`, `edge_numbers`, `triangles`, `fans`, `stencils`, `cuts`; `edge_noise`, `creases`, `crease_lines`
    and `rounds`; `cone_points`, `facet_stars`; `records` of files.
Space forms and quadruples
    `spaceform` and `spaceform_model`, `determinants`, `point_sets`, `misfits`; `quadruples`, `embedding_curvatures`,
    `robinson`, `regularity`; `comparison` with `comparison_angles`.
Curves and graphs
    `polylines`, `curves`; `graphs`, `landmarks`; `metrics`, `midpoints`.
Fits
    `balls` over `osculating_torus`, `nested_fits` by `eliminations`, `patch_fits`, `risks`, `patches` and `bends`, all
    driven by `patch_driver`; `covers` and `patch_order` place the patches; `monge`, `quadrics`, `ring_jets`; `clouds`,
    `cloud_strays`, `cloud_layers` and `cloud_hands` without a mesh.
Averages of angle defects
    `development`, `smoothing`, `margins`, `stars`, `arcs`, `chord_forms`, `geodesic_stars`.
Geodesics
    `geodesics` over `windows`, `unfolding`, `geodesic_balls` and `heaps`; `geodesic_rows`.
Distances of surfaces
    `hausdorff` over `box_trees` and `convex_pieces`.
Relations between spaces
    `bitsets`, `compatibility`, `correspondences`, `distortion`; `correspondence_search`, `level_search`, `subset_maps`,
    `unit_propagation`; `correspondence_tabu`, `bijection_tabu`, `assignment`, `dives`, `polish`; `edge_rows`,
    `landmark_maps` and `distortion_bounds` of all vertices of meshes.
"""
