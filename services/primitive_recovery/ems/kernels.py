"""The radial distance, its normal equations and the rotation update, compiled.

They take points (N, 3) in some frame, `shape` (5,) = [e1, e2, a1, a2, a3],
`rotation` (3, 3) from the superquadric's frame and `position` (3,), as writable
C-contiguous float64 arrays.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from shared.jit import kernel

Array = NDArray[np.float64]

UNKNOWNS = 11
"""e1, e2, a1, a2, a3, a rotation vector in the superquadric's frame, the position."""

_TINY = 1e-12


@kernel
def radial_distances(points: Array, shape: Array, rotation: Array, position: Array) -> Array:
    """Return signed distances (N,) to the surface along the ray from the centre.

    |q| (1 - F^(-e1/2)) for q in the superquadric's frame, negative inside, and as
    in `shared.superquadric.radial_distance` no lower than minus the smallest
    semi-axis: no point inside is farther from the surface than that.
    """
    e1, e2 = shape[0], shape[1]
    lowest = -min(shape[2], shape[3], shape[4])
    out = np.empty(points.shape[0])
    logs = np.empty(3)
    for n in range(points.shape[0]):
        squared = 0.0
        for k in range(3):
            value = 0.0
            for m in range(3):
                value += rotation[m, k] * (points[n, m] - position[m])
            squared += value * value
            logs[k] = math.log(max(abs(value) / shape[2 + k], _TINY))
        gap = 2.0 / e2 * abs(logs[0] - logs[1])
        flat = max(logs[0], logs[1]) + 0.5 * e2 * math.log1p(math.exp(-gap))
        gap = 2.0 / e1 * abs(flat - logs[2])
        scale = max(flat, logs[2]) + 0.5 * e1 * math.log1p(math.exp(-gap))
        distance = math.sqrt(squared) * (1.0 - math.exp(-scale))
        out[n] = max(distance, lowest) if squared > 0.0 else lowest
    return out


@kernel
def normal_equations(
    points: Array, weights: Array, shape: Array, rotation: Array, position: Array
) -> tuple[float, Array, Array]:
    """Return cost, gradient (11,) and Gauss-Newton matrix (11, 11) of sum_i w_i d_i^2 / 2.

    The unknowns are [e1, e2, a1, a2, a3, omega, t]: the rotation moves as
    R exp([omega]), the position as t. With L = log F^(e1/2), the derivatives of
    d = |q| (1 - exp(-L)) follow from those of two nested log-sum-exps: to a log
    coordinate it is that term's share, to an exponent half the shares' entropy,
    so nothing overflows for small exponents. Here d has no lower limit: it must
    be smooth.
    """
    e1, e2 = shape[0], shape[1]
    rows = np.empty(11)
    local = np.empty(3)
    logs = np.empty(3)
    share = np.empty(3)
    slope = np.empty(3)
    gradient = np.zeros(11)
    matrix = np.zeros((11, 11))
    cost = 0.0
    for n in range(points.shape[0]):
        weight = weights[n]
        if weight < 1e-9:
            continue
        squared = 0.0
        for k in range(3):
            value = 0.0
            for m in range(3):
                value += rotation[m, k] * (points[n, m] - position[m])
            floor = _TINY * shape[2 + k]
            if abs(value) < floor:
                value = floor if value >= 0.0 else -floor
            local[k] = value
            squared += value * value
            logs[k] = math.log(abs(value) / shape[2 + k])
        # The cross-section: log of the 2/e2-norm of (x/a1, y/a2).
        gap = 2.0 / e2 * abs(logs[0] - logs[1])
        small = math.exp(-gap)
        swell = math.log1p(small)
        minor = small / (1.0 + small)
        entropy2 = swell + gap * minor
        flat = max(logs[0], logs[1]) + 0.5 * e2 * swell
        share_x = 1.0 - minor if logs[0] >= logs[1] else minor
        # The profile: log of the 2/e1-norm of (cross-section, z/a3).
        gap = 2.0 / e1 * abs(flat - logs[2])
        small = math.exp(-gap)
        swell = math.log1p(small)
        minor = small / (1.0 + small)
        entropy1 = swell + gap * minor
        share_flat = 1.0 - minor if flat >= logs[2] else minor
        scale = max(flat, logs[2]) + 0.5 * e1 * swell
        share[0] = share_flat * share_x
        share[1] = share_flat * (1.0 - share_x)
        share[2] = 1.0 - share_flat

        length = math.sqrt(squared)
        shrink = math.exp(-scale)
        distance = length * (1.0 - shrink)
        reach = length * shrink  # from the centre to the surface along this ray
        rows[0] = reach * 0.5 * entropy1
        rows[1] = reach * share_flat * 0.5 * entropy2
        for k in range(3):
            rows[2 + k] = -reach * share[k] / shape[2 + k]
            slope[k] = (1.0 - shrink) * local[k] / length + reach * share[k] / local[k]
        rows[5] = slope[1] * local[2] - slope[2] * local[1]
        rows[6] = slope[2] * local[0] - slope[0] * local[2]
        rows[7] = slope[0] * local[1] - slope[1] * local[0]
        for m in range(3):
            rows[8 + m] = -(
                rotation[m, 0] * slope[0] + rotation[m, 1] * slope[1] + rotation[m, 2] * slope[2]
            )
        cost += 0.5 * weight * distance * distance
        for a in range(11):
            weighted = weight * rows[a]
            gradient[a] += weighted * distance
            for b in range(a + 1):
                matrix[a, b] += weighted * rows[b]
    for a in range(11):
        for b in range(a):
            matrix[b, a] = matrix[a, b]
    return cost, gradient, matrix


@kernel
def turned(rotation: Array, vector: Array) -> Array:
    """Return R exp([v]) for a rotation (3, 3) and a rotation vector (3,) in its frame."""
    x, y, z = vector[0], vector[1], vector[2]
    squared = x * x + y * y + z * z
    angle = math.sqrt(squared)
    if angle < 1e-6:
        first, second = 1.0 - squared / 6.0, 0.5 - squared / 24.0
    else:
        first, second = math.sin(angle) / angle, (1.0 - math.cos(angle)) / squared
    turn = np.empty((3, 3))
    turn[0, 0] = 1.0 - second * (y * y + z * z)
    turn[1, 1] = 1.0 - second * (x * x + z * z)
    turn[2, 2] = 1.0 - second * (x * x + y * y)
    turn[0, 1] = second * x * y - first * z
    turn[1, 0] = second * x * y + first * z
    turn[0, 2] = second * x * z + first * y
    turn[2, 0] = second * x * z - first * y
    turn[1, 2] = second * y * z - first * x
    turn[2, 1] = second * y * z + first * x
    out = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                out[i, j] += rotation[i, k] * turn[k, j]
    return out
