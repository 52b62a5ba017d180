"""How good a region is, against the labels of the object's pixels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

GOOD_IOU = 0.7
"""A region that overlaps the labelled one at least this much is good."""

Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class RegionScore:
    """A predicted region against the labelled one, over the points of the object.

    Attributes
    ----------
    accuracy : float
        Share of the points on which both agree.
    precision : float
        TP / (TP + FP): how much of what was predicted is right. The thesis's code
        computes this quantity under the name TPR.
    recall : float
        TP / (TP + FN), the true positive rate: how much of what is right was found.
    iou : float
        TP / (TP + FP + FN), intersection over union.
    """

    accuracy: float
    precision: float
    recall: float
    iou: float

    @property
    def good(self) -> bool:
        return self.iou >= GOOD_IOU


def score_region(truth: Mask, predicted: Mask) -> RegionScore:
    """Return the scores of two masks (N,) over the object's points; 0/0 counts as 0.

    Raises
    ------
    ValueError
        The object has no points, or the masks differ in length.
    """
    if truth.shape != predicted.shape or not truth.size:
        raise ValueError(f"cannot compare masks of shape {truth.shape} and {predicted.shape}")
    hit = int((truth & predicted).sum())
    return RegionScore(
        accuracy=float((truth == predicted).mean()),
        precision=hit / max(int(predicted.sum()), 1),
        recall=hit / max(int(truth.sum()), 1),
        iou=hit / max(int((truth | predicted).sum()), 1),
    )


def holds(position: NDArray[np.float64], points: NDArray[np.float64], truth: Mask) -> bool:
    """Say whether the object point (N, 3) nearest to a tool centre point (3,) is in the region.

    Points that are not finite (no return) are passed over.
    """
    seen = np.isfinite(points).all(axis=1)
    if not seen.any():
        return False
    return bool(truth[seen][cKDTree(points[seen]).query(position)[1]])


def overlap(one: Mask, other: Mask) -> float:
    """Return the intersection over union of two masks; 1 of two empty ones."""
    union = int((one | other).sum())
    return int((one & other).sum()) / union if union else 1.0
