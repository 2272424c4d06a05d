"""Distances within a surface or a graph.

`distances` chooses among `exact` geodesics (over `contraction`, `unfolding` and `batches`), the `edge_graph` and the
`heat` method; `queries` are what one may ask.  `length_space` tells how far a finite space is from having midpoints.
"""
