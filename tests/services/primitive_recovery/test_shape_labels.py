"""The labels that the classifier learned from, and that it did learn them."""

from __future__ import annotations

import numpy as np
import pytest

from experiments.shape_classifier.dataset import random_superquadrics
from experiments.shape_classifier.heuristic import heuristic_classes
from experiments.shape_classifier.labels import CLASSES, class_overlaps, label
from services.primitive_recovery import classify
from tests.services.primitive_recovery.clouds import superquadric


@pytest.mark.parametrize(
    ("expected", "parameters"),
    [
        ("cuboid", (0.1, 0.1, 0.03, 0.05, 0.1)),
        ("cuboid", (0.1, 2.0, 0.05, 0.05, 0.1)),
        ("cylinder", (0.1, 1.0, 0.03, 0.05, 0.1)),
        ("cylinder", (1.0, 0.1, 0.1, 0.03, 0.03)),
        ("cylinder", (1.0, 1.0, 0.02, 0.02, 0.1)),
        ("sphere", (1.0, 1.0, 0.05, 0.05, 0.06)),
    ],
)
def test_ideal_bodies_have_their_names(expected: str, parameters: tuple[float, ...]) -> None:
    assert CLASSES[label(np.array(parameters))] == expected


def test_an_ideal_body_overlaps_itself() -> None:
    assert class_overlaps(np.array([0.1, 0.1, 0.3, 0.2, 0.1]))[0] > 0.95
    assert class_overlaps(np.array([0.1, 1.0, 0.3, 0.2, 0.1]))[1] > 0.95
    assert class_overlaps(np.array([1.0, 1.0, 0.2, 0.2, 0.2]))[2] > 0.95


def test_a_rhombus_column_is_less_of_a_box_than_a_square_one() -> None:
    square = class_overlaps(np.array([0.1, 2.0, 0.1, 0.1, 0.1]))
    rhombus = class_overlaps(np.array([0.1, 2.0, 0.1, 0.04, 0.1]))
    assert rhombus[0] < square[0] - 0.1


def test_equal_bodies_have_equal_overlaps(rng: np.random.Generator) -> None:
    for e1, e2, a1, a2, a3 in random_superquadrics(5, rng):
        here = class_overlaps(np.array([e1, e2, a1, a2, a3]))
        np.testing.assert_allclose(class_overlaps(np.array([e1, e2, a2, a1, a3])), here, rtol=1e-9)
        larger = class_overlaps(7 * np.array([e1 / 7, e2 / 7, a1, a2, a3]))
        np.testing.assert_allclose(larger, here, rtol=1e-9)


def test_the_network_that_ships_learned_the_labels() -> None:
    assert classify.CLASSES == CLASSES
    parameters = random_superquadrics(200, np.random.default_rng(77))
    truth = [CLASSES[label(row)] for row in parameters]
    bodies = [superquadric((r[0], r[1]), (r[2], r[3], r[4])) for r in parameters]
    found = [name for name, _ in classify.ShapeClassifier().classify(bodies)]
    assert np.mean([a == b for a, b in zip(found, truth, strict=True)]) > 0.94
    rules = [CLASSES[k] for k in heuristic_classes(parameters)]
    assert np.mean([a == b for a, b in zip(rules, truth, strict=True)]) < 0.9
