"""How good a classification is: accuracy, macro means, calibration."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from sklearn.metrics import confusion_matrix, precision_recall_fscore_support

from experiments.shapes.criterion import CLASSES

Array = NDArray[np.float64]
Labels = NDArray[np.int64]

BINS = 15


@dataclass(frozen=True)
class Figures:
    """What Table A.2 has; precision, recall and F1 are unweighted means over the classes.

    Attributes
    ----------
    accuracy, precision, recall, f1 : float
        Within 0..1. A class that is never predicted has precision 0.
    confusion : array (3, 3) of int
        Rows: right class. Columns: found class.
    """

    accuracy: float
    precision: float
    recall: float
    f1: float
    confusion: Labels

    @classmethod
    def of(cls, right: Labels, found: Labels) -> Figures:
        """Compare classes (N,) with the right ones (N,)."""
        every = list(range(len(CLASSES)))
        precision, recall, f1, _ = precision_recall_fscore_support(
            right, found, average="macro", labels=every, zero_division=0.0
        )
        return cls(
            accuracy=float((right == found).mean()),
            precision=float(precision),
            recall=float(recall),
            f1=float(f1),
            confusion=confusion_matrix(right, found, labels=every),
        )


@dataclass(frozen=True)
class Calibration:
    """Stated probability against how often it is right, in bins of equal width.

    Attributes
    ----------
    stated, right, weight : array (B,)
        Of the bins that hold anything: mean probability of the class found, share
        where it is right, share of all samples.
    """

    stated: Array
    right: Array
    weight: Array

    @classmethod
    def of(cls, right: Labels, probabilities: Array) -> Calibration:
        """Compare probabilities (N, 3) with the right classes (N,)."""
        stated = probabilities.max(axis=1)
        hit = (probabilities.argmax(axis=1) == right).astype(np.float64)
        index = np.minimum((stated * BINS).astype(np.int64), BINS - 1)
        count = np.bincount(index, minlength=BINS)
        held = count > 0
        sums = [np.bincount(index, weights=each, minlength=BINS)[held] for each in (stated, hit)]
        return cls(sums[0] / count[held], sums[1] / count[held], count[held] / len(right))

    @property
    def error(self) -> float:
        """Expected calibration error (Guo et al. 2017, Eq. 3)."""
        return float((self.weight * np.abs(self.stated - self.right)).sum())
