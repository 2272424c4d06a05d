"""Upper bounds of the Gromov-Hausdorff distance of 500 points of the plane, next to those of other packages.

    python benchmarks/bench_upper_bounds.py [package ...] [--seeds N ...] [--seconds S] [--page]

Unrelated clouds, and shuffled copies with noise 0.01.  The other packages, `euclidean-hausdorff` (the Hausdorff
distance up to isometry, for coordinates) and `dgh`, take part where they are installed; their time is their own.
`dgh` needs minutes for each pair.  With `--page` each value enters docs/reference/benchmark-distances.md as soon as it
is there.
"""

from __future__ import annotations

import argparse
import importlib.util
import itertools
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from distances.report import write_page
from numpy.typing import NDArray
from scipy.spatial.distance import pdist, squareform

import rinow

Floats = NDArray[np.float64]
Bound = Callable[[Floats, Floats, float], float]


def by_rinow(P: Floats, Q: Floats, seconds: float) -> float:
    """The upper end of the interval."""
    X, Y = rinow.MetricSpace.from_points(P), rinow.MetricSpace.from_points(Q)
    return rinow.gromov_hausdorff(X, Y, time_limit=seconds).upper


def by_euclidean_hausdorff(P: Floats, Q: Floats, seconds: float) -> float:
    """Hausdorff distance after the best rigid motion that is found."""
    from euclidean_hausdorff import upper

    return float(upper(P, Q))


def by_dgh(P: Floats, Q: Floats, seconds: float) -> float:
    """Frank-Wolfe on maps, at its default settings."""
    import dgh

    return float(dgh.upper(squareform(pdist(P)), squareform(pdist(Q))))


BOUNDS: dict[str, Bound] = {"rinow": by_rinow, "euclidean-hausdorff": by_euclidean_hausdorff, "dgh": by_dgh}


def instances(seed: int) -> Iterator[tuple[str, Floats, Floats]]:
    """Unrelated clouds and noisy copies."""
    rng = np.random.default_rng(1000 + seed)
    yield "clouds", rng.random((500, 2)), rng.random((500, 2))
    points = rng.random((500, 2))
    yield "noisy copies", points, rng.permutation(points) + rng.normal(0, 0.01, points.shape)


def measure(package: str, seconds: float, seed: int, name: str, P: Floats, Q: Floats) -> dict[str, Any]:
    """Print one line; what it says."""
    start = time.perf_counter()
    value = BOUNDS[package](P, Q, seconds)
    spent = time.perf_counter() - start
    print(f"{name:13s} {seed} {package:20s} {value:.4f} {spent:6.1f} s", flush=True)
    return {"name": name, "seed": seed, "package": package, "upper": value, "seconds": round(spent, 2)}


def main() -> None:
    """Print one line for each instance and package."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("packages", nargs="*", default=list(BOUNDS))
    parser.add_argument("--seeds", type=int, nargs="+", default=list(range(5)))
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--page", action="store_true")
    options = parser.parse_args()
    packages = [name for name in options.packages if importlib.util.find_spec(name.replace("-", "_"))]
    rng = np.random.default_rng(2)
    by_rinow(rng.random((90, 2)), rng.random((90, 2)), 3.0)  # compiles
    cases = [(seed, *case) for seed in options.seeds for case in instances(seed)]
    for package, case in itertools.product(packages, cases):
        row = measure(package, options.seconds, *case)
        if options.page:
            write_page(Path(__file__).parents[1], "upper bounds", [row])


if __name__ == "__main__":
    main()
