"""Sorting for compiled kernels, whose own code it may be cached with (see `shared.jit`)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]


@kernel
def ascending(values: Array) -> Array:
    """Return values (N,) in ascending order, as a copy. Shell's sort, gaps of Ciura (2001)."""
    held = values.copy()
    count = held.shape[0]
    gap = 701
    while gap > 2 * count:
        gap = int(gap / 2.25)
    while gap < count // 3:
        gap = int(2.25 * gap)
    while gap > 0:
        for end in range(gap, count):
            value, at = held[end], end
            while at >= gap and held[at - gap] > value:
                held[at] = held[at - gap]
                at -= gap
            held[at] = value
        gap = 1 if 1 < gap < 4 else int(gap / 2.25)
    return held


@kernel
def ascending_order(values: Array) -> NDArray[np.int64]:
    """Return the indices (N,) that sort a few values (N,) ascending; equal ones keep their order.

    By insertion: meant for up to some hundred values.
    """
    order = np.arange(values.shape[0])
    for end in range(1, values.shape[0]):
        index, at = order[end], end
        while at > 0 and values[order[at - 1]] > values[index]:
            order[at] = order[at - 1]
            at -= 1
        order[at] = index
    return order


@kernel
def middle(values: Array) -> float:
    """Return the median of values (N,), N >= 1."""
    held = ascending(values)
    half = held.shape[0] // 2
    if held.shape[0] % 2 == 1:
        return float(held[half])
    return 0.5 * float(held[half - 1] + held[half])
