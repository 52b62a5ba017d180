"""Kernels on point sets: passes over all points at once, for which NumPy makes several."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]


@kernel
def farthest(centred: Array) -> float:
    """Return the distance of the farthest of points (N, D) from the origin."""
    most = 0.0
    for n in range(centred.shape[0]):
        squared = 0.0
        for k in range(centred.shape[1]):
            squared += centred[n, k] * centred[n, k]
        most = max(most, squared)
    return math.sqrt(most)


@kernel
def over_depth(local: Array) -> tuple[Array, Array]:
    """Return places (N, 2) in the picture and depths (N,) of points (N, 3) in a sensor's frame."""
    count = local.shape[0]
    places, depth = np.empty((count, 2)), np.empty(count)
    for n in range(count):
        depth[n] = local[n, 2]
        places[n, 0] = local[n, 0] / depth[n]
        places[n, 1] = local[n, 1] / depth[n]
    return places, depth


@kernel
def second_moments(centred: Array) -> Array:
    """Return the sums of products (D, D) of the coordinates of points (N, D)."""
    size = centred.shape[1]
    total = np.zeros((size, size))
    for n in range(centred.shape[0]):
        for i in range(size):
            for j in range(size):
                total[i, j] += centred[n, i] * centred[n, j]
    return total


@kernel
def third_moments(placed: Array) -> Array:
    """Return the sums of cubes (D,) of points (N, D) about their mean: where they reach farther."""
    total = np.zeros(placed.shape[1])
    for n in range(placed.shape[0]):
        for k in range(placed.shape[1]):
            total[k] += placed[n, k] * placed[n, k] * placed[n, k]
    return total


@kernel
def unit_rows(vectors: Array) -> Array:
    """Return vectors (N, D), none of them zero, scaled to length 1."""
    out = np.empty(vectors.shape)
    for n in range(vectors.shape[0]):
        squared = 0.0
        for k in range(vectors.shape[1]):
            squared += vectors[n, k] * vectors[n, k]
        length = np.sqrt(squared)
        for k in range(vectors.shape[1]):
            out[n, k] = vectors[n, k] / length
    return out
