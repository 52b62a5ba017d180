"""Sorting for compiled kernels, whose own code it may be cached with (see `shared.jit`)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]

_SHORT = 16
"""Values that insertion sorts faster."""


@kernel
def ascending(values: Array) -> Array:
    """Return values (N,) in ascending order, as a copy.

    Quicksort by Hoare's partition (1961) down to short stretches, then insertion.
    """
    held = values.copy()
    waiting = np.empty((64, 2), dtype=np.int64)  # the longer part waits: no more than log2 N
    waiting[0] = 0, held.shape[0] - 1
    count = 1
    while count > 0:
        count -= 1
        first, last = waiting[count]
        while last - first > _SHORT:
            i, j = _partitioned(held, first, last)
            if j - first < last - i:
                waiting[count] = i, last
                last = j
            else:
                waiting[count] = first, j
                first = i
            count += 1
    for end in range(1, held.shape[0]):
        value, at = held[end], end
        while at > 0 and held[at - 1] > value:
            held[at] = held[at - 1]
            at -= 1
        held[at] = value
    return held


@kernel
def _partitioned(held: Array, first: int, last: int) -> tuple[int, int]:
    """Move the lesser values of a stretch of `held` (N,) to its start, in place.

    Returns
    -------
    i, j : int
        What is from `first` to j is no greater than what is from i to `last`, j < i.
    """
    # The median of three: sorted stretches, either way, are common.
    one, two, three = held[first], held[(first + last) // 2], held[last]
    pivot = max(min(one, two), min(max(one, two), three))
    i, j = first, last
    while i <= j:
        while held[i] < pivot:
            i += 1
        while pivot < held[j]:
            j -= 1
        if i <= j:
            held[i], held[j] = held[j], held[i]
            i += 1
            j -= 1
    return i, j


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
    held = values.copy()
    half = held.shape[0] // 2
    upper = selected(held, half)
    if held.shape[0] % 2 == 1:
        return upper
    return 0.5 * (float(held[:half].max()) + upper)


@kernel
def selected(held: Array, rank: int) -> float:
    """Return the value of a rank, from 0, among `held` (N,); in place, the lesser go before it.

    Hoare's selection (1961).
    """
    first, last = 0, held.shape[0] - 1
    while first < last:
        i, j = _partitioned(held, first, last)
        if rank <= j:
            last = j
        elif rank >= i:
            first = i
        else:
            break
    return float(held[rank])


@kernel
def trimmed_range(values: Array, skipped: int) -> tuple[float, float]:
    """Return the lowest and the highest of values (N,) but for a few, N > `skipped`, at either end.

    Keeps those beyond in order by insertion: meant for few of many.
    """
    low, high = np.full(skipped + 1, np.inf), np.full(skipped + 1, -np.inf)
    for value in values:
        if value < low[skipped]:
            at = skipped
            while at > 0 and low[at - 1] > value:
                low[at] = low[at - 1]
                at -= 1
            low[at] = value
        if value > high[skipped]:
            at = skipped
            while at > 0 and high[at - 1] < value:
                high[at] = high[at - 1]
                at -= 1
            high[at] = value
    return low[skipped], high[skipped]
