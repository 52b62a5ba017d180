"""From many starts to the best superquadric: Levenberg-Marquardt steps; compiled."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.ems.kernels import turned
from services.primitive_recovery.fitting.terms import (
    point_terms,
    prior_terms,
    support_terms,
)
from shared.jit import kernel
from shared.sorting import ascending_order

Array = NDArray[np.float64]

INDEPENDENT = 5.0
"""How many independent measurements the model's error is: neighbours are off alike."""
SETTLED = 1e-2
"""A step that lowers the cost by less, and by less than a ten-thousandth, is the last."""


@kernel
def total(
    points: Array,
    supports: Array,
    prior: Array,
    start: Array,
    shape: Array,
    rotation: Array,
    position: Array,
    width: float,
    share: float,
    matrix: Array,
    gradient: Array,
) -> float:
    """Return the cost of a state; fill its Gauss-Newton matrix (11, 11) and gradient (11,)."""
    matrix[:] = 0.0
    gradient[:] = 0.0
    cost = point_terms(points, shape, rotation, position, width, share, matrix, gradient)
    cost += support_terms(supports, shape, rotation, position, matrix, gradient)
    cost += prior_terms(prior, start, shape, rotation, matrix, gradient)
    for i in range(11):
        for j in range(i):
            matrix[j, i] = matrix[i, j]
    return cost


@kernel
def solve(matrix: Array, right: Array, lower: Array, out: Array) -> bool:
    """Solve a positive definite system (k, k) by Cholesky's method; False where it is not.

    `lower` (k, k) is room to work in, `out` (k,) gets the solution.
    """
    size = right.shape[0]
    for i in range(size):
        for j in range(i + 1):
            value = matrix[i, j]
            for k in range(j):
                value -= lower[i, k] * lower[j, k]
            if i == j:
                if not value > 0.0:
                    return False
                lower[i, i] = math.sqrt(value)
            else:
                lower[i, j] = value / lower[j, j]
    for i in range(size):
        value = right[i]
        for k in range(i):
            value -= lower[i, k] * out[k]
        out[i] = value / lower[i, i]
    for i in range(size - 1, -1, -1):
        value = out[i]
        for k in range(i + 1, size):
            value -= lower[k, i] * out[k]
        out[i] = value / lower[i, i]
    return True


@kernel
def descend(
    points: Array,
    supports: Array,
    prior: Array,
    start: Array,
    shape: Array,
    rotation: Array,
    position: Array,
    limits: Array,
    width: float,
    share: float,
    steps: int,
) -> tuple[float, Array, Array, Array, Array]:
    """Lower the cost by projected Levenberg-Marquardt steps.

    `limits` (2, 5) bounds the shape. Unknowns at a limit that the cost would push beyond it
    are held. A step turns by half a radian and doubles an axis at most.

    Returns
    -------
    cost : float
    shape, rotation, position : (5,), (3, 3), (3,) arrays
    matrix : (11, 11) array
        Gauss-Newton matrix there.
    """
    matrix, gradient = np.zeros((11, 11)), np.zeros(11)
    trial_matrix, trial_gradient = np.zeros((11, 11)), np.zeros(11)
    system, lower = np.zeros((11, 11)), np.zeros((11, 11))
    right, step = np.zeros(11), np.zeros(11)
    cost = total(points, supports, prior, start, shape, rotation, position, width, share,
                 matrix, gradient)  # fmt: skip
    damping = 1e-2
    for _ in range(steps):
        for i in range(11):
            for j in range(11):
                system[i, j] = matrix[i, j]
            right[i] = -gradient[i]
        for i in range(5):
            if (shape[i] <= limits[0, i] and gradient[i] > 0.0) or (
                shape[i] >= limits[1, i] and gradient[i] < 0.0
            ):
                right[i] = 0.0
                for j in range(11):
                    system[i, j] = 0.0
                    system[j, i] = 0.0
                system[i, i] = 1.0
        for i in range(11):
            system[i, i] += damping * system[i, i] + 1e-12
        if not solve(system, right, lower, step):
            damping *= 10.0
            continue
        longest = 2.0 * math.sqrt(step[5] ** 2 + step[6] ** 2 + step[7] ** 2)
        for i in range(2, 5):
            longest = max(longest, abs(step[i]) / 0.7)
        if longest > 1.0:
            step /= longest
        trial_shape = np.minimum(np.maximum(shape + step[:5], limits[0]), limits[1])
        trial_rotation = turned(rotation, step[5:8])
        trial_position = position + step[8:]
        trial_cost = total(points, supports, prior, start, trial_shape, trial_rotation,
                           trial_position, width, share, trial_matrix, trial_gradient)  # fmt: skip
        if trial_cost < cost:
            gain = cost - trial_cost
            shape, rotation, position = trial_shape, trial_rotation, trial_position
            matrix, trial_matrix = trial_matrix, matrix
            gradient, trial_gradient = trial_gradient, gradient
            cost = trial_cost
            damping = max(damping / 5.0, 1e-7)
            if gain < SETTLED * (1.0 + 1e-2 * cost):
                break
        else:
            damping *= 8.0
            if damping > 1e5:
                break
    return cost, shape, rotation, position, matrix


