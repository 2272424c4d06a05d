"""Relative tolerances, each with its reason.  None is an absolute length."""

TRIANGLE_INEQUALITY = 1e-9
"""A side may exceed the sum of the two others by this share of the largest one (rounding of stored lengths)."""

METRIC_TRIANGLE_INEQUALITY = 1e-9
"""The same for a distance matrix, relative to its diameter; users may change it by `rtol`."""

SHARED_EDGE_LENGTH = 1e-9
"""Two faces may differ by this share in the length of the edge they share."""

DEGENERATE_AREA = 1e-12
"""A triangle is degenerate when its area is below this share of its longest edge squared."""

WELD_DISTANCE = 1e-5
"""Vertices closer than this share of the bounding-box diagonal are one point of a triangle soup (exact
equality leaves hundreds of open edges on CAD parts)."""

EMBEDDING = 1e-9
"""Distances of embedded points may differ from the given ones by this share of the largest distance."""

FLAT_SIMPLEX = 2e-15
"""A simplex is flat when its squared height is below this share of its longest edge squared: four times the largest
rounding error seen in 300,000 flat simplices of dimension 3 to 9."""

LINEAR_TRIPLE = 1e-13
"""A triple is linear when its excess is below this share of its shortest side, or of a hundredth of its longest one:
what rounding leaves of an equality, while an excess above it still decides about the curvature, by its square root."""

COMPARISON = 1e-12
"""Distances are compared with those of a model surface as if they were off by this share: rounding of geodesics."""

PLANAR_ANGLE = 1e-7
"""Angles at a point may miss 2π by this much in radians: rounding of the distances moves an angle near π by 2e-8."""

SEEN_ANGLE = 1e-8
"""A vertex this far in radians beside a cone of geodesics counts as seen: rounding may put a vertex exactly behind
another one outside both cones that share its ray.  The error of the distance is of second order."""

SADDLE_ANGLE = 1e-9
"""Geodesics turn at an interior vertex when its total angle exceeds 2π by this much in radians; below `SEEN_ANGLE`, so
that what a thinner shadow hides still counts as seen."""

DETOUR = 1e-12
"""A geodesic is dropped when another path is shorter by this share: above the rounding of long sums."""

EQUAL_PATHS = 1e-14
"""Paths are equally long when they differ by this share: what rounding leaves of the length of a geodesic."""

ZERO_EDGE = 1e-60
"""An edge below this share of the longest one is a point: still far from underflow when its length is squared twice."""

EXACT = 1e-12
"""Two bounds are one value when they differ by this share: rounding of the isometries that a proof used; one without
makes them equal."""

SAFE_EXPONENT = 150
"""Lengths from 2^-150 to 2^150 have sixth powers, such as squared volumes, that are numbers of full precision."""
