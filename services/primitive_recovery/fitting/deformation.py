"""Taper and bend on top of a fitted superquadric, where they pay (Solina and Bajcsy 1990)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.descent import solve
from services.primitive_recovery.fitting.gauge import TINY, log_gauge
from shared.jit import kernel
from shared.schemas.primitive import Deformation

Array = NDArray[np.float64]

WORTH_A_TRY = 0.05
"""Residual, as a share of the smallest extent, below which nothing is tried."""
DEEP, HOLLOW = 0.5, 0.25
"""A part is hollow, and no bent solid, if so many points are so far inside (in widths)."""
MEASUREMENTS = 50
"""How many independent measurements the points are at most: neighbours are off alike."""

_POINTS, _STEPS = 80, 3
_MOST_TAPER, _MOST_BEND = 0.9, 1.5


def deformation_of(
    local: Array, exponents: Array, semi_axes: Array, residual: float, noise: float
) -> Deformation | None:
    """Return taper and bend where they explain points better than scaling and shifting alone.

    Both descriptions are refined, with semi-axes and centre free in either, and compared by
    the Bayesian information criterion: four further parameters must lower the robust sum of
    squares by enough.

    Parameters
    ----------
    local : (n, 3) array
        Points, in random order, in the superquadric's own frame, metres.
    exponents, semi_axes : (2,), (3,) arrays
    residual, noise : float
        Root mean square distance of the points; their standard deviation; metres.
    """
    if residual < max(WORTH_A_TRY * 2 * float(semi_axes.min()), 3 * noise):
        return None
    size = float(semi_axes.max())
    points = np.ascontiguousarray(local[:_POINTS] / size)
    width = 2.0 * residual / size
    start = np.zeros(10)
    start[4:7] = np.log(semi_axes / size)
    if np.mean(deformed_distances(points, exponents, start) < -DEEP * width) > HOLLOW:
        return None
    plain, _ = refined(points, exponents, start, width, 4)
    bent, found = refined(points, exponents, start, width, 0)
    measurements = min(len(points), MEASUREMENTS)
    gain = measurements * math.log(max(plain, 1e-300) / max(bent, 1e-300))
    if gain < 4 * math.log(measurements):
        return None
    kx, ky, bend_x, bend_y = (float(value) for value in found[:4])
    length = size * math.exp(float(found[6]))
    return Deformation(
        taper=(kx, ky),
        bend=(math.hypot(bend_x, bend_y) / length, math.atan2(bend_y, bend_x)),
    )


@kernel
def straightened(point: Array, values: Array, out: Array) -> None:
    """Undo shift, bend and taper of a point (3,); `out` (3,) gets it in the straight frame.

    `values` (10,): kx, ky; the bend's curvature times a3 along x and along y; log a1, log a2,
    log a3; the shift.
    """
    x, y, z = point[0] - values[7], point[1] - values[8], point[2] - values[9]
    a3 = math.exp(values[6])
    curvature = math.hypot(values[2], values[3]) / a3
    if curvature > 1e-9:
        cos, sin = values[2] / (curvature * a3), values[3] / (curvature * a3)
        across = x * cos + y * sin
        radius = 1.0 / curvature
        straight = radius - math.hypot(z, radius - across)
        x += cos * (straight - across)
        y += sin * (straight - across)
        z = math.atan2(z, radius - across) * radius
    level = min(max(z / a3, -1.0), 1.0)  # beyond the ends the cross-section stays
    out[0] = x / (1.0 + values[0] * level)
    out[1] = y / (1.0 + values[1] * level)
    out[2] = z


@kernel
def deformed_distances(points: Array, exponents: Array, values: Array) -> Array:
    """Return distances (n,) to first order of points (n, 3) from the deformed surface."""
    out = np.empty(points.shape[0])
    a = np.exp(values[4:7])
    local = np.empty(3)
    for n in range(points.shape[0]):
        straightened(points[n], values, local)
        for k in range(3):
            local[k] = max(abs(local[k]), TINY * a[k])
        scale, x, y, z, _, _ = log_gauge(
            math.log(local[0] / a[0]),
            math.log(local[1] / a[1]),
            math.log(local[2] / a[2]),
            exponents[0],
            exponents[1],
        )
        steep = (x / local[0]) ** 2 + (y / local[1]) ** 2 + (z / local[2]) ** 2
        out[n] = (1.0 - math.exp(-scale)) / math.sqrt(steep)
    return out


@kernel
def robust_sum(distances: Array, width: float) -> float:
    """Return the sum of Geman and McClure's function of distances (n,)."""
    total = 0.0
    for n in range(distances.shape[0]):
        squared = distances[n] ** 2
        total += squared / (1.0 + squared / (width * width))
    return total


@kernel
def refined(
    points: Array, exponents: Array, start: Array, width: float, first: int
) -> tuple[float, Array]:
    """Lower the robust sum over `start` (10,) from index `first` on, by damped Gauss-Newton.

    Returns
    -------
    cost : float
    values : (10,) array
    """
    values = start.copy()
    size = 10 - first
    h = 1e-5
    distances = deformed_distances(points, exponents, values)
    cost = robust_sum(distances, width)
    jacobian = np.empty((points.shape[0], size))
    matrix, right = np.empty((size, size)), np.empty(size)
    lower, step = np.zeros((size, size)), np.zeros(size)
    damping = 1e-2
    for _ in range(_STEPS):
        for j in range(size):
            ahead = values.copy()
            ahead[first + j] += h
            jacobian[:, j] = (deformed_distances(points, exponents, ahead) - distances) / h
        matrix[:] = 0.0
        right[:] = 0.0
        for n in range(points.shape[0]):
            weight = 1.0 / (1.0 + distances[n] ** 2 / (width * width)) ** 2
            for i in range(size):
                right[i] -= weight * jacobian[n, i] * distances[n]
                for j in range(size):
                    matrix[i, j] += weight * jacobian[n, i] * jacobian[n, j]
        for i in range(size):
            matrix[i, i] *= 1.0 + damping
            matrix[i, i] += 1e-6 * points.shape[0]
        if not solve(matrix, right, lower, step):
            break
        trial = values.copy()
        for i in range(size):
            trial[first + i] += min(max(step[i], -0.3), 0.3)
        for i in range(2):
            trial[i] = min(max(trial[i], -_MOST_TAPER), _MOST_TAPER)
            trial[2 + i] = min(max(trial[2 + i], -_MOST_BEND), _MOST_BEND)
        trial_distances = deformed_distances(points, exponents, trial)
        trial_cost = robust_sum(trial_distances, width)
        if trial_cost < cost:
            gain = cost - trial_cost
            values, distances, cost = trial, trial_distances, trial_cost
            damping *= 0.2
            if gain < 1e-3 * cost:
                break
        else:
            damping *= 10.0
    return cost, values
