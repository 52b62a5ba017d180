from __future__ import annotations

import numpy as np
import pytest

from services.primitive_recovery.fitting.descent import solve
from services.primitive_recovery.fitting.extremes import (
    extremes,
    frame_about,
    nearer_beside,
    nearest_spacing,
    rivals,
    smallest_rectangle,
)


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(5)


def test_extremes_and_rivals_are_those_of_the_products(rng: np.random.Generator) -> None:
    points, normals = rng.normal(size=(100, 3)), rng.normal(size=(7, 3))
    along = points @ normals.T
    high, low, end = extremes(points, normals)
    np.testing.assert_allclose(high, along.max(axis=0))
    np.testing.assert_allclose(low, along.min(axis=0))
    np.testing.assert_array_equal(end, along.argmax(axis=0))
    level = np.median(along, axis=0)
    np.testing.assert_array_equal(rivals(points, normals, level), (along > level).sum(axis=0))


def test_the_spacing_of_a_grid_with_twins(rng: np.random.Generator) -> None:
    grid = np.stack(np.meshgrid(np.arange(20.0), np.arange(15.0)), axis=-1).reshape(-1, 2)
    twice = np.ascontiguousarray(rng.permutation(np.vstack([grid, grid])))
    assert nearest_spacing(0.01 * twice, 30) == pytest.approx(0.01)
    assert nearest_spacing(np.zeros((5, 2)), 30) == 0.0


def test_the_smallest_rectangle_follows_a_turned_one(rng: np.random.Generator) -> None:
    flat = rng.uniform(-1, 1, (400, 2)) * [2.0, 1.0]
    for angle in np.radians([-40, -12, 3, 30]):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        found = smallest_rectangle(np.ascontiguousarray(flat @ turn.T), 18)
        assert np.degrees(abs(found - angle)) < 4.0


def test_what_is_beside_an_end_and_nearer() -> None:
    ends, depth = np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([2.0, 2.0])
    flat, ahead = np.array([[0.05, 0.0], [5.0, 0.0]]), np.array([1.5, 1.0])
    np.testing.assert_allclose(nearer_beside(ends, depth, flat, ahead, 0.1), [0.5, -np.inf])
    nothing = nearer_beside(ends, depth, np.empty((0, 2)), np.empty(0), 0.1)
    np.testing.assert_array_equal(nothing, [-np.inf, -np.inf])


def test_a_frame_about_an_axis(rng: np.random.Generator) -> None:
    axis = rng.normal(size=3)
    axis /= np.linalg.norm(axis)
    hint = rng.normal(size=3)
    frame = frame_about(axis, hint)
    np.testing.assert_allclose(frame.T @ frame, np.eye(3), atol=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1.0)
    np.testing.assert_allclose(frame[:, 2], axis)
    assert frame[:, 1] @ hint == pytest.approx(0.0, abs=1e-12)


def test_solving(rng: np.random.Generator) -> None:
    root = rng.normal(size=(11, 11))
    matrix, right = root @ root.T + np.eye(11), rng.normal(size=11)
    out = np.zeros(11)
    assert solve(matrix, right, np.zeros((11, 11)), out)
    np.testing.assert_allclose(out, np.linalg.solve(matrix, right), rtol=1e-8)
    assert not solve(-matrix, right, np.zeros((11, 11)), out)
