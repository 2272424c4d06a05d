"""Hypothesis strategies for meshes and metrics."""

import numpy as np
from hypothesis import strategies as st


@st.composite
def face_lists(draw, max_vertices=8, max_faces=14):
    """Any list of triangles with three different vertices: edges and vertices of every kind of fault."""
    n = draw(st.integers(3, max_vertices))
    face = st.lists(st.integers(0, n - 1), min_size=3, max_size=3, unique=True)
    return n, np.array(draw(st.lists(face, min_size=1, max_size=max_faces)), np.intp)


@st.composite
def triangle_sides(draw):
    """Sides of a triangle that is not close to degenerate."""
    b, c = draw(st.floats(0.1, 10.0)), draw(st.floats(0.1, 10.0))
    t = draw(st.floats(0.01, 0.99))
    return abs(b - c) + t * (b + c - abs(b - c)), b, c
