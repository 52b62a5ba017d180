"""Points gathered in the voxels that they occupy."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.perception.own_frame import own_frame
from shared.geometry.passes import corners
from shared.jit import kernel

Array = NDArray[np.float64]
Labels = NDArray[np.int32]

_MAX_CELLS = 2_000_000
"""Along an axis: three of them still make a number of 63 bits."""
_MULTIPLIER = -7046029254386353131
"""2^64 over the golden ratio, odd, as a signed number (Knuth's multiplicative hashing)."""


def voxel_means(points: Array, edge: float) -> tuple[Array, Labels]:
    """Return the mean (V, 3) of the points (N, 3) in each voxel, and the voxel (N,) of each point.

    Voxels of edge `edge` (metres) are numbered as they first occur. They lie about the
    points' mean, along their principal axes: the same points share a voxel in any frame.
    """
    if len(points) == 0:
        return np.empty((0, 3)), np.empty(0, dtype=np.int32)
    points = np.ascontiguousarray(points)
    local = own_frame(points)
    low, high = corners(local)
    reach = float(np.maximum(high, -low).max())
    edge = max(edge, 2 * reach / _MAX_CELLS)
    voxel, count = _number_voxels(local, int(reach / edge) + 1, edge)
    return _means(points, voxel, count), voxel


@kernel
def _number_voxels(points: Array, offset: int, edge: float) -> tuple[Labels, int]:
    """Return the voxel (N,) of each point and how many there are, by open hashing.

    The middle one is centred on zero, so that it does not matter where an axis points;
    `offset` makes all their numbers positive.
    """
    size = 16
    while size < 2 * len(points):
        size *= 2
    mask = np.int64(size - 1)
    keys = np.full(size, -1, dtype=np.int64)
    numbers = np.empty(size, dtype=np.int32)
    voxel = np.empty(len(points), dtype=np.int32)
    cells = 1.0 / edge
    count = 0
    for i in range(len(points)):
        key = np.int64(0)
        for axis in range(3):
            cell = np.int64(np.floor(points[i, axis] * cells + 0.5)) + offset
            key = (key << 21) | cell
        place = ((key * np.int64(_MULTIPLIER)) >> 20) & mask
        while keys[place] != key and keys[place] != -1:
            place = (place + 1) & mask
        if keys[place] == -1:
            keys[place] = key
            numbers[place] = count
            count += 1
        voxel[i] = numbers[place]
    return voxel, count


@kernel
def _means(points: Array, voxel: Labels, count: int) -> Array:
    sums, number = np.zeros((count, 3)), np.zeros(count)
    for i in range(len(points)):
        number[voxel[i]] += 1.0
        for axis in range(3):
            sums[voxel[i], axis] += points[i, axis]
    for v in range(count):
        for axis in range(3):
            sums[v, axis] /= number[v]
    return sums
