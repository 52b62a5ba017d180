"""From where a scene is looked at first."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shared.geometry.rotation import frame_from_z, unit

Array = NDArray[np.float64]

ELEVATION_DEG = 28.0
AZIMUTH_DEG = 35.0
DISTANCE = 2.6
"""Of the eye from the middle, in radii of what is shown."""


@dataclass(frozen=True)
class Eye:
    """A place to look from.

    Attributes
    ----------
    position, look_at, up : (3,) arrays
        In the scene's frame, metres; `up` is a unit vector.
    """

    position: Array
    look_at: Array
    up: Array


def eye_of(points: Array, up: ArrayLike, viewpoint: ArrayLike) -> Eye:
    """Return a view on `points` from the sensor's side, a little from above and from the right.

    Parameters
    ----------
    points : (N, 3) array
        Of what matters, metres.
    up : (3,) array_like
        Against gravity.
    viewpoint : (3,) array_like
        Position of the sensor.
    """
    held = points[np.isfinite(points).all(axis=1)]
    if not len(held):
        held = np.array([[0.0, 0.0, 0.5]])
    middle = (held.min(axis=0) + held.max(axis=0)) / 2
    radius = max(float(np.linalg.norm(held - middle, axis=1).max()), 0.05)
    z = unit(up) if np.linalg.norm(up) > 0 else np.array([0.0, 0.0, 1.0])
    away, left, _ = frame_from_z(z, x_hint=middle - np.asarray(viewpoint, dtype=float)).T
    azimuth, elevation = np.deg2rad([AZIMUTH_DEG, ELEVATION_DEG])
    level = -np.cos(azimuth) * away - np.sin(azimuth) * left
    towards = np.cos(elevation) * level + np.sin(elevation) * z
    return Eye(middle + DISTANCE * (radius + 0.1) * towards, middle, z)
