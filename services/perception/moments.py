"""Moments of the points near a plane: what a least-squares fit to them needs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]
Counts = NDArray[np.int64]


@kernel
def moments_near(
    points: Array, origin: Array, normals: Array, offsets: Array, tolerance: float
) -> tuple[Counts, Array, Array]:
    """Return number, mean and scatter of the points (N, 3) within `tolerance` of each plane.

    Shapes (F,), (F, 3) and (F, 3, 3), about `origin` (3,), as are the F planes
    `normal . (p - origin) + offset`.
    """
    counts, means = np.zeros(len(normals), dtype=np.int64), np.empty(normals.shape)
    scatters = np.empty((len(normals), 3, 3))
    for f in range(len(normals)):
        a, b, c, d = normals[f, 0], normals[f, 1], normals[f, 2], offsets[f]
        sx = sy = sz = 0.0
        xx = xy = xz = yy = yz = zz = 0.0
        for i in range(len(points)):
            x = points[i, 0] - origin[0]
            y = points[i, 1] - origin[1]
            z = points[i, 2] - origin[2]
            if abs(a * x + b * y + c * z + d) < tolerance:
                counts[f] += 1
                sx += x
                sy += y
                sz += z
                xx += x * x
                xy += x * y
                xz += x * z
                yy += y * y
                yz += y * z
                zz += z * z
        share = 1.0 / max(counts[f], 1)
        mean = np.array([sx, sy, sz]) * share
        scatter = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) * share
        means[f], scatters[f] = mean, scatter - np.outer(mean, mean)
    return counts, means, scatters


@kernel
def biweight_moments(
    points: Array, step: int, origin: Array, normal: Array, offset: float, scale: float
) -> tuple[float, Array, Array]:
    """Return the weight in all, mean (3,) and scatter (3, 3) of points (N, 3) about `origin`.

    Of every `step`-th of them. One at height h above the plane `normal . (p - origin) + offset`
    weighs (1 - (h / scale)^2)^2, nothing from `scale` on. The sums run in the order of the
    points, whatever the number of threads.
    """
    a, b, c = normal[0], normal[1], normal[2]
    total = 0.0
    sx = sy = sz = 0.0
    xx = xy = xz = yy = yz = zz = 0.0
    for i in range(0, len(points), step):
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
