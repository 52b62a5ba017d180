"""Farthest points along directions, spacing, and what hides an end; compiled."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel
from shared.sorting import middle

Array = NDArray[np.float64]


@kernel
def extremes(points: Array, normals: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    """Return the largest and the least of m . p, and whose the largest is, per direction.

    Parameters
    ----------
    points, normals : (n, D), (K, D) arrays

    Returns
    -------
    high, low, end : (K,) arrays
    """
    count, size = normals.shape
    high, low = np.empty(count), np.empty(count)
    end = np.empty(count, dtype=np.int64)
    for k in range(count):
        most, least, which = -np.inf, np.inf, 0
        for n in range(points.shape[0]):
            value = 0.0
            for m in range(size):
                value += normals[k, m] * points[n, m]
            if value > most:
                most, which = value, n
            if value < least:
                least = value
        high[k], low[k], end[k] = most, least, which
    return high, low, end


@kernel
def rivals(points: Array, normals: Array, level: Array) -> Array:
    """Return how many points (n, 3) lie farther along each direction (K, 3) than a level (K,)."""
    found = np.zeros(normals.shape[0])
    for k in range(normals.shape[0]):
        x, y, z = normals[k, 0], normals[k, 1], normals[k, 2]
        for n in range(points.shape[0]):
            if x * points[n, 0] + y * points[n, 1] + z * points[n, 2] > level[k]:
                found[k] += 1.0
    return found


@kernel
def nearest_spacing(flat: Array, probes: int) -> float:
    """Return the median distance to the nearest other point, over some of points (n, 2)."""
    count = flat.shape[0]
    step = max(count // probes, 1)
    found = np.empty((count + step - 1) // step)
    for k in range(found.shape[0]):
        best = np.inf
        for m in range(count):
            du, dv = flat[m, 0] - flat[k * step, 0], flat[m, 1] - flat[k * step, 1]
            squared = du * du + dv * dv
            if 0.0 < squared < best:
                best = squared
        found[k] = best
    found = found[np.isfinite(found)]
    return math.sqrt(middle(found)) if found.shape[0] > 0 else 0.0


@kernel
def nearer_beside(ends: Array, depth: Array, flat: Array, ahead: Array, beside: float) -> Array:
    """Return how much nearer the sensor is what is just beside each end of an outline.

    Parameters
    ----------
    ends, depth : (K, 2), (K,) arrays
        Ends in the image and how far ahead they are.
    flat, ahead : (m, 2), (m,) arrays
        The same of everything else; what is not ahead of the sensor is left out.
    beside : float
        Reach in the image.

    Returns
    -------
    nearer : (K,) array
        Mean over what is beside; minus infinity where nothing is.
    """
    count = ends.shape[0]
    total, number = np.zeros(count), np.zeros(count)
    low, high = np.empty(2), np.empty(2)
    for j in range(2):
        low[j], high[j] = np.min(ends[:, j]) - beside, np.max(ends[:, j]) + beside
    for n in range(flat.shape[0]):
        u, v = flat[n, 0], flat[n, 1]
        if ahead[n] <= 0.0 or u < low[0] or u > high[0] or v < low[1] or v > high[1]:
            continue
        for k in range(count):
            if abs(u - ends[k, 0]) < beside and abs(v - ends[k, 1]) < beside:
                total[k] += depth[k] - ahead[n]
                number[k] += 1.0
    out = np.full(count, -np.inf)
    for k in range(count):
        if number[k] > 0.0:
            out[k] = total[k] / number[k]
    return out


@kernel
def smallest_rectangle(flat: Array, turns: int) -> float:
    """Return the angle (within 45 degrees) by which the tightest rectangle of points is turned.

    Points (n, 2); tried in `turns` steps, then about the best in steps of a third.
    """
    step = math.pi / 2 / turns
    best_angle, best_area = 0.0, np.inf
    middle = 0.0
    for fine in range(2):
        first, count = (-(turns // 2), turns) if fine == 0 else (-2, 5)
        size = step if fine == 0 else step / 3.0
        for k in range(count):
            angle = middle + (first + k) * size
            cos, sin = math.cos(angle), math.sin(angle)
            left, right, bottom, top = np.inf, -np.inf, np.inf, -np.inf
            for n in range(flat.shape[0]):
                x = cos * flat[n, 0] + sin * flat[n, 1]
                y = cos * flat[n, 1] - sin * flat[n, 0]
                left, right = min(left, x), max(right, x)
                bottom, top = min(bottom, y), max(top, y)
            area = (right - left) * (top - bottom)
            if area < best_area:
                best_area, best_angle = area, angle
        middle = best_angle
    return best_angle


@kernel
def frame_about(z_axis: Array, x_hint: Array) -> Array:
    """Return a rotation (3, 3): third column a unit vector, first the hint's part across it.

    The hint (3,) is of any length, and not along the axis.
    """
    frame = np.empty((3, 3))
    along = 0.0
    for k in range(3):
        along += z_axis[k] * x_hint[k]
    squared = 0.0
    for k in range(3):
        frame[k, 0] = x_hint[k] - along * z_axis[k]
        frame[k, 2] = z_axis[k]
        squared += frame[k, 0] ** 2
    length = math.sqrt(squared)
    for k in range(3):
        frame[k, 0] /= length
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        frame[k, 1] = frame[i, 2] * frame[j, 0] - frame[j, 2] * frame[i, 0]
    return frame
