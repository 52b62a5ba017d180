"""Points about their mean, in their own frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.geometry.passes import about_mean

Array = NDArray[np.float64]


def own_frame(points: Array) -> Array:
    """Return points (N, 3), N >= 1, about their mean along their principal axes, of either sign."""
    _, centred = about_mean(points)
    return np.ascontiguousarray(centred @ np.linalg.eigh(centred.T @ centred)[1])
