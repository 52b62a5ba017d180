"""The S step: other parameters with a similar shape, against local optima."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from services.primitive_recovery.ems.bounds import LEAST_EXPONENT, Bounds
from services.primitive_recovery.ems.kernels import turned
from services.primitive_recovery.ems.maximization import maximize
from services.primitive_recovery.ems.state import State

Array = NDArray[np.float64]

_DUAL_RATIOS = (0.6, 1.4)


def similar_states(state: State) -> list[State]:
    """Return the similar superquadrics of Liu et al. 2022, S step.

    Two axis permutations: the superquadric's z is made its x or its y, with e1
    and e2 exchanged. And the duals of it and of both: where the two semi-axes of
    the cross-section are alike (ratio 0.6 to 1.4), e2 becomes 2 - e2 and the frame
    turns by 45 degrees about z; a square is a rhombus that is turned.
    """
    permuted = [_permuted(state, order) for order in ((1, 2, 0), (2, 0, 1))]
    duals = [_dual(one) for one in (state, *permuted)]
    return permuted + [dual for dual in duals if dual is not None]


def switch(
    points: Array, weights: Array, state: State, cost: float, bounds: Bounds
) -> tuple[State, float] | None:
    """Return the first similar state, refined, whose cost is lower; None if there is none.

    They are tried in the order of their cost before refinement.
    """
    total = max(float(weights.sum()), 1e-12)
    similar = similar_states(state)
    costs = [float((weights * one.distances(points) ** 2).sum()) / total for one in similar]
    for index in np.argsort(costs, kind="stable"):
        refined, refined_cost = maximize(points, weights, similar[index], bounds)
        if refined_cost < cost:
            return refined, refined_cost
    return None


def _permuted(state: State, order: tuple[int, int, int]) -> State:
    axes = list(order)
    e1, e2 = state.shape[:2]
    return State(
        np.concatenate([[e2, e1], state.shape[2:][axes]]),
        np.ascontiguousarray(state.rotation[:, axes]),
        state.position,
    )


def _dual(state: State) -> State | None:
    e1, e2, a1, a2, a3 = state.shape
    if not _DUAL_RATIOS[0] < a1 / a2 < _DUAL_RATIOS[1]:
        return None
    # Radius of the cross-section at 45 degrees: where the dual's corner or crease lies.
    diagonal = np.sqrt(a1 * a2) * 2 ** ((1 - e2) / 2)
    return State(
        np.array([e1, max(2 - e2, LEAST_EXPONENT), diagonal, diagonal, a3]),
        turned(state.rotation, np.array([0.0, 0.0, np.pi / 4])),
        state.position,
    )
