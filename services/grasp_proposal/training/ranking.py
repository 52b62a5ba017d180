"""What grasps are ordered by: the networks' logits, less for the torque of the weight."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, minimize

from services.grasp_proposal.learned import sigmoid
from services.grasp_proposal.measures import torques
from services.grasp_proposal.training.calibration import Platt, fit_platt, logistic
from services.grasp_proposal.training.lessons import Lessons

Array = NDArray[np.float64]
Rows = NDArray[np.intp]


class Order(NamedTuple):
    """What the networks' logits are turned into.

    Attributes
    ----------
    per_nm : float
        How much a logit falls with each Nm of the weight's torque about the hand that is more
        than usual.
    usual : float
        The lever that is usual, as a share of the object's length.
    platt : Platt
        From there to the probability of lifting.
    """

    per_nm: float
    usual: float
    platt: Platt

    def __call__(self, logits: Array, numbers: NDArray[Any]) -> Array:
        """Return the probabilities (G,) of logits (G,) about grasps with numbers (G, M)."""
        torque, whole = torques(numbers).T
        return self.platt(logits - self.per_nm * (torque - self.usual * whole))


def fit_order(lessons: Lessons, logits: Array) -> Order:
    """Return what turns held-out logits (G,) into how often grasps lift.

    Only grasps that are where they were proposed count. The torque orders the grasps of one
    question. That of the whole length, which is the same for all of them, is what it is
    compared with, so that things that are merely heavy are not all given a low probability.
    """
    shown, logits = lessons.take(~lessons.moved), logits[~lessons.moved]
    torque, whole = torques(shown.numbers).T
    per_nm = fit_torque(logits, torque, shown.held, shown.view)
    usual = 0.0
    if per_nm > 0:
        known = np.column_stack([logits - per_nm * torque, whole])
        (slope, more), _ = logistic(known, shown.lifted)
        usual = max(more / (slope * per_nm), 0.0) if slope > 0 else 0.0
    platt = fit_platt(logits - per_nm * (torque - usual * whole), shown.lifted)
    return Order(per_nm, usual, platt)


def fit_torque(logits: Array, torque: Array, held: NDArray[np.bool_], view: Rows) -> float:
    """Return by how much a logit has to fall with each Nm of torque, at least 0.

    The networks see torques that random light objects have, and take too little from them.
    So the fall is what best tells, among the grasps of one question, those that kept the
    object from those that did not: a conditional logistic regression over such pairs, every
    question counted once (the Bradley-Terry model).

    Parameters
    ----------
    logits, torque : (G,) arrays
        By networks that never saw the objects; Nm.
    held : (G,) bool array
    view : (G,) int array
        Which question each grasp belongs to.

    Returns
    -------
    float
        0 where no question has both kinds of grasps.

    Raises
    ------
    ValueError
        Higher logits are no better.
    """
    known = np.column_stack([logits, -torque])
    weights = fit_pairs(known, held, view, Bounds([-np.inf, 0.0], [np.inf, np.inf]))
    if not weights.any():
        return 0.0
    if weights[0] <= 0:
        raise ValueError(f"higher logits are no better: slope {weights[0]:.3g}")
    return float(weights[1] / weights[0])


def fit_pairs(known: Array, good: NDArray[np.bool_], view: Rows, bounds: Bounds) -> Array:
    """Return weights (K,) of what is known (G, K) that best tell good grasps from bad ones.

    Within questions, `view` (G,), every one counted once; zeros where none has both kinds.
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
