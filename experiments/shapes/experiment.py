"""Experiment A.1.2 of the thesis: which classifier names primitive shapes best."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np

from experiments.framework import Context, Experiment, Findings, Plot
from experiments.shapes.criterion import names, perceived
from experiments.shapes.dataset import random_superquadrics, thesis_superquadrics
from experiments.shapes.drawings import borders, confusions, reliability
from experiments.shapes.figures import Calibration, Figures
from experiments.shapes.heuristic import heuristic_classes
from experiments.shapes.human import human_labels
from experiments.shapes.methods import (
    FOLDS,
    METHODS,
    Result,
    Split,
    by_rules,
    refitted,
    searched,
)
from experiments.shapes.model import probabilities
from experiments.shapes.tables import (
    GOAL_F1,
    calibration_table,
    human_table,
    parameter_table,
    table_a_2,
)
from experiments.shapes.thesis import TRAIN

FEW_FOLDS = 2
"""Where nothing is chosen by them."""
TEST = 4000
MORE = 10
"""Times as many training samples, for the winners once more."""


def shapes(human: Path | None = None) -> Experiment:
    """Return the experiment; `human` is a file for `human_labels`, a further test."""
    return Experiment(
        name="shapes",
        title="Naming primitive shapes",
        question="Which classifier names superquadrics cuboid, cylinder or sphere best?",
        thesis="A.1.2, Table A.2, Figure A.3",
        run=partial(run, human=human),
        views_per_object=None,
    )


def run(context: Context, human: Path | None = None) -> Findings:
    """Search the grids, compare with Table A.2, test the shipped model.

    With `context.limit` it is a slice: the thesis's own hyper-parameters, tried on two
    folds, instead of a search, and a tenth of the samples beside those of the thesis.

    Raises
    ------
    NotFound, InvalidInput
        See `human_labels`.
    """
    people = human_labels(human) if human else None
    rng = np.random.default_rng(context.seed)
    tested, times = (TEST, MORE) if context.limit is None else (TEST // 10, 2)
    train, more, test = (_named(count, rng) for count in (TRAIN, times * TRAIN, tested))
    results, larger = _compared(context, train, more, test)
    shipped = Figures.of(test[1], probabilities(test[0]).argmax(axis=1))
    calibrations = _calibrations(tested, rng)
    matrices = {each.method: each.test.confusion for each in results}
    matrices["shipped model"] = shipped.confusion
    tables = [table_a_2(results, larger, shipped, TRAIN), parameter_table(results)]
    meaning = _ranking(results, shipped)
    if people:
        rows, said = people
        stated = probabilities(rows)
        found = Figures.of(said, stated.argmax(axis=1))
        methods = {
            "shipped model": found,
            "criterion": Figures.of(said, names(rows)),
            "Eq. A.4-A.6": Figures.of(said, heuristic_classes(rows)),
        }
        tables.append(human_table(methods))
        calibrations["human labels"] = Calibration.of(said, stated)
        matrices["shipped model, human labels"] = found.confusion
        meaning = f"{human_line(found)}\n{meaning}"
    tables.append(calibration_table(calibrations))
    return Findings(
        meaning,
        tuple(tables),
        (
            Plot(
                "confusion",
                f"Confusion on {tested} held-out superquadrics; shares are of a row.",
                confusions(matrices),
            ),
            Plot(
                "reliability",
                "How often the shipped model is right, by how sure it is.",
                reliability(calibrations),
            ),
            Plot(
                "borders",
                "Which name goes with which exponents, for three sets of sizes.",
                borders(48 if context.limit is None else 12),
            ),
        ),
    )


def human_line(found: Figures) -> str:
    """Return `human labels: F1 ...` of the shipped model."""
    return (
        f"human labels: F1 {found.f1:.3f}, accuracy {found.accuracy:.3f} "
        f"(shipped model, {int(found.confusion.sum())} superquadrics; goal {GOAL_F1})"
    )


def _named(count: int, rng: np.random.Generator) -> Split:
    parameters = thesis_superquadrics(count, rng)
    return parameters, names(parameters)


def _compared(
    context: Context, train: Split, more: Split, test: Split
) -> tuple[list[Result], list[Result]]:
    """Return all methods, and those that learn with more samples once more."""
    results, larger = [by_rules(train, test)], []
    for method in METHODS:
        with context.console.status(f"{method.name}: {method.candidates} candidates"):
            found = searched(
                method,
                train,
                test,
                seed=context.seed,
                workers=context.workers,
                grid=context.limit is None,
                folds=FOLDS if context.limit is None else FEW_FOLDS,
            )
            results.append(found)
            larger.append(refitted(method, found.best, more, test, seed=context.seed))
    return results, larger


def _calibrations(count: int, rng: np.random.Generator) -> dict[str, Calibration]:
    """Return how well the shipped model knows what a viewer would say."""
    held = {}
    for name, draw in (("all kinds", random_superquadrics), ("as in A.1.2", thesis_superquadrics)):
        parameters = draw(count, rng)
        said = names(perceived(parameters, rng))
        held[name] = Calibration.of(said, probabilities(parameters))
    return held


def _ranking(results: list[Result], shipped: Figures) -> str:
    order = sorted(results, key=lambda each: -each.test.f1)
    listed = ", ".join(f"{each.method} {each.test.f1:.2f}" for each in order)
    return (
        f"By F1 on held-out superquadrics: {listed}; the thesis has the MLP first and the "
        f"hand-made rules last. The shipped model, the thesis's MLP with more data, "
        f"has {shipped.f1:.2f}."
    )


SHAPES = shapes()
