"""Moments of the points near a plane: what a least-squares fit to them needs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]


@kernel
def moments_near(
    points: Array, origin: Array, normal: Array, offset: float, tolerance: float
) -> tuple[int, Array, Array]:
    """Return number, mean (3,) and scatter (3, 3) of the points (N, 3) within `tolerance`.

    About `origin` (3,), as is the plane `normal . (p - origin) + offset`.
    """
    a, b, c = normal[0], normal[1], normal[2]
    count = 0
    sx = sy = sz = 0.0
    xx = xy = xz = yy = yz = zz = 0.0
    for i in range(len(points)):
        x = points[i, 0] - origin[0]
        y = points[i, 1] - origin[1]
        z = points[i, 2] - origin[2]
        if abs(a * x + b * y + c * z + offset) < tolerance:
            count += 1
            sx += x
            sy += y
            sz += z
            xx += x * x
            xy += x * y
            xz += x * z
            yy += y * y
            yz += y * z
            zz += z * z
    share = 1.0 / max(count, 1)
    mean = np.array([sx, sy, sz]) * share
    scatter = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) * share
    return count, mean, scatter - np.outer(mean, mean)


@kernel
def biweight_moments(
    points: Array, origin: Array, normal: Array, offset: float, scale: float
) -> tuple[float, Array, Array]:
    """Return the weight in all, mean (3,) and scatter (3, 3) of points (N, 3) about `origin`.

    A point at height h above the plane `normal . (p - origin) + offset` weighs
    (1 - (h / scale)^2)^2, nothing from `scale` on. The sums run in the order of the
    points, whatever the number of threads.
    """
    a, b, c = normal[0], normal[1], normal[2]
    total = 0.0
    sx = sy = sz = 0.0
    xx = xy = xz = yy = yz = zz = 0.0
    for i in range(len(points)):
        x = points[i, 0] - origin[0]
        y = points[i, 1] - origin[1]
        z = points[i, 2] - origin[2]
        far = ((a * x + b * y + c * z + offset) / scale) ** 2
        if far >= 1.0:
            continue
        weight = (1.0 - far) ** 2
        wx, wy, wz = weight * x, weight * y, weight * z
        total += weight
        sx += wx
        sy += wy
        sz += wz
        xx += wx * x
        xy += wx * y
        xz += wx * z
        yy += wy * y
        yz += wy * z
        zz += wz * z
    inverse = 1.0 / max(total, 1e-300)
    mean = np.array([sx, sy, sz]) * inverse
    scatter = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) * inverse
    return total, mean, scatter - np.outer(mean, mean)
