"""Piecewise linear functions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]


@kernel
def value_at(x: float, knots: Array, values: Array) -> float:
    """Return `numpy.interp(x, knots, values)`, for a few knots."""
    last = len(knots) - 1
    k = 0
    while k < last and knots[k + 1] <= x:
        k += 1
    if k == last or x <= knots[0]:
        return float(values[k])
    slope = (values[k + 1] - values[k]) / (knots[k + 1] - knots[k])
    return float(values[k] + slope * (x - knots[k]))


@kernel
def interpolate(at: Array, knots: Array, values: Array) -> Array:
    """Return `value_at` each of `at` (N,)."""
    found = np.empty(len(at))
    for i in range(len(at)):
        found[i] = value_at(at[i], knots, values)
    return found
