"""Piecewise linear functions of many values."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]


@kernel
def interpolate(at: Array, knots: Array, values: Array) -> Array:
    """Return `numpy.interp(at, knots, values)`, quickly where neighbours in `at` (N,) are alike."""
    found = np.empty(len(at))
    last = len(knots) - 1
    k = 0
    for i in range(len(at)):
        x = at[i]
        while k < last and knots[k + 1] <= x:
            k += 1
        while k > 0 and knots[k] > x:
            k -= 1
        if k == last or x <= knots[0]:
            found[i] = values[k]
        else:
            slope = (values[k + 1] - values[k]) / (knots[k + 1] - knots[k])
            found[i] = values[k] + slope * (x - knots[k])
    return found
