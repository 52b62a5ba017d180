"""Tables of the experiment."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from experiments.framework import Table
from experiments.framework.cells import Cell
from experiments.shapes.figures import BINS, Calibration, Figures
from experiments.shapes.methods import METHODS, Result
from experiments.shapes.thesis import TABLE_A_2

KINDS = ("accuracy", "precision", "recall", "F1")
GOAL_F1, GOAL_ECE = 0.93, 0.05


def cells(figures: Figures) -> tuple[float, float, float, float]:
    """Return the figures in the order of KINDS."""
    return figures.accuracy, figures.precision, figures.recall, figures.f1


def table_a_2(
    results: Sequence[Result], larger: Sequence[Result], shipped: Figures, samples: int
) -> Table:
    """Return Table A.2, the thesis's figures beside ours.

    Parameters
    ----------
    results, larger : sequence of Result
        All methods, and those that learn once more with more training samples.
    shipped : Figures
        Of the shipped model on the same test.
    samples : int
        That the hyper-parameters were searched on.
    """
    rows: list[tuple[Cell, ...]] = []
    for each in (*results, *larger):
        theirs = TABLE_A_2[each.method] if each in results else (None,) * 5
        rows.append(
            (each.method, each.samples, each.train.accuracy, *cells(each.test), *theirs),
        )
    rows.append(("shipped model", None, None, *cells(shipped), *(None,) * 5))
    names = ("train accuracy", "test accuracy", *KINDS[1:])
    tested = int(shipped.confusion.sum())
    return Table(
        "table-a-2",
        "Table A.2: naming primitive shapes",
        ("method", "training samples", *names, *(f"thesis {name}" for name in names)),
        tuple(rows),
        note=(
            "Ours: superquadrics drawn as in A.1.2, named by the stated geometric criterion, "
            f"{tested} held out. Thesis: 550 superquadrics labelled by hand, 138 held out. As the "
            "labels differ, only the order of the methods compares. Precision, recall and F1 are "
            f"macro means. Hyper-parameters: grid search, 5 folds, on {samples} samples; the "
            "winners once more with more samples."
        ),
    )


def parameter_table(results: Sequence[Result]) -> Table:
    """Return the hyper-parameters that won, beside the thesis's."""
    best = {each.name: each.thesis_best for each in METHODS}
    return Table(
        "hyper-parameters",
        "Hyper-parameters that won",
        ("method", "ours", "thesis found", "accuracy over 5 folds", "seconds"),
        tuple(
            (
                each.method,
                _written(each.best),
                _written(best[each.method]),
                each.validation,
                each.seconds,
            )
            for each in results
            if each.best
        ),
        note="The thesis's max_features 'auto' is what scikit-learn calls 'sqrt' now.",
    )


def _written(parameters: Mapping[str, Any]) -> str:
    return ", ".join(f"{name} {value}" for name, value in sorted(parameters.items()))


def human_table(methods: Mapping[str, Figures]) -> Table:
    """Return how methods do against labels by people."""
    return Table(
        "human-labels",
        "Against human labels",
        ("method", "samples", *KINDS),
        tuple(
            (name, int(figures.confusion.sum()), *cells(figures))
            for name, figures in methods.items()
        ),
        note="No network was trained on these labels.",
    )


def calibration_table(sets: Mapping[str, Calibration]) -> Table:
    """Return how much the shipped model's probabilities are worth."""
    return Table(
        "calibration",
        "Does the shipped model's probability mean something",
        ("set", "mean stated probability", "share that is right", "ECE", "goal"),
        tuple(
            (
                name,
                float((held.weight * held.stated).sum()),
                float((held.weight * held.right).sum()),
                held.error,
                GOAL_ECE,
            )
            for name, held in sets.items()
        ),
        note=(
            f"ECE: expected calibration error, {BINS} bins, of the class found. Right is what "
            "a viewer says who sees exponents and sizes a little off (experiments/shapes/"
            "criterion.py), or what people said."
        ),
    )
