"""The model card: data, command, figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from sklearn.metrics import confusion_matrix, precision_recall_fscore_support

from experiments.shape_classifier.labels import CLASSES

Labels = NDArray[np.int64]

_HEAD = """# Shape classifier

`shape_classifier.onnx` names a superquadric cuboid, cylinder or sphere. Input
`parameters` (N, 5) float32: e1, e2 and the semi-axes a1, a2, a3 in any unit. Outputs
`label` (N,) and `probabilities` (N, 3) in the order cuboid, cylinder, sphere. Inside:
sizes relative to the largest, a1 and a2 in order, then the network of the thesis'
A.1.2: a perceptron of 50, 100, 50 ReLU units, trained by SGD with alpha 1e-4 and an
adaptive rate.

Made by `python -m experiments.shape_classifier.train` (extra `train`), seed 0.

## Data

{total} random superquadrics: {counts}.
Exponents in 0.1..2, sizes up to 0.15 m; three quarters for training. Nobody labelled them
by hand: each carries the name of the ideal body (box, elliptic cylinder along any axis,
ball) whose best-scaled copy overlaps it most, by intersection over union; see
`experiments/shape_classifier/labels.py`.
{outside}
## Figures

Precision, recall and F1 are macro means over the three classes. Eq. A.4-A.6 are the
thesis' hand-made rules. For comparison: the thesis reports accuracy 0.94 and F1 0.93 for
its network, on a held-out quarter of its own hand-labelled set.

| method | set | samples | accuracy | precision | recall | F1 |
| --- | --- | --- | --- | --- | --- | --- |
"""

_OUTSIDE = """
`outside` is the set of 550 superquadrics that the thesis' author labelled by eye. It is
no part of this project and nothing was fitted to it; `--outside FILE` adds its rows.
"""

_FOOT = """
Where it fails: between cuboid and cylinder for exponents about 0.5, where rounded boxes
and squarish cylinders meet, and for bodies that are like neither of the three (e1 near 2:
double cones and pyramids), which get the least bad name. The probability says how sure the
network is of that name, not that the name fits.
"""


@dataclass(frozen=True)
class Row:
    """Predictions of one method on one set."""

    method: str
    name: str
    truth: Labels
    predicted: Labels

    def figures(self) -> str:
        """Return a row of the card's table."""
        precision, recall, f1, _ = precision_recall_fscore_support(
            self.truth, self.predicted, average="macro", labels=[0, 1, 2], zero_division=0.0
        )
        accuracy = float((self.truth == self.predicted).mean())
        return (
            f"| {self.method} | {self.name} | {len(self.truth)} | {accuracy:.3f} "
            f"| {precision:.3f} | {recall:.3f} | {f1:.3f} |"
        )

    def confusion(self) -> str:
        """Return the confusion matrix as a table, true classes in rows."""
        matrix = confusion_matrix(self.truth, self.predicted, labels=[0, 1, 2])
        lines = [f"| {self.method}, {self.name} | {' | '.join(CLASSES)} |", "| --- " * 4 + "|"]
        lines += [
            f"| {name} | {' | '.join(map(str, counts))} |"
            for name, counts in zip(CLASSES, matrix, strict=True)
        ]
        return "\n".join(lines)


def card(rows: Sequence[Row], counts: Labels) -> str:
    """Return the model card in Markdown."""
    shares = ", ".join(f"{count} {name}s" for name, count in zip(CLASSES, counts, strict=True))
    outside = _OUTSIDE if any(row.name == "outside" for row in rows) else ""
    text = _HEAD.format(total=int(counts.sum()), counts=shares, outside=outside)
    text += "\n".join(row.figures() for row in rows) + "\n"
    text += "\nConfusion, true classes in rows:\n"
    for row in rows:
        if row.method == "MLP" and row.name != "training":
            text += "\n" + row.confusion() + "\n"
    return text + _FOOT
