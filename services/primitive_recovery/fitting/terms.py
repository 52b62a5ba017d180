"""The terms of the cost, their gradients and Gauss-Newton matrices; compiled.

The unknowns (11,) are [e1, e2, log a1, log a2, log a3, omega, t]: the rotation moves as
R exp([omega]), the position as t. `shape` (5,) holds the first five. Arrays are
C-contiguous float64, lengths in the unit of the fit. Each term adds the lower triangle of
its matrix (11, 11) and its gradient (11,), and returns its cost.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.fitting.gauge import TINY, log_gauge
from shared.jit import kernel

Array = NDArray[np.float64]

EQUAL, AT_LEAST, AT_MOST = 0.0, 1.0, -1.0
"""What a support says: the body touches its plane, reaches it or more, or stays behind it."""

_SPAN = 100.0
"""Square of the width of the supports' Cauchy function, in tolerances."""
_ROUND, _PINCHED = 1.0, 0.2
"""Exponents above the first pinch corners that few things have; how far they may go."""


@kernel
def point_terms(
    points: Array,
    shape: Array,
    rotation: Array,
    position: Array,
    width: float,
    share: float,
    matrix: Array,
    gradient: Array,
) -> float:
    """Return `share` times the robust sum of squared distances of points (n, 3).

    A distance is r = d cos, d the radial distance and cos that of the angle between the
    ray from the centre and the surface's normal: to first order the distance proper
    (Taubin 1991), where d alone is many times as long near the ends of a rod. Outside,
    Cauchy's function of r / width; inside, Geman and McClure's, which is bounded: a bowl's
    hollow is inside of the solid that stands for it. cos is held where it is.
    """
    e1, e2 = shape[0], shape[1]
    a = np.exp(shape[2:5])
    rows = np.empty(11)
    local = np.empty(3)
    slope = np.empty(3)
    part = np.empty(3)
    cost = 0.0
    inverse = 1.0 / (width * width)
    for n in range(points.shape[0]):
        squared = 0.0
        for k in range(3):
            value = 0.0
            for m in range(3):
                value += rotation[m, k] * (points[n, m] - position[m])
            floor = TINY * a[k]
            if abs(value) < floor:
                value = floor if value >= 0.0 else -floor
            local[k] = value
            squared += value * value
        scale, part[0], part[1], part[2], to_e1, to_e2 = log_gauge(
            math.log(abs(local[0]) / a[0]),
            math.log(abs(local[1]) / a[1]),
            math.log(abs(local[2]) / a[2]),
            e1,
            e2,
        )
        length = math.sqrt(squared)
        shrink = math.exp(-scale)
        steep = 0.0
        for k in range(3):
            slope[k] = part[k] / local[k]
            steep += slope[k] * slope[k]
        cosine = 1.0 / (length * math.sqrt(steep))
        distance = length * (1.0 - shrink)
        ratio = (distance * cosine) ** 2 * inverse
        weight = 1.0 / (1.0 + ratio)
        if distance > 0.0:
            cost += math.log1p(ratio)
        else:
            cost += ratio * weight
            weight *= weight
        weight *= share * cosine * cosine
        if weight * squared < 1e-9 * share * width * width:
            continue
        reach = length * shrink
        rows[0] = reach * to_e1
        rows[1] = reach * to_e2
        for k in range(3):
            rows[2 + k] = -reach * part[k]
            slope[k] = (1.0 - shrink) * local[k] / length + reach * slope[k]
        rows[5] = slope[1] * local[2] - slope[2] * local[1]
        rows[6] = slope[2] * local[0] - slope[0] * local[2]
        rows[7] = slope[0] * local[1] - slope[1] * local[0]
        for m in range(3):
            rows[8 + m] = -(
                rotation[m, 0] * slope[0] + rotation[m, 1] * slope[1] + rotation[m, 2] * slope[2]
            )
        for i in range(11):
            weighted = weight * rows[i]
            gradient[i] += weighted * distance
            for j in range(i + 1):
                matrix[i, j] += weighted * rows[j]
    return float(0.5 * share * width * width * cost)


