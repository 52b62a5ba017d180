"""Where something in front hides the end of a part."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.extremes import nearer_beside
from services.primitive_recovery.fitting.outline import Outline

Array = NDArray[np.float64]

STEP = 0.2
"""What is nearer by this share of the part's width hides it; what is not continues it."""
BESIDE = 2.5
"""How far from an end, in spacings of the points, something is beside it."""


def hidden_ends(
    ends: Array, viewpoint: Array, outline: Outline, others: Array | None
) -> NDArray[np.bool_]:
    """Return (K,) whether what is just beside each of a part's ends (K, 3) is in front of it."""
    if others is None or outline.frame is None:
        return np.zeros(len(ends), dtype=bool)
    own, other = ((points - viewpoint) @ outline.frame for points in (ends, others))
    other = other[other[:, 2] > 0]
    distance = float(np.median(own[:, 2]))
    nearer = nearer_beside(
        np.ascontiguousarray(own[:, :2] / own[:, 2:]),
        np.ascontiguousarray(own[:, 2]),
        np.ascontiguousarray(other[:, :2] / other[:, 2:]),
        np.ascontiguousarray(other[:, 2]),
        BESIDE * outline.spacing / distance,
    )
    return np.asarray(nearer > max(STEP * outline.width, 3 * outline.spacing))
