"""Distances between metric spaces.

Results
    `hausdorff`, `gromov_hausdorff`, `lipschitz`, `approximation`, `correspondence`; `collection` of many spaces.
Hausdorff distance of surfaces
    `hausdorff_surfaces` over `surface_tree`.
Exact comparison
    `steps` improve an `interval` until the `clock` stops them; the question of one level (`levels`) goes to the
    constraint `engine`, the `level_search` or a solver (`satisfiability`, proofs by `refutation`); `symmetry`.
Bounds without a search
    `bounds`, `persistence`, `subsets`.
Upper bounds
    `warm_start` with `alignment` and `relaxation`; `affine_bijections` and `large_bijections` by `assignment` for the
    Lipschitz distance.
Meshes and large spaces
    `surfaces` with `surface_points`; `large` with `large_work` and `large_subsets`.  Beyond thousands of vertices
    `whole_meshes` and `whole_eccentricities` over the rows of an `edge_metric`.
"""
