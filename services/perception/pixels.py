"""From raw input to valid points, in one pass over it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]
Rows = NDArray[np.intp]


@kernel
def points_of_depth(
    depth: Array, intrinsics: Array, scale: float, saturated: float
) -> tuple[Array, Rows, float]:
    """Return the points (M, 3) of the pixels with a return, and their rows (M,), row-major.

    As `shared.geometry.points.points_from_depth` without the pixels that it makes NaN. The third
    value is the largest coordinate of the points, whatever its sign.

    Parameters
    ----------
    depth : (H, W) array
        Along the optical axis, in units of `scale`; zero, negative and non-finite
        values are no return.
    intrinsics : (3, 3) array
        Pinhole matrix, in pixels.
    scale : float
        Metres per unit.
    saturated : float
        A value that is no return either; NaN for none.
    """
    height, width = depth.shape
    points = np.empty((height * width, 3))
    rows = np.empty(height * width, dtype=np.intp)
    skew = intrinsics[0, 1] / intrinsics[0, 0]
    across = (np.arange(width) - intrinsics[0, 2]) / intrinsics[0, 0]
    count, reach = 0, 0.0
    for i in range(height):
        y = (i - intrinsics[1, 2]) / intrinsics[1, 1]
        shift = skew * y
        for j in range(width):
            z = depth[i, j] * scale
            if not (0.0 < z < np.inf) or depth[i, j] == saturated:
                continue
            x = across[j] - shift
            points[count, 0] = x * z
            points[count, 1] = y * z
            points[count, 2] = z
            reach = max(reach, max(abs(x), abs(y), 1.0) * z)
            rows[count] = i * width + j
            count += 1
    return points[:count], rows[:count], reach


@kernel
def points_within(points: Array, limit: float) -> tuple[Array, Rows, float]:
    """Return the points (M, 3) of (N, 3) whose coordinates are less than `limit`, and their rows.

    The third value is the largest coordinate of what is left, whatever its sign. NaN is not less
    than anything; an infinite limit leaves out what is not finite.
    """
    kept = np.empty(points.shape)
    rows = np.empty(len(points), dtype=np.intp)
    count, reach = 0, 0.0
    for i in range(len(points)):
        x, y, z = points[i, 0], points[i, 1], points[i, 2]
        if abs(x) < limit and abs(y) < limit and abs(z) < limit:
            kept[count, 0] = x
            kept[count, 1] = y
            kept[count, 2] = z
            rows[count] = i
            reach = max(reach, abs(x), abs(y), abs(z))
            count += 1
    return kept[:count], rows[:count], reach


@kernel
def distances(points: Array, origin: Array) -> Array:
    """Return the distance (N,) of points (N, 3) from `origin` (3,)."""
    found = np.empty(len(points))
    for i in range(len(points)):
        x = points[i, 0] - origin[0]
        y = points[i, 1] - origin[1]
        z = points[i, 2] - origin[2]
        found[i] = np.sqrt(x * x + y * y + z * z)
    return found


@kernel
def heights_above(points: Array, normal: Array, offset: float) -> Array:
    """Return the signed distance (N,) of points (N, 3) from the plane `normal . p + offset`."""
    a, b, c = normal[0], normal[1], normal[2]
    found = np.empty(len(points))
    for i in range(len(points)):
        found[i] = a * points[i, 0] + b * points[i, 1] + c * points[i, 2] + offset
    return found
