"""Speed of Menger and Haantjes curvature of a graph beside the enumeration of all simple paths with networkx.

python benchmarks/bench_graphs.py [n_edges]
"""

from __future__ import annotations

import math
import statistics
import sys
import time

import networkx as nx
import numpy as np

import rinow

RUNS = 5


def by_enumeration(graph: nx.Graph) -> np.ndarray:
    """Menger and Haantjes curvature of every edge by the published rule, in the order of ``graph.edges``."""
    rows = []
    for u, v in graph.edges:
        lengths = [len(path) - 1 for path in nx.all_simple_paths(graph, u, v, cutoff=3)]
        rows.append((lengths.count(2) / math.sqrt(3), sum(math.sqrt(k - 1) for k in lengths)))
    return np.array(rows)


def main() -> None:
    """Compare values and times in one run."""
    n_edges = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    graphs = {
        "random": nx.gnm_random_graph(n_edges // 5, n_edges, seed=3),
        "preferential attachment": nx.barabasi_albert_graph(n_edges // 5, 5, seed=3),
    }
    for kind in ("menger", "haantjes"):
        rinow.graph_curvature(graphs["random"], kind=kind)  # compiles
    for name, graph in graphs.items():
        start = time.perf_counter()
        expected = by_enumeration(graph)
        slow = time.perf_counter() - start
        times, found = [], {}
        for _ in range(RUNS):
            start = time.perf_counter()
            found = {kind: rinow.graph_curvature(graph, kind=kind) for kind in ("menger", "haantjes")}
            times.append(time.perf_counter() - start)
        fast = statistics.median(times)
        row = {tuple(pair): e for e, pair in enumerate(found["menger"].edge_index.tolist())}
        order = [row[min(e), max(e)] for e in graph.edges]
        values = np.column_stack([found[kind].edges[order] for kind in ("menger", "haantjes")])
        print(
            f"{name:24s} {graph.number_of_edges():,} edges: networkx {slow:.2f} s, rinow {fast:.4f} s, "
            f"ratio {slow / fast:,.0f}, largest difference {np.abs(values - expected).max():.1e}"
        )


if __name__ == "__main__":
    main()
