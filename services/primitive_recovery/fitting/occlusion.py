"""Where something in front hides the end of a part."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.extremes import nearer_beside
from services.primitive_recovery.fitting.outline import Outline
from services.primitive_recovery.points import over_depth
from shared.sorting import middle

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
    places, depth = over_depth((ends - viewpoint) @ outline.frame)
    flat, ahead = over_depth((others - viewpoint) @ outline.frame)
    beside = BESIDE * outline.spacing / middle(depth)
    nearer = nearer_beside(places, depth, flat, ahead, beside)
    return np.asarray(nearer > max(STEP * outline.width, 3 * outline.spacing))
