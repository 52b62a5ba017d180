"""The few that stand for many: fair over groups, far apart within each."""

from __future__ import annotations

import numpy as np

from shared.geometry.spread import spread

DOWN = np.array([0.0, 0.0, -1.0])


def chosen(groups: np.ndarray, positions: np.ndarray, limit: int, seed: int = 0) -> np.ndarray:
    approaches = np.tile(DOWN, (len(groups), 1))
    return spread(groups, positions, approaches, limit, np.random.default_rng(seed))


def test_groups_give_as_many_as_they_have_and_the_rest_is_shared(rng: np.random.Generator) -> None:
    groups = rng.permutation(np.repeat([3, 5, 8], [2, 400, 100]))
    rows = chosen(groups, rng.normal(size=(len(groups), 3)), 21)
    assert len(set(rows.tolist())) == 21
    given = groups[rows]
    assert given.tolist() == sorted(given)
    assert (given == 3).sum() == 2
    assert sorted([(given == 5).sum(), (given == 8).sum()]) == [9, 10]


def test_what_there_is_is_given_whole(rng: np.random.Generator) -> None:
    groups = np.array([1, 0, 1])
    assert sorted(chosen(groups, rng.normal(size=(3, 3)), 50)) == [0, 1, 2]
    assert len(chosen(groups, rng.normal(size=(3, 3)), 0)) == 0
    assert len(chosen(np.empty(0, dtype=np.int64), np.empty((0, 3)), 5)) == 0


def test_rows_are_far_apart(rng: np.random.Generator) -> None:
    """Two crowds and a stray one: of three rows one is the stray, and each crowd has one."""
    places = np.repeat([[0.0, 0, 0], [1.0, 0, 0], [0.0, 5, 0]], [500, 500, 1], axis=0)
    places += rng.normal(scale=0.01, size=places.shape)
    for seed in range(5):
        rows = chosen(np.zeros(len(places), dtype=np.int64), places, 3, seed)
        assert [rows.min() < 500, 500 <= np.median(rows) < 1000, rows.max()] == [True, True, 1000]


def test_directions_count_beside_places() -> None:
    approaches = np.array([[0, 0, -1.0], [0, 0, -1.0], [1.0, 0, 0]])
    positions = np.array([[0, 0, 0], [0.01, 0, 0], [0, 0, 0]])
    for seed in range(5):
        groups = np.zeros(3, dtype=np.int64)
        rows = spread(groups, positions, approaches, 2, np.random.default_rng(seed))
        assert 2 in rows
