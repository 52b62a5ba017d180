"""How good are scores? Ranking, calibration and the success of the best one per view."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.stats import rankdata

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

BINS = 10


def average_precision(scores: Array, happened: Mask) -> float:
    """Return the area under the precision-recall curve; equal scores share their precision."""
    if not happened.any():
        return float("nan")
    order = np.argsort(-scores, kind="stable")
    last = np.append(np.diff(scores[order]) != 0, True)
    found = np.cumsum(happened[order])[last]
    seen = np.arange(1, len(scores) + 1)[last]
    return float((found / seen * np.diff(found, prepend=0)).sum() / happened.sum())


def roc_auc(scores: Array, happened: Mask) -> float:
    """Return the chance that what happened scores higher than what did not; ties count half."""
    positive, negative = int(happened.sum()), int((~happened).sum())
    if not positive or not negative:
        return float("nan")
    ranks = rankdata(scores)
    return float((ranks[happened].sum() - positive * (positive + 1) / 2) / (positive * negative))


def calibration_error(probabilities: Array, happened: Mask) -> float:
    """Return the expected calibration error over ten bins of equal width (Guo et al. 2017)."""
    bins = np.minimum((probabilities * BINS).astype(np.intp), BINS - 1)
    error = 0.0
    for index in range(BINS):
        mine = bins == index
        if mine.any():
            error += mine.mean() * abs(probabilities[mine].mean() - happened[mine].mean())
    return float(error)


def best_per_view(scores: Array, view: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the row of the highest score of every view (the first of equals)."""
    order = np.lexsort((-scores, view))
    first = np.append(True, np.diff(view[order]) != 0)
    return np.asarray(order[first], dtype=np.intp)


def any_per_view(happened: Mask, view: NDArray[np.intp]) -> Mask:
    """Return for every view, in order, whether one of its rows happened."""
    return np.array([happened[view == each].any() for each in np.unique(view)])


def by_kind(
    kind: NDArray[np.str_], view: NDArray[np.intp], scores: Mapping[str, Array], happened: Mask
) -> dict[str, dict[str, float]]:
    """Return for each kind of object how many views it has and in which share of them it happened.

    To the grasp with the highest of each score, and to `any`.
    """
    found = {}
    for each in np.unique(kind):
        mine = kind == each
        seen, came = view[mine], happened[mine]
        shares = {
            name: float(came[best_per_view(score[mine], seen)].mean())
            for name, score in scores.items()
        }
        anything = any_per_view(came, seen)
        found[str(each)] = {"views": len(anything), **shares, "any": float(anything.mean())}
    return found
