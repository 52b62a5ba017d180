from __future__ import annotations

import numpy as np
import pytest

from services.primitive_recovery.ems.bounds import Bounds, current_bounds
from services.primitive_recovery.ems.maximization import maximize
from services.primitive_recovery.ems.state import State
from tests.services.primitive_recovery.clouds import Array, superquadric, surface_points

WIDE = Bounds.of(np.full(3, 20.0), np.full(3, 20.0))


@pytest.fixture
def points(rng: np.random.Generator) -> Array:
    return surface_points(superquadric((0.5, 0.8), (9.0, 5.0, 3.0)), 1500, rng)


def start() -> State:
    return State(np.array([1.0, 1.0, 8.0, 6.0, 4.0]), np.eye(3), np.array([0.3, -0.2, 0.1]))


def test_it_finds_a_nearby_superquadric(points: Array) -> None:
    state, cost = maximize(points, np.ones(len(points)), start(), WIDE, steps=60)
    np.testing.assert_allclose(state.shape, [0.5, 0.8, 9.0, 5.0, 3.0], rtol=0.02)
    np.testing.assert_allclose(state.position, 0.0, atol=0.02)
    assert cost < 1e-3


def test_each_step_lowers_the_cost(points: Array) -> None:
    costs = [maximize(points, np.ones(len(points)), start(), WIDE, steps=n)[1] for n in range(6)]
    assert costs == sorted(costs, reverse=True)
    assert costs[-1] < 0.2 * costs[0]


def test_points_without_weight_do_not_count(points: Array, rng: np.random.Generator) -> None:
    weights = np.concatenate([np.ones(len(points)), np.zeros(500)])
    clutter = np.vstack([points, rng.uniform(-15, 15, (500, 3))])
    alone, _ = maximize(points, np.ones(len(points)), start(), WIDE, steps=10)
    among, _ = maximize(clutter, weights, start(), WIDE, steps=10)
    np.testing.assert_allclose(among.shape, alone.shape, rtol=1e-9)


def test_bounds_hold_and_the_rest_still_moves(points: Array) -> None:
    bounds = Bounds.of(np.array([7.0, 20.0, 20.0]), np.full(3, 20.0))
    state, cost = maximize(points, np.ones(len(points)), start(), bounds, steps=40)
    assert state.shape[2] == 7.0
    assert cost < maximize(points, np.ones(len(points)), start(), bounds, steps=0)[1]
    np.testing.assert_allclose(state.shape[4], 3.0, rtol=0.1)


def test_no_weight_at_all_moves_nothing(points: Array) -> None:
    state, cost = maximize(points, np.zeros(len(points)), start(), WIDE)
    np.testing.assert_array_equal(state.shape, start().shape)
    assert cost == 0.0


def test_as_much_may_be_hidden_as_is_seen(rng: np.random.Generator) -> None:
    points = rng.uniform(-1.0, 1.0, (2000, 3)) * [10.0, 6.0, 2.0]
    state = State(np.array([1.0, 1.0, 8.0, 6.0, 4.0]), np.eye(3), np.zeros(3))
    upper = current_bounds(points, state, adaptive=False).upper[2:5]
    np.testing.assert_allclose(upper, [11.0, 11.0, 1.1 * 4.0], rtol=0.01)
    adaptive = current_bounds(points, state, adaptive=True).upper[2:5]
    np.testing.assert_allclose(adaptive, [11.0, 6.6, 2.2], rtol=0.01)
