"""The smallest box around points, on points whose box is known."""

from __future__ import annotations

from itertools import product

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from experiments.framework.boxes import smallest_box


@given(st.integers(0, 2**32 - 1))
def test_the_box_around_the_corners_of_a_box_is_that_box(seed: int) -> None:
    rng = np.random.default_rng(seed)
    edges, centre = np.sort(rng.uniform(0.01, 0.3, 3)), rng.uniform(-1, 1, 3)
    rotation = Rotation.random(random_state=rng).as_matrix()
    units = np.array(list(product((-1.0, 1.0), repeat=3)))
    corners = units / 2 * edges @ rotation.T + centre
    found = smallest_box(corners)
    np.testing.assert_allclose(found.lengths, edges, atol=1e-9)
    np.testing.assert_allclose(found.centre, centre, atol=1e-9)
    np.testing.assert_allclose(np.abs(found.local(corners)), 1, atol=1e-6)
    np.testing.assert_allclose(found.axes.T @ found.axes, np.eye(3), atol=1e-9)
    assert np.linalg.det(found.axes) > 0


def test_the_box_holds_all_points_and_is_smaller_than_an_upright_one(
    rng: np.random.Generator,
) -> None:
    points = rng.normal(size=(200, 3)) @ rng.normal(size=(3, 3))
    found = smallest_box(points)
    assert found.lengths.prod() < np.ptp(points, axis=0).prod()
    assert found.lengths.prod() > ConvexHull(points).volume
    np.testing.assert_allclose(np.abs(found.local(points)).max(axis=0), 1)
