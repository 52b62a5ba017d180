"""Passes over all points, bit by bit what NumPy's make of them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.primitive_recovery.points import (
    farthest,
    over_depth,
    second_moments,
    third_moments,
    unit_rows,
)
from shared.geometry.passes import about_mean, corners


@pytest.fixture(params=[1, 7, 5000])
def points(request: pytest.FixtureRequest, rng: np.random.Generator) -> NDArray[np.float64]:
    return np.asarray(rng.normal(size=(request.param, 3)) * [0.1, 0.03, 0.2] + [0.1, 0.0, 2.0])


def test_mean_and_box(points: NDArray[np.float64]) -> None:
    mean, centred = about_mean(points)
    np.testing.assert_array_equal(mean, points.mean(axis=0))
    np.testing.assert_array_equal(centred, points - points.mean(axis=0))
    low, high = corners(points)
    np.testing.assert_array_equal(low, points.min(axis=0))
    np.testing.assert_array_equal(high, points.max(axis=0))


def test_moments(points: NDArray[np.float64]) -> None:
    product = np.einsum("ni,nj->ij", points, points)
    np.testing.assert_array_equal(second_moments(points), product)
    cubes = np.einsum("ni,ni,ni->i", points, points, points)
    np.testing.assert_array_equal(third_moments(points), cubes)


def test_lengths_and_places(points: NDArray[np.float64]) -> None:
    lengths = np.linalg.norm(points, axis=1)
    assert farthest(points) == lengths.max()
    np.testing.assert_array_equal(unit_rows(points), points / lengths[:, None])
    places, depth = over_depth(points)
    np.testing.assert_array_equal(places, points[:, :2] / points[:, 2:])
    np.testing.assert_array_equal(depth, points[:, 2])
