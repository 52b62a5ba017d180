"""Scatter of a surface around many of its points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]


@kernel
def scatter_of_groups(points: Array, near: NDArray[np.int64]) -> Array:
    """Return the scatter (N, 3, 3) of each group of points `points[near[n]]`, near (N, k)."""
    found = np.zeros((len(near), 3, 3))
    count = near.shape[1]
    mean = np.empty(3)
    for n in range(len(near)):
        mean[:] = 0.0
        for k in range(count):
            for i in range(3):
                mean[i] += points[near[n, k], i] / count
        scatter = found[n]
        for k in range(count):
            for i in range(3):
                for j in range(3):
                    scatter[i, j] += (points[near[n, k], i] - mean[i]) * (
                        points[near[n, k], j] - mean[j]
                    )
    return found


@kernel
def scatter_within(points: Array, at: Array, radius: float) -> Array:
    """Return the scatter (S, 3, 3) of the points (N, 3) within `radius` of each of `at` (S, 3)."""
    found = np.zeros((len(at), 3, 3))
    mean = np.empty(3)
    for s in range(len(at)):
        mean[:] = 0.0
        scatter = found[s]
        count = 0
        for n in range(len(points)):
            x = points[n, 0] - at[s, 0]
            y = points[n, 1] - at[s, 1]
            z = points[n, 2] - at[s, 2]
            if x * x + y * y + z * z >= radius * radius:
                continue
            count += 1
            mean[0] += x
            mean[1] += y
            mean[2] += z
            scatter[0, 0] += x * x
            scatter[0, 1] += x * y
            scatter[0, 2] += x * z
            scatter[1, 1] += y * y
            scatter[1, 2] += y * z
            scatter[2, 2] += z * z
        mean /= max(count, 1)
        for i in range(3):
            for j in range(i, 3):
                scatter[i, j] = scatter[i, j] / max(count, 1) - mean[i] * mean[j]
                scatter[j, i] = scatter[i, j]
    return found
