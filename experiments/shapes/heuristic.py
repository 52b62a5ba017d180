"""The hand-made rules that the thesis compares with (Eq. A.4 to A.6)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def heuristic_classes(parameters: Array) -> NDArray[np.int64]:
    """Return the class (N,) of [e1, e2, a1, a2, a3] (N, 5): 0 cuboid, 1 cylinder, 2 sphere.

    The printed conditions leave gaps; what is neither cuboid (A.4) nor sphere
    (A.6) counts as a cylinder.
    """
    e1, e2 = parameters[:, 0], parameters[:, 1]
    sizes = parameters[:, 2:]
    square = e1 + e2 <= 0.7
    turned_square = (e1 <= 0.7) & (e2 >= 1.3) & (e2 - e1 >= 1.3)
    round_ = (np.abs(parameters[:, :2] - 1) < 0.1).all(axis=1)
    alike = sizes.max(axis=1) <= 1.3 * sizes.min(axis=1)
    return np.where(square | turned_square, 0, np.where(round_ & alike, 2, 1)).astype(np.int64)