@kernel
def informed(noise: float, model: float, count: int) -> float:
    """Return what all points together weigh: noise averages out, the model's error less so."""
    return 1.0 / (noise * noise / count + model * model / INDEPENDENT)


@kernel
def search(
    points: Array,
    coarse: Array,
    supports: Array,
    priors: Array,
    rotations: Array,
    shapes: Array,
    positions: Array,
    odds: Array,
    limits: Array,
    noise: float,
    model: float,
    count: int,
    finalists: Array,
) -> tuple[float, Array, Array, Array, Array]:
    """Return the best of H starts: all are weighed, some descend a little, few to the end.

    Parameters
    ----------
    points, coarse : (n, 3), (c, 3) arrays
        For the last descents, and for what comes before.
    supports, priors, rotations, shapes, positions, odds : arrays of length H
        Each start's own; `odds` is the logarithm of its prior odds.
    limits : (2, 5) array
    noise, model : float
        Standard deviations of the points, and of a part's surface about a superquadric's.
    count : int
        How many points the noise was drawn for.
    finalists : (4,) array
        How many starts descend a little, their steps; how many go to the end, their steps.

    Returns
    -------
    cost, shape, rotation, position, matrix
        As `descend`; the cost less the odds.
    """
    width = 3.0 * math.hypot(noise, model)
    information = informed(noise, model, count)
    matrix, gradient = np.zeros((11, 11)), np.zeros(11)
    costs = np.empty(shapes.shape[0])
    for h in range(shapes.shape[0]):
        costs[h] = total(coarse, supports[h], priors[h], rotations[h], shapes[h], rotations[h],
                         positions[h], width, information / coarse.shape[0], matrix, gradient,
                         ) - odds[h]  # fmt: skip
    first = ascending_order(costs)[: finalists[0]]
    shapes_1, positions_1, rotations_1 = shapes.copy(), positions.copy(), rotations.copy()
    costs[:] = np.inf
    for h in first:
        cost, shapes_1[h], rotations_1[h], positions_1[h], _ = descend(
            coarse, supports[h], priors[h], rotations[h], shapes[h], rotations[h], positions[h],
            limits, width, information / coarse.shape[0], finalists[1])  # fmt: skip
        costs[h] = cost - odds[h]
    best, best_cost = -1, np.inf
    shape, rotation, position, best_matrix = shapes[0], rotations[0], positions[0], matrix
    for h in ascending_order(costs)[: finalists[2]]:
        cost, shape_2, rotation_2, position_2, matrix_2 = descend(
            points, supports[h], priors[h], rotations[h], shapes_1[h], rotations_1[h],
            positions_1[h], limits, width, information / points.shape[0], finalists[3])  # fmt: skip
        cost -= odds[h]
        if best < 0 or cost < best_cost:
            best, best_cost = h, cost
            shape, rotation, position, best_matrix = shape_2, rotation_2, position_2, matrix_2
    return best_cost, shape, rotation, position, best_matrix
