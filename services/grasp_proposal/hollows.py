"""Floors that a wall hides: what is seen of a hollow's floor goes on to the wall in front of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.geometry.rotation import frame_from_z, unit

Array = NDArray[np.float64]

_RAY = 0.005
"""Width of a fan's rays at the object's distance, metres."""
_STEP = 0.004
_GAP, _DROP = 0.008, 0.010
"""What lies at least this far behind an edge and this far below it is hidden by it in part."""
_NEXT_TO = 0.008
"""No farther above the line of sight over the edge begins what the edge hides."""
_LEVEL = 0.9
"""Cosine between up and the normal of a floor."""
_OVERHEAD = 0.05
"""Nearer to the plumb line under the sensor than this, no wall hides a floor."""


def hidden_floor(points: Array, normals: Array, up: Array | None, viewpoint: Array | None) -> Array:
    """Return points (F, 3) on floors that are out of sight.

    A pan's near wall hides the floor behind it. Where a sight line that passes over an edge meets
    something level, lower and farther away, that surface is taken to go on towards the edge; where
    it meets the support or nothing, nothing is known of what is behind the edge.

    Parameters
    ----------
    points, normals : (N, 3) arrays
        The visible surface.
    up : (3,) array or None
        Against gravity; without it nothing is level.
    viewpoint : (3,) array or None
    """
    if up is None or viewpoint is None:
        return np.empty((0, 3))
    from_sensor = points - viewpoint
    height = from_sensor @ up
    ahead = unit(from_sensor.mean(axis=0))
    east, north = frame_from_z(up, ahead)[:, :2].T
    x, y = from_sensor @ east, from_sensor @ north
    distance = np.hypot(x, y)
    if distance.min() < _OVERHEAD:
        return np.empty((0, 3))
    ray = np.floor(np.arctan2(y, x) * np.median(distance) / _RAY).astype(np.int64)
    slope = height / distance
    order = np.lexsort((slope, ray))
    edge, floor = order[:-1], order[1:]
    gap = distance[floor] - distance[edge]
    hidden = (
        (ray[floor] == ray[edge])
        & (gap > _GAP)
        & (height[edge] - height[floor] > _DROP)
        & (normals[floor] @ up > _LEVEL)
        & ((slope[floor] - slope[edge]) * distance[floor] < _NEXT_TO)
    )
    floor, gap = floor[hidden], gap[hidden]
    counts = np.ceil(gap / _STEP).astype(np.int64)
    of = np.repeat(np.arange(len(floor)), counts)
    back = _STEP * (np.arange(len(of)) - np.repeat(np.cumsum(counts) - counts, counts) + 1)
    keep = back < gap[of]
    of, back = of[keep], back[keep]
    away = np.column_stack([x, y])[floor] / distance[floor, None]
    towards = away[:, :1] * east + away[:, 1:] * north
    return np.asarray(points[floor][of] - towards[of] * back[:, None])
