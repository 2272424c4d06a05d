"""lower <= exact <= upper for thousands of random pairs of small spaces, whenever the search stops.

    python benchmarks/check_intervals.py [--pairs 10000] [--seed 3] [--seconds S]

The exact Gromov-Hausdorff distance comes from a search without time limit.  For each pair it is held against the bounds
without search, against searches that stop after a few looks at the clock, with a relative tolerance, against nets of
both spaces with their covering radii, and for every 50th pair against all relations of maps (spaces of up to 4 points).
Prints the number of intervals, and how many contain the exact value; exits with 1 if one does not.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import time

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import shortest_path
from scipy.spatial.distance import pdist, squareform

import rinow
from rinow.comparison import gromov_hausdorff as module
from rinow.comparison.clock import Clock

Floats = NDArray[np.float64]


class Looks(Clock):
    """A clock that is over after so many looks."""

    left_over = 0

    def __init__(self, seconds: float) -> None:
        super().__init__(seconds)

    @property
    def over(self) -> bool:
        """Whether nobody may look any more."""
        Looks.left_over -= 1
        return Looks.left_over < 0

    def part(self, seconds: float) -> Clock:
        """The same looks for a part."""
        return Looks(self.seconds)


def random_space(rng: np.random.Generator, most: int) -> Floats:
    """Points of a plane, of a line with repetitions, of a sphere, hops in a graph, or any metric with ratio 2."""
    n, kind = int(rng.integers(1, most + 1)), rng.integers(5)
    if kind == 0:
        return squareform(pdist(rng.random((n, 2)))) if n > 1 else np.zeros((1, 1))
    if kind == 1:
        places = rng.integers(0, 5, n).astype(float)
        return np.abs(places[:, None] - places)
    if kind == 2:
        edges = np.triu((rng.random((n, n)) < 0.3).astype(float), 1)
        for i in range(1, n):
            edges[rng.integers(i), i] = 1.0
        return shortest_path(edges, directed=False, unweighted=True)
    if kind == 3:
        steps = np.abs(np.subtract.outer(np.arange(n), np.arange(n)))
        return np.minimum(steps, n - steps) * (2 * np.pi / n)
    D = rng.uniform(0.5, 1.0, (n, n))
    D = np.minimum(D, D.T)
    np.fill_diagonal(D, 0.0)
    return D


def brute_force(X: Floats, Y: Floats) -> float:
    """Half the least distortion over all pairs of maps X → Y and Y → X."""
    best = np.inf
    for f in itertools.product(range(len(Y)), repeat=len(X)):
        for g in itertools.product(range(len(X)), repeat=len(Y)):
            xs, ys = [*range(len(X)), *g], [*f, *range(len(Y))]
            best = min(best, float(np.abs(X[np.ix_(xs, xs)] - Y[np.ix_(ys, ys)]).max()))
    return best / 2


def intervals(rng: np.random.Generator, X: Floats, Y: Floats) -> list[tuple[str, float, float, float]]:
    """Name, lower and upper bound, and the rounding that is allowed: none but where radii were added."""
    found: list[tuple[str, float, float, float]] = []
    result = rinow.gromov_hausdorff(X, Y, time_limit=0)
    found.append(("no time", result.lower, result.upper, 0.0))
    result = rinow.gromov_hausdorff(X, Y, rtol=0.3)
    found.append(("rtol", result.lower, result.upper, 0.0))
    for looks in (3, 10, 40):
        Looks.left_over = looks
        module.Clock = Looks  # type: ignore[misc]
        result = rinow.gromov_hausdorff(X, Y)
        module.Clock = Clock  # type: ignore[misc]
        found.append((f"{looks} looks", result.lower, result.upper, 0.0))
    nets = [rng.permutation(len(D))[: rng.integers(1, len(D) + 1)] for D in (X, Y)]
    rx, ry = (float(D[net].min(axis=0).max()) for D, net in zip((X, Y), nets, strict=True))
    A, B = (D[np.ix_(net, net)] for D, net in zip((X, Y), nets, strict=True))
    result = rinow.gromov_hausdorff(A, B, time_limit=0.05, covering_radii=(rx, ry))
    return [*found, ("nets", result.lower, result.upper, 1e-12)]


def check(pairs: int, seed: int, seconds: float) -> dict[str, list[float]]:
    """For each kind of interval how many there were, how many contain the value, and their mean width."""
    rng, table, start = np.random.default_rng(seed), dict[str, list[float]](), time.perf_counter()
    for k in range(pairs):
        if time.perf_counter() - start > seconds:
            break
        X, Y = random_space(rng, 4 if k % 50 == 0 else 9), random_space(rng, 4 if k % 50 == 0 else 9)
        exact = rinow.gromov_hausdorff(X, Y, time_limit=np.inf)
        rows = intervals(rng, X, Y)
        if k % 50 == 0:
            value = brute_force(X, Y)
            rows.append(("all maps", value, value, 0.0))
        for name, lower, upper, rounding in rows:
            slack = rounding + 1e-12 * exact.upper  # `exact` means equal to 12 digits: isometries up to rounding
            holds = lower <= exact.upper + slack and exact.lower <= upper + slack
            row = table.setdefault(name, [0, 0, 0.0])
            row[0], row[1], row[2] = row[0] + 1, row[1] + (holds and exact.exact), row[2] + upper - lower
            if not holds:
                print(f"pair {k}, {name}: [{lower!r}, {upper!r}] lacks [{exact.lower!r}, {exact.upper!r}]")
    return table


def main() -> None:
    """Check and report."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=np.inf)
    options = parser.parse_args()
    start = time.perf_counter()
    table = check(options.pairs, options.seed, options.seconds)
    for name, (count, right, width) in table.items():
        print(f"{name:10s} {count:6d} intervals, {right:6d} contain the distance, mean width {width / count:.4f}")
    print(f"{time.perf_counter() - start:.0f} s")
    sys.exit(any(count != right for count, right, _ in table.values()))


if __name__ == "__main__":
    main()
