from __future__ import annotations

import numpy as np
import pytest
from sklearn.cluster import DBSCAN
from sklearn.metrics import adjusted_rand_score

from services.primitive_recovery.ems.clusters import dense_clusters
from tests.services.primitive_recovery.clouds import Array

EPS = 0.0131


def patches(rng: np.random.Generator) -> Array:
    """Return three patches 30 mm apart at a spacing of about 1 mm, and some strays."""
    blocks = [
        rng.uniform(0, 1, (count, 3)) * size + offset
        for count, size, offset in [
            (2500, [0.05, 0.05, 0.001], [0.0, 0.0, 0.8]),
            (900, [0.02, 0.05, 0.001], [0.08, 0.0, 0.8]),
            (150, [0.01, 0.01, 0.001], [0.0, 0.08, 0.82]),
        ]
    ]
    strays = rng.uniform([-0.3, -0.3, 0.1], [0.3, 0.3, 0.7], (80, 3))
    return np.vstack([*blocks, strays])


@pytest.mark.parametrize("min_points", [50, 100, 200])
def test_the_clusters_are_those_of_dbscan_on_all_points(
    min_points: int, rng: np.random.Generator
) -> None:
    points = patches(rng)
    expected = DBSCAN(eps=EPS, min_samples=min_points).fit_predict(points)
    found = dense_clusters(points, EPS, min_points)
    label = np.full(len(points), -1)
    for index, members in enumerate(found):
        label[members] = index
    assert len(found) == expected.max() + 1
    assert adjusted_rand_score(expected, label) > 0.99


def test_largest_first_and_none_smaller_than_min_points(rng: np.random.Generator) -> None:
    sizes = [len(one) for one in dense_clusters(patches(rng), EPS, 200)]
    assert sizes == sorted(sizes, reverse=True)
    assert min(sizes) >= 200


def test_a_larger_reach_joins_clusters(rng: np.random.Generator) -> None:
    assert len(dense_clusters(patches(rng), 0.05, 100)) < len(
        dense_clusters(patches(rng), EPS, 100)
    )


def test_few_points_are_no_cluster() -> None:
    assert dense_clusters(np.zeros((0, 3)), EPS, 100) == []
    assert dense_clusters(np.zeros((99, 3)), EPS, 100) == []
    assert len(dense_clusters(np.zeros((100, 3)), EPS, 100)) == 1
