"""The M step: weighted least squares on the radial distances, within bounds."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.ems.bounds import Bounds
from services.primitive_recovery.ems.state import State

Array = NDArray[np.float64]

STEPS = 2
"""Accepted steps per M step, as Liu et al. run it."""

_MAX_TRIES = 8
_MAX_TURN = 0.5


def maximize(
    points: Array, weights: Array, state: State, bounds: Bounds, steps: int = STEPS
) -> tuple[State, float]:
    """Lower sum_i w_i d_i^2 / sum_i w_i by projected Levenberg-Marquardt steps.

    Unknowns at a bound that the cost would push beyond it are held; the others
    move by a damped Gauss-Newton step, clipped to the bounds, and a step that
    does not lower the cost is damped more and tried again.

    Returns
    -------
    state : State
    cost : float
        Weighted mean of the squared distances.
    """
    state = state.moved(np.zeros(11), bounds.lower, bounds.upper)
    total = max(float(weights.sum()), 1e-12)
    cost, gradient, matrix = state.normal_equations(points, weights)
    damping = 1e-3
    for _ in range(steps):
        for _ in range(_MAX_TRIES):
            step = _damped_step(state, gradient, matrix, damping, bounds)
            trial = state.moved(step, bounds.lower, bounds.upper)
            trial_cost, trial_gradient, trial_matrix = trial.normal_equations(points, weights)
            if trial_cost < cost:
                break
            damping *= 8
        else:
            break
        state, cost, gradient, matrix = trial, trial_cost, trial_gradient, trial_matrix
        damping = max(damping / 8, 1e-9)
    return state, 2 * cost / total


def _damped_step(
    state: State, gradient: Array, matrix: Array, damping: float, bounds: Bounds
) -> Array:
    values = np.concatenate([state.shape, np.zeros(3), state.position])
    lower = np.concatenate([bounds.lower[:5], np.full(3, -np.inf), bounds.lower[5:]])
    upper = np.concatenate([bounds.upper[:5], np.full(3, np.inf), bounds.upper[5:]])
    held = ((values <= lower) & (gradient > 0)) | ((values >= upper) & (gradient < 0))
    free = np.flatnonzero(~held)
    step = np.zeros(11)
    if len(free) == 0:
        return step
    diagonal = np.diag(matrix)
    ridge = damping * diagonal + 1e-9 * max(float(diagonal.max()), 1e-12)
    system = matrix[np.ix_(free, free)] + np.diag(ridge[free])
    step[free] = np.linalg.solve(system, -gradient[free])
    turn = float(np.linalg.norm(step[5:8]))
    if turn > _MAX_TURN:
        step *= _MAX_TURN / turn
    return step
