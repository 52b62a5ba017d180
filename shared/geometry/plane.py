"""Planes `normal . p + offset = 0` with unit normals."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from shared.geometry.rotation import frame_from_z

Array = NDArray[np.float64]


def height_above(points: Array, normal: ArrayLike, offset: float) -> Array:
    """Return signed distances (N,) in metres of points (N, 3) along `normal`."""
    return np.asarray(points @ np.asarray(normal, dtype=np.float64) + offset)


def fit_plane(points: Array) -> tuple[Array, float]:
    """Return normal (3,) and offset of the least-squares plane of points (N, 3), N >= 3.

    The sign of the normal is arbitrary.
    """
    centre = points.mean(axis=0)
    centred = points - centre
    _, vectors = np.linalg.eigh(centred.T @ centred)
    normal = vectors[:, 0]
    return normal, float(-normal @ centre)


def plane_basis(normal: ArrayLike) -> Array:
    """Return an orthonormal basis (3, 2) of the plane's directions."""
    return frame_from_z(normal)[:, :2]
