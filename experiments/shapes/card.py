"""The model card: data, command, figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from experiments.shapes.criterion import ALIKE, CLASSES, PERCEPTION, ROD
from experiments.shapes.figures import BINS, Calibration, Figures

Array = NDArray[np.float64]
Labels = NDArray[np.int64]

_HEAD = """# Shape classifier

`shape_classifier.onnx` names a superquadric cuboid, cylinder or sphere. Input
`parameters` (N, 5) float32: e1, e2 and the semi-axes a1, a2, a3 in any unit. Outputs
`label` (N,) and `probabilities` (N, 3) in the order cuboid, cylinder, sphere. Inside:
exponents, logarithms of the sizes relative to the largest with a1 and a2 in order, then
the network of the thesis' A.1.2: a perceptron of 50, 100, 50 ReLU units, trained by SGD
with alpha 1e-4 and an adaptive rate.

Made by `python -m experiments.shapes.train` (extra `train`), seed 0; the same bytes every
time on the same machine.

## Data

{total} random superquadrics for training: {counts}.
Exponents in 0.1..2, sizes up to 0.15 m. Nobody labelled them by hand. The criterion
(`experiments/shapes/criterion.py`): each has the name of the ideal body whose best-scaled
copy overlaps it most, by intersection over union; a box (upright or turned by 45 degrees),
an elliptic cylinder about z, one about x or y if it looks round along that axis and is
{rod:g} times as long as thick or more, a ball if no axis is over {alike:.2f} times another.
A training name is that of the body as a viewer sees it: exponents and logarithms of sizes
off by a normal error of {spread:g}. So a probability of 0.8 means: of viewers who judge no
better than that, 8 in 10 would say so.
{human}
## Figures

Held out: 10000 superquadrics each of the kinds trained on, and of the thesis' population
(A.1.2: exponents and sizes uniform). `criterion`: the criterion's own name; `viewer`: as
seen with the error above. Precision, recall and F1 are macro means over the three classes.
ECE: expected calibration error, {bins} bins. Eq. A.4-A.6 are the thesis' hand-made rules.
For comparison: the thesis reports accuracy 0.94 and F1 0.93 for its network, on a held-out
quarter of its own hand-labelled set, after training on the rest of it.

| method | set, labels | samples | accuracy | precision | recall | F1 | ECE |
| --- | --- | --- | --- | --- | --- | --- | --- |
"""

_HUMAN = """
`human labels` is the set of 550 superquadrics (533 different ones) that the thesis' author
labelled by eye; `--human-labels FILE` adds its rows. It is no part of this project and
nothing was trained on it, but it is not untouched: a random half of it was looked at when
the criterion was chosen (docs/decisions/0011-shapes.md has the figures of the other half).
"""

_FOOT = """
Where it fails: between cuboid and cylinder for exponents about 0.5, where rounded boxes
and squarish cylinders meet, and for bodies that are like neither of the three (e1 near 2:
double cones and pyramids), which get the least bad name. The probability says how sure the
network is of that name, not that the name fits.
"""


@dataclass(frozen=True)
class Tried:
    """Classes that one method found on one set, beside the right ones."""

    method: str
    name: str
    right: Labels
    found: Labels
    probabilities: Array | None = None

    def line(self) -> str:
        """Return a row of the card's table."""
        of = Figures.of(self.right, self.found)
        error = "–"
        if self.probabilities is not None:
            error = f"{Calibration.of(self.right, self.probabilities).error:.3f}"
        return (
            f"| {self.method} | {self.name} | {len(self.right)} | {of.accuracy:.3f} "
            f"| {of.precision:.3f} | {of.recall:.3f} | {of.f1:.3f} | {error} |"
        )

    def confusion(self) -> str:
        """Return the confusion matrix as a table, right classes in rows."""
        matrix = Figures.of(self.right, self.found).confusion
        lines = [f"| {self.method}, {self.name} | {' | '.join(CLASSES)} |", "| --- " * 4 + "|"]
        lines += [
            f"| {name} | {' | '.join(map(str, counts))} |"
            for name, counts in zip(CLASSES, matrix, strict=True)
        ]
        return "\n".join(lines)


def card(tried: Sequence[Tried], counts: Labels) -> str:
    """Return the model card in Markdown."""
    shares = ", ".join(f"{count} {name}s" for name, count in zip(CLASSES, counts, strict=True))
    human = any(each.name == "human labels" for each in tried)
    text = _HEAD.format(
        total=int(counts.sum()),
        counts=shares,
        human=_HUMAN if human else "",
        rod=ROD,
        alike=ALIKE,
        spread=PERCEPTION,
        bins=BINS,
    )
    text += "\n".join(each.line() for each in tried) + "\n"
    text += "\nConfusion, right classes in rows:\n"
    for each in tried:
        if each.method == "network" and not each.name.endswith("viewer"):
            text += "\n" + each.confusion() + "\n"
    return text + _FOOT
