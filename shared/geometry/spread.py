"""A few hand poses that stand for many: evenly over their groups and over space."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

_LEVER = 0.1
"""Metres: two poses are as far apart as their origins and the points this far behind them are."""


def spread(
    groups: NDArray[np.int64],
    positions: Array,
    approaches: Array,
    limit: int,
    rng: np.random.Generator,
) -> Rows:
    """Return at most `limit` rows, by rising group: from each group as many, as far as it has them.

    Within a group each row is the one farthest from those before it (Gonzalez 1985), the first
    at random.

    Parameters
    ----------
    groups : (R,) array
    positions, approaches : (R, 3) arrays
        Origins in metres and unit z axes of the poses.
    limit : int
    rng : numpy.random.Generator
    """
    features = np.hstack([positions, positions - _LEVER * approaches])
    names, sizes = np.unique(groups, return_counts=True)
    shares = _shares(sizes, limit, rng)
    chosen = [np.empty(0, dtype=np.intp)]
    for name, share in zip(names, shares, strict=True):
        rows = np.flatnonzero(groups == name)
        chosen.append(rows[_farthest(features[rows], share, rng)])
    return np.concatenate(chosen)


def _shares(sizes: NDArray[np.int64], limit: int, rng: np.random.Generator) -> list[int]:
    """Return how many each group gives: one after the other in turn, those that have some left."""
    shares = np.zeros(len(sizes), dtype=np.int64)
    turn = rng.permutation(len(sizes))
    left = min(limit, int(sizes.sum()))
    while left > 0:
        open_to = turn[shares[turn] < sizes[turn]][:left]
        shares[open_to] += 1
        left -= len(open_to)
    return [int(share) for share in shares]


def _farthest(features: Array, number: int, rng: np.random.Generator) -> Rows:
    """Return `number` rows of features (R, D), each farthest from those before it."""
    chosen = np.empty(number, dtype=np.intp)
    nearest = np.full(len(features), np.inf)
    for place in range(number):
        chosen[place] = rng.integers(len(features)) if place == 0 else np.argmax(nearest)
        away = np.linalg.norm(features - features[chosen[place]], axis=1)
        nearest = np.minimum(nearest, away)
        nearest[chosen[place]] = -1.0
    return chosen
