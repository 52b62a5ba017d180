"""What is said about scores on objects that their network never saw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sklearn.ensemble import HistGradientBoostingClassifier

from services.grasp_proposal.training.calibration import Platt, fit_platt
from services.grasp_proposal.training.figures import (
    any_per_view,
    average_precision,
    best_per_view,
    by_kind,
    calibration_error,
    roc_auc,
)
from services.grasp_proposal.training.lessons import Lessons, objects_of
from services.grasp_proposal.training.network import HEADS, Network, train_network

Array = NDArray[np.float64]
Fold = NDArray[np.intp]


@dataclass(frozen=True)
class HeldOut:
    """Scores of grasps (G,), each by a model that never saw the object.

    Attributes
    ----------
    logits : (G,) array
        Of the networks, by `combined`.
    probabilities : (G,) array
        Calibrated on the other folds.
    boosted : (G,) array
        Of gradient boosting on the numbers alone.
    """

    logits: Array
    probabilities: Array
    boosted: Array


def folds_of(lessons: Lessons, folds: int) -> Fold:
    """Return the fold (G,) of every lesson: all grasps of an object are in one."""
    numbers = np.unique(objects_of(lessons), return_inverse=True)[1]
    return np.asarray(numbers % folds, dtype=np.intp)


def held_out(lessons: Lessons, folds: int, epochs: int, networks: int, seed: int) -> HeldOut:
    """Return the scores of every lesson by as many networks as are shipped, without its fold."""
    fold = folds_of(lessons, folds)
    logits, boosted = np.zeros(len(lessons)), np.zeros(len(lessons))
    for index in range(folds):
        other, mine = lessons.take(fold != index), lessons.take(fold == index)
        if not len(mine):
            continue
        logits[fold == index] = combined(ensemble(other, epochs, networks, seed), mine)
        boosted[fold == index] = _boosted(other, mine, seed)
    probabilities = np.zeros(len(lessons))
    for index in range(folds):
        mine = fold == index
        probabilities[mine] = calibrated(lessons.take(~mine), logits[~mine])(logits[mine])
    return HeldOut(logits, probabilities, boosted)


def ensemble(lessons: Lessons, epochs: int, networks: int, seed: int) -> list[Network]:
    """Return networks that differ in their seeds."""
    return [train_network(lessons, epochs, seed + index) for index in range(networks)]


def combined(networks: Sequence[Network], lessons: Lessons) -> Array:
    """Return the networks' mean log odds (G,) of lifting and keeping, weighted by `HEADS`."""
    return np.asarray(np.mean([each.logits(lessons) @ HEADS for each in networks], axis=0))


def calibrated(lessons: Lessons, logits: Array) -> Platt:
    """Return what turns held-out logits (G,) into how often grasps lift.

    Only grasps that are where they were proposed count.
    """
    return fit_platt(logits[~lessons.moved], lessons.lifted[~lessons.moved])


def report(lessons: Lessons, found: HeldOut) -> dict[str, Any]:
    """Return the figures of the network, of boosting and of the geometric score.

    Over grasps as they were proposed; the moved ones only taught.
    """
    rows = ~lessons.moved
    shown = lessons.take(rows)
    scores = {
        "network": found.probabilities[rows],
        "boosting": found.boosted[rows],
        "geometric": shown.geometric,
    }
    by_score = {name: _figures(each, shown) for name, each in scores.items()}
    oracle = {
        name: float(any_per_view(happened, shown.view).mean())
        for name, happened in _labels(shown).items()
    }
    return {
        "grasps": len(shown),
        "views": len(np.unique(shown.view)),
        "calibration_error": calibration_error(scores["network"], shown.lifted),
        "scores": by_score,
        "chance": {name: float(each.mean()) for name, each in _labels(shown).items()},
        "oracle": oracle,
        "kinds": by_kind(shown.object_class, shown.view, scores, shown.held),
    }


def _labels(lessons: Lessons) -> dict[str, NDArray[np.bool_]]:
    return {"lifted": lessons.lifted, "held": lessons.held}


def _figures(scores: Array, lessons: Lessons) -> dict[str, dict[str, float]]:
    best = best_per_view(scores, lessons.view)
    return {
        name: {
            "ap": average_precision(scores, happened),
            "auc": roc_auc(scores, happened),
            "top1": float(happened[best].mean()),
        }
        for name, happened in _labels(lessons).items()
    }


def _boosted(other: Lessons, mine: Lessons, seed: int) -> Array:
    total = np.zeros(len(mine))
    for happened in _labels(other).values():
        if happened.all() or not happened.any():
            continue
        model = HistGradientBoostingClassifier(
            max_iter=120, learning_rate=0.06, max_leaf_nodes=12, l2_regularization=1.0,
            random_state=seed,
        )  # fmt: skip
        total += model.fit(other.numbers, happened).predict_proba(mine.numbers)[:, 1] / 2
    return total
