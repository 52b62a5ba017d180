"""What best tells the good grasps of a question from its bad ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, minimize

from services.grasp_proposal.learned import sigmoid

Array = NDArray[np.float64]
Rows = NDArray[np.intp]


def fit_pairs(known: Array, good: NDArray[np.bool_], view: Rows, bounds: Bounds) -> Array:
    """Return weights (K,) of what is known (G, K) that best tell good grasps from bad ones.

    A conditional logistic regression over pairs of one question, `view` (G,), every question
    counted once (the Bradley-Terry model); zeros where none has both kinds.
    """
    better, worse, share = pairs(good, view)
    if not len(better):
        return np.zeros(known.shape[1])
    difference = known[better] - known[worse]

    def loss(weights: Array) -> tuple[float, Array]:
        margin = difference @ weights
        wrong = share * sigmoid(-margin)
        return float(share @ np.logaddexp(0, -margin)), -difference.T @ wrong

    start = np.eye(known.shape[1])[0]
    return np.asarray(minimize(loss, start, jac=True, method="L-BFGS-B", bounds=bounds).x)


def pairs(held: NDArray[np.bool_], view: Rows) -> tuple[Rows, Rows, Array]:
    """Return rows (P,) of what kept, of what lost in the same question, and each pair's share."""
    kept, lost, share = [], [], []
    for each in np.unique(view):
        mine = np.flatnonzero(view == each)
        good, bad = mine[held[mine]], mine[~held[mine]]
        number = len(good) * len(bad)
        kept.append(np.repeat(good, len(bad)))
        lost.append(np.tile(bad, len(good)))
        share.append(np.full(number, 1 / max(number, 1)))
    shares = np.concatenate(share)
    return np.concatenate(kept), np.concatenate(lost), shares / max(shares.sum(), 1e-12)
