"""Kernels that pass over points (N, D) once.

NumPy takes ten times as long to reduce an array of points along its first axis.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]


@kernel
def about_mean(points: Array) -> tuple[Array, Array]:
    """Return the mean (D,) of points (N, D), N >= 1, and the points about it (N, D)."""
    count, size = points.shape
    mean = np.zeros(size)
    for n in range(count):
        for k in range(size):
            mean[k] += points[n, k]
    mean /= count
    centred = np.empty((count, size))
    for n in range(count):
        for k in range(size):
            centred[n, k] = points[n, k] - mean[k]
    return mean, centred


@kernel
def corners(points: Array) -> tuple[Array, Array]:
    """Return the lowest and the highest corner (D,) of the box of points (N, D), N >= 1."""
    low, high = points[0].copy(), points[0].copy()
    for n in range(points.shape[0]):
        for k in range(points.shape[1]):
            low[k] = min(low[k], points[n, k])
            high[k] = max(high[k], points[n, k])
    return low, high
