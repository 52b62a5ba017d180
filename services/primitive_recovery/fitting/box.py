"""What stands for a part of too few points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.fit import PartFit
from shared.geometry.points import principal_axes
from shared.geometry.rotation import frame_from_z, quaternion_from_matrix
from shared.superquadric import Superquadric, radial_distance

Array = NDArray[np.float64]

PIXEL = 1 / 600
"""Angle between the points of a depth camera: what a single point measures across."""
EXPONENTS = (0.4, 0.8)


def plain_box(points: Array, viewpoint: Array, normal: Array | None) -> PartFit:
    """Return a rounded box around points (n, 3), n >= 1, with a large covariance.

    Its thinnest side is a pixel at least. Semi-axes and position are uncertain by as much
    as they are large, the rotation by a radian.
    """
    axes = principal_axes(points)[1]
    frame = axes if normal is None else frame_from_z(normal, axes[:, 0])
    local = points @ frame
    low, high = local.min(axis=0), local.max(axis=0)
    size = high - low
    distance = float(np.linalg.norm(points.mean(axis=0) - viewpoint))
    semi_axes = np.maximum(size / 2, max(PIXEL * distance / 2, 1e-2 * float(size.max()), 1e-6))
    body = Superquadric.from_vector(
        [*EXPONENTS, *semi_axes, *(frame @ ((low + high) / 2)), *quaternion_from_matrix(frame)]
    )
    turned = frame @ np.diag(semi_axes**2) @ frame.T
    covariance = np.zeros((11, 11))
    covariance[:5, :5] = np.diag([0.25, 0.25, *semi_axes**2])
    covariance[5:8, 5:8] = (turned + turned.T) / 2
    covariance[8:, 8:] = np.eye(3)
    residual = float(np.sqrt((radial_distance(body, points) ** 2).mean()))
    return PartFit(body, covariance, residual, None, rests=False)
