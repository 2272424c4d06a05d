"""The example that finds the radius of the Earth from distances between cities."""

import csv
import importlib.util
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
CITIES = Path(__file__).parents[1] / "golden" / "cities.csv"
RADIUS = 6371.0


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("earth_radius", EXAMPLES / "earth_radius.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def great_circle_distances():
    with CITIES.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    latitude, longitude = np.radians([[float(row["latitude"]), float(row["longitude"])] for row in rows]).T
    half = np.sin((latitude[:, None] - latitude) / 2) ** 2
    half += np.cos(latitude[:, None]) * np.cos(latitude) * np.sin((longitude[:, None] - longitude) / 2) ** 2
    return [row["city"] for row in rows], 2 * RADIUS * np.arcsin(np.sqrt(half))


def test_table_holds_great_circle_distances_rounded_to_the_km(example):
    names, D = example.read_distances(example.TABLE)
    expected_names, exact = great_circle_distances()
    assert names == expected_names
    np.testing.assert_array_equal(D, np.round(exact))


def test_prints_the_radius_with_a_standard_error_that_covers_it(example, capsys, monkeypatch):
    monkeypatch.setattr("sys.argv", ["earth_radius.py"])
    example.main()
    out = capsys.readouterr().out
    R, error = example.radius(example.read_distances(example.TABLE)[1])
    assert f"R = {R:.2f} ± {error:.2f} km" in out
    assert abs(R - RADIUS) < 2 * error
    # Rounding by up to half a km has a standard deviation of 289 m; 300 distances tell it to 4 %, and R to 30 m.
    assert "fit a sphere to 3" in out or "fit a sphere to 2" in out
    assert 0.01 < error < 0.1


def test_standard_error_is_honest(example):
    _, exact = great_circle_distances()
    rng = np.random.default_rng(7)
    scores = []
    for size in (0.3, 3.0, 30.0):  # km
        for _ in range(40):
            noise = np.triu(rng.normal(0, size, exact.shape), 1)
            R, error = example.radius(exact + noise + noise.T)
            scores.append((R - RADIUS) / error)
    # 120 standard normal numbers: 95 ± 2 % are below 2, their mean is 0 ± 0.09, their deviation 1 ± 0.065.
    assert np.mean(np.abs(scores) < 2) > 0.89
    assert abs(np.mean(scores)) < 0.3
    assert 0.8 < np.std(scores) < 1.25