@kernel
def support_row(
    direction: Array, shape: Array, rotation: Array, position: Array, row: Array
) -> float:
    """Return how far the body reaches along a direction (3,), and fill its derivatives (11,).

    max over the body of m . x = m . t + h(R^T m), with the support function h: the same
    nested norm as the surface's, of the direction's components times the semi-axes, with
    2 - e for each exponent e.
    """
    a = np.exp(shape[2:5])
    local = np.empty(3)
    for k in range(3):
        value = 0.0
        for m in range(3):
            value += rotation[m, k] * direction[m]
        if abs(value) < TINY:
            value = TINY if value >= 0.0 else -TINY
        local[k] = value
    scale, to_x, to_y, to_z, to_e1, to_e2 = log_gauge(
        math.log(abs(local[0]) * a[0]),
        math.log(abs(local[1]) * a[1]),
        math.log(abs(local[2]) * a[2]),
        max(2.0 - shape[0], 0.02),
        max(2.0 - shape[1], 0.02),
    )
    height = math.exp(scale)
    row[0] = -height * to_e1
    row[1] = -height * to_e2
    row[2], row[3], row[4] = height * to_x, height * to_y, height * to_z
    x, y, z = row[2] / local[0], row[3] / local[1], row[4] / local[2]
    row[5] = y * local[2] - z * local[1]
    row[6] = z * local[0] - x * local[2]
    row[7] = x * local[1] - y * local[0]
    reach = height
    for m in range(3):
        row[8 + m] = direction[m]
        reach += direction[m] * position[m]
    return reach


@kernel
def support_terms(
    supports: Array,
    shape: Array,
    rotation: Array,
    position: Array,
    matrix: Array,
    gradient: Array,
) -> float:
    """Return the robust cost of supports.

    Each of `supports` (K, 6) is a plane's direction (3,), how far along it the plane is,
    the tolerance, and what it says.
    """
    row = np.empty(11)
    cost = 0.0
    for k in range(supports.shape[0]):
        gap = support_row(supports[k, :3], shape, rotation, position, row) - supports[k, 3]
        if supports[k, 5] * gap > 0.0:
            continue
        inverse = 1.0 / (supports[k, 4] * supports[k, 4])
        ratio = gap * gap * inverse / _SPAN
        cost += 0.5 * _SPAN * math.log1p(ratio)
        weight = inverse / (1.0 + ratio)
        for i in range(11):
            weighted = weight * row[i]
            gradient[i] += weighted * gap
            for j in range(i + 1):
                matrix[i, j] += weighted * row[j]
    return cost


@kernel
def prior_terms(
    prior: Array,
    start: Array,
    shape: Array,
    rotation: Array,
    matrix: Array,
    gradient: Array,
) -> float:
    """Return the cost of the priors.

    `prior` (9,): means of e1 and e2, deviation of both, deviation of log a1 - log a2,
    mean and deviation of log a3, deviations in radians of the turn about each own axis away
    `start` (3, 3) in radians, and an unused one.
    """
    cost = 0.0
    for i in range(2):
        gap = shape[i] - prior[i]
        inverse = 1.0 / (prior[2] * prior[2])
        cost += 0.5 * inverse * gap * gap
        gradient[i] += inverse * gap
        matrix[i, i] += inverse
        gap = shape[i] - _ROUND
        if gap > 0.0:
            inverse = 1.0 / (_PINCHED * _PINCHED)
            cost += 0.5 * inverse * gap * gap
            gradient[i] += inverse * gap
            matrix[i, i] += inverse
    inverse = 1.0 / (prior[3] * prior[3])
    gap = shape[2] - shape[3]
    cost += 0.5 * inverse * gap * gap
    gradient[2] += inverse * gap
    gradient[3] -= inverse * gap
    matrix[2, 2] += inverse
    matrix[3, 3] += inverse
    matrix[3, 2] -= inverse
    inverse = 1.0 / (prior[5] * prior[5])
    gap = shape[4] - prior[4]
    cost += 0.5 * inverse * gap * gap
    gradient[4] += inverse * gap
    matrix[4, 4] += inverse
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        gap = 0.0  # half of the antisymmetric part of start^T rotation: the sine of the turn
        for m in range(3):
            gap += 0.5 * (start[m, j] * rotation[m, i] - start[m, i] * rotation[m, j])
        inverse = 1.0 / (prior[6 + k] * prior[6 + k])
        cost += 0.5 * inverse * gap * gap
        gradient[5 + k] += inverse * gap
        matrix[5 + k, 5 + k] += inverse
    return float(cost)
