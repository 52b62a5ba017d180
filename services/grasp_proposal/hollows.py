"""Floors that a wall hides: what is seen of a hollow's floor goes on to the wall in front of it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.geometry.rotation import frame_from_z, unit

Array = NDArray[np.float64]

_RAY = 0.005
"""Width of a fan's rays at the object's distance, metres."""
_STEP = 0.004
_GAP, _LONGEST, _DROP = 0.008, 0.5, 0.010
"""What lies this far behind an edge, from `_GAP` to `_LONGEST`, and at least `_DROP` below it is
hidden by it in part. From farther away no hand reaches the edge, and few points are enough."""
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
    level = from_sensor - height[:, None] * up
    distance = np.linalg.norm(level, axis=1)
    if distance.min() < _OVERHEAD:
        return np.empty((0, 3))
    east, north = frame_from_z(up, unit(from_sensor.mean(axis=0)))[:, :2].T
    azimuth = np.arctan2(level @ north, level @ east)
    ray = np.floor(azimuth * np.median(distance) / _RAY).astype(np.int64)
    slope = height / distance
    order = np.lexsort((slope, ray))
    edge, floor = order[:-1], order[1:]
    gap = distance[floor] - distance[edge]
    hidden = (
        (ray[floor] == ray[edge])
        & (gap > _GAP)
        & (gap < _LONGEST)
        & (height[edge] - height[floor] > _DROP)
        & (normals[floor] @ up > _LEVEL)
        & ((slope[floor] - slope[edge]) * distance[floor] < _NEXT_TO)
    )
    floor, gap = floor[hidden], gap[hidden]
    towards_edge = np.arange(_STEP, _LONGEST, _STEP)
    of, step = np.nonzero(towards_edge < gap[:, None])
    away = level[floor] / distance[floor, None]
    return np.asarray(points[floor][of] - away[of] * towards_edge[step, None])
