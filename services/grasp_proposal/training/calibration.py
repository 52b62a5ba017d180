"""From logits to probabilities (Platt 1999)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from services.grasp_proposal.learned import sigmoid

Array = NDArray[np.float64]


class Platt(NamedTuple):
    """Probability = sigmoid(slope * logit + shift)."""

    slope: float
    shift: float

    def __call__(self, logits: Array) -> Array:
        """Return probabilities (G,) of logits (G,)."""
        return sigmoid(self.slope * logits + self.shift)


def fit_platt(logits: Array, happened: NDArray[np.bool_]) -> Platt:
    """Return the map of logits (G,) that makes what happened (G,) most likely.

    The targets are Platt's, so that few samples do not make it certain.

    Raises
    ------
    ValueError
        Higher logits are no more likely, so that no map keeps their order.
    """
    positive = int(happened.sum())
    negative = len(happened) - positive
    target = np.where(happened, (positive + 1) / (positive + 2), 1 / (negative + 2))
    design = np.column_stack([logits, np.ones(len(logits))])
    start = np.array([0.0, np.log(target.mean() / (1 - target.mean()))])
    slope, shift = minimize(_loss, start, args=(design, target), jac=True, method="BFGS").x
    if slope <= 0:
        raise ValueError(f"higher logits are no more likely: slope {slope:.3g}")
    return Platt(float(slope), float(shift))


def _loss(weights: Array, design: Array, target: Array) -> tuple[float, Array]:
    """Return the mean cross entropy and its gradient (2,)."""
    logits = design @ weights
    loss = np.logaddexp(0.0, logits) - target * logits
    return float(loss.mean()), design.T @ (sigmoid(logits) - target) / len(target)
