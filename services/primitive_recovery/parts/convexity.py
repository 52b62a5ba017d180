"""Whether a cloud that was seen from all sides is the surface of a convex body."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull, QhullError

Array = NDArray[np.float64]

NEAR_HULL = 2.0
"""A point is on the hull if it lies at most so many point spacings within it."""
ON_HULL = 0.98
"""So many of the points of a convex body are; the rest is allowed to noise."""


def is_convex(points: Array, spacing: float) -> bool:
    """Say whether nearly all points (N, 3) lie on their own convex hull.

    Only of a cloud that shows all sides does it follow that the body is convex: what
    one view shows of a bottle's front has no hollow that could be seen either.

    Parameters
    ----------
    points : (N, 3) array
        Metres.
    spacing : float
        About how far neighbouring points are apart, metres.
    """
    try:
        facets = ConvexHull(points).equations
    except QhullError:
        return False
    inside = -(points @ facets[:, :3].T + facets[:, 3]).max(axis=1)
    return bool(np.mean(inside <= NEAR_HULL * spacing) >= ON_HULL)
