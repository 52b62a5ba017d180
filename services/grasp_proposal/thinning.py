"""Fewer points, as evenly spread as before."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from shared.geometry.points import bounds
from shared.jit import kernel

Array = NDArray[np.float64]
Rows = NDArray[np.intp]

MAX_POINTS = 20_000
_WHOLE = 200
_FEW = 10
_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
"""2**64 over the golden ratio."""


def thin(points: Array, voxels: tuple[float, ...], enough: int) -> Rows:
    """Return indices of one point per voxel, in rising order.

    The first voxel size (metres) that leaves at most `enough` points is taken,
    else the last, doubled until 20,000 suffice. Clouds of up to 200 points stay whole.
    """
    first = np.arange(len(points))
    if len(points) <= _WHOLE:
        return first
    low, extents = bounds(points)
    finest = float(extents.max()) / 1e6
    doubled = (voxels[-1] * 2.0**k for k in range(1, 64))
    for step, voxel in enumerate(itertools.chain(voxels, doubled)):
        kept = _first_of_voxels(points[first], low, max(voxel, finest))
        if len(kept) < _FEW:  # all in a few voxels: still give neighbours to everyone
            return first[np.linspace(0, len(first) - 1, _WHOLE).astype(np.intp)]
        first = first[kept]
        if len(first) <= (enough if step < len(voxels) - 1 else MAX_POINTS):
            break
    return first


@kernel
def _first_of_voxels(points: Array, low: Array, voxel: float) -> Rows:
    """Return the rows, rising, of the points (N, 3) that are the first in their voxel."""
    number = np.empty(len(points), dtype=np.int64)
    spans = np.empty(3, dtype=np.int64)
    for axis in range(3):
        spans[axis] = int(np.floor((points[:, axis].max() - low[axis]) / voxel)) + 1
    for n in range(len(points)):
        x = int(np.floor((points[n, 0] - low[0]) / voxel))
        y = int(np.floor((points[n, 1] - low[1]) / voxel))
        z = int(np.floor((points[n, 2] - low[2]) / voxel))
        number[n] = (x * spans[1] + y) * spans[2] + z
    return _first_of_each(number)


@kernel
def _first_of_each(numbers: NDArray[np.int64]) -> Rows:
    """Return the rows, rising, at which numbers (N,) come for the first time.

    They are looked up in a table, half of it free, by Fibonacci hashing (Knuth, The Art of
    Computer Programming, section 6.4).
    """
    bits = 2
    while 1 << bits < 2 * len(numbers):
        bits += 1
    table = np.full(1 << bits, -1, dtype=np.intp)
    kept, count = np.empty(len(numbers), dtype=np.intp), 0
    for n in range(len(numbers)):
        slot = np.int64((np.uint64(numbers[n]) * _GOLDEN) >> np.uint64(64 - bits))
        while table[slot] >= 0 and numbers[table[slot]] != numbers[n]:
            slot = (slot + 1) & ((1 << bits) - 1)
        if table[slot] < 0:
            table[slot] = n
            kept[count] = n
            count += 1
    return kept[:count]
