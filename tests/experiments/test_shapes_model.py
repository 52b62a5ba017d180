"""The shipped model, its training, its calibration, and the methods beside it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from experiments.shapes.card import Tried, card
from experiments.shapes.criterion import CLASSES, names, perceived
from experiments.shapes.dataset import random_superquadrics, thesis_superquadrics
from experiments.shapes.figures import Calibration, Figures
from experiments.shapes.heuristic import heuristic_classes
from experiments.shapes.human import human_labels
from experiments.shapes.methods import METHODS, Method, by_rules, refitted, searched
from experiments.shapes.model import probabilities, trained, training_set
from services.primitive_recovery import classify
from shared.errors import InvalidInput, NotFound
from shared.superquadric import Superquadric


@pytest.fixture(scope="module")
def held_out() -> np.ndarray:
    return random_superquadrics(1500, np.random.default_rng(77))


def test_the_shipped_model_learned_the_criterion(held_out: np.ndarray) -> None:
    right = names(held_out)
    of_model = Figures.of(right, probabilities(held_out).argmax(axis=1))
    assert of_model.accuracy > 0.95
    assert of_model.f1 > 0.95
    assert Figures.of(right, heuristic_classes(held_out)).f1 < 0.7


def test_its_probabilities_mean_something(held_out: np.ndarray) -> None:
    said = names(perceived(held_out, np.random.default_rng(78)))
    calibration = Calibration.of(said, probabilities(held_out))
    assert calibration.error < 0.05
    assert calibration.stated.min() < 0.6


def test_the_service_says_what_the_experiment_measures(held_out: np.ndarray) -> None:
    assert classify.CLASSES == CLASSES
    bodies = [
        Superquadric((r[0], r[1]), (r[2], r[3], r[4]), (0, 0, 0), (0, 0, 0, 1))
        for r in held_out[:50]
    ]
    here = probabilities(held_out[:50])
    for (shape, probability), row in zip(
        classify.ShapeClassifier().classify(bodies), here, strict=True
    ):
        assert shape == CLASSES[row.argmax()]
        assert probability == pytest.approx(row.max(), abs=1e-5)


def test_exponents_out_of_range_count_as_the_nearest() -> None:
    inside = np.array([[0.1, 0.1, 0.03, 0.05, 0.1], [0.1, 1.0, 0.0005, 0.05, 0.05]])
    outside = np.array([[0.02, 0.05, 0.03, 0.05, 0.1], [0.01, 1.0, 1e-7, 0.05, 0.05]])
    np.testing.assert_allclose(probabilities(inside), probabilities(outside), atol=1e-6)


def test_training_is_reproducible_and_learns() -> None:
    def once() -> np.ndarray:
        parameters, said = training_set(1500, np.random.default_rng(5))
        model = trained(parameters, said, epochs=8)
        test = thesis_superquadrics(300, np.random.default_rng(6))
        return np.asarray(model.predict_proba(model_inputs(test)))

    from experiments.shapes.features import features as model_inputs

    first = once()
    np.testing.assert_array_equal(first, once())
    truth = names(thesis_superquadrics(300, np.random.default_rng(6)))
    assert (first.argmax(axis=1) == truth).mean() > 0.8


def test_methods_are_searched_over_the_grids_of_the_thesis() -> None:
    assert {each.name: each.candidates for each in METHODS} == {
        "random forest": 40,
        "SVM": 4 + 2 * 4 * 9,
        "MLP": 120,
    }
    for method in METHODS:
        assert any(
            all(method.thesis_best[key] in choices for key, choices in grid.items())
            for grid in method.grids
        )


def test_a_search_beats_the_rules_and_repeats_itself() -> None:
    rng = np.random.default_rng(3)
    train, test = ((x, names(x)) for x in (thesis_superquadrics(n, rng) for n in (300, 600)))
    svm = next(each for each in METHODS if each.name == "SVM")
    small = Method(svm.name, svm.estimator, ({"kernel": ("linear", "rbf"), "C": (1, 10)},), {})
    found = searched(small, train, test)
    assert found.best["kernel"] == "rbf"
    assert found.test.f1 > by_rules(train, test).test.f1 + 0.1
    again = refitted(small, found.best, train, test)
    assert again.test.accuracy == found.test.accuracy


def test_figures_of_a_known_confusion() -> None:
    right = np.array([0, 0, 0, 1, 1, 1, 1, 2])
    found = np.array([0, 0, 1, 1, 1, 1, 0, 2])
    figures = Figures.of(right, found)
    assert figures.accuracy == pytest.approx(6 / 8)
    assert figures.precision == pytest.approx((2 / 3 + 3 / 4 + 1) / 3)
    assert figures.recall == pytest.approx((2 / 3 + 3 / 4 + 1) / 3)
    assert figures.confusion.tolist() == [[2, 1, 0], [1, 3, 0], [0, 0, 1]]


def test_calibration_of_one_who_is_too_sure() -> None:
    stated = np.tile([0.9, 0.1, 0.0], (10, 1))
    right = np.array([0] * 6 + [1] * 4)
    assert Calibration.of(right, stated).error == pytest.approx(0.3)
    assert Calibration.of(np.array([0] * 9 + [1]), stated).error == pytest.approx(0, abs=1e-9)


def test_the_card_has_a_row_for_each() -> None:
    right = np.array([0, 1, 2, 1])
    tried = Tried("network", "human labels", right, right, np.eye(3)[right])
    text = card([tried], np.bincount(right, minlength=3))
    assert "| network | human labels | 4 | 1.000 | 1.000 | 1.000 | 1.000 | 0.000 |" in text
    assert "1 cuboids, 2 cylinders, 1 spheres" in text


def test_human_labels_are_read(tmp_path: Path) -> None:
    path = tmp_path / "labels.csv"
    path.write_text("e1,e2,a1,a2,a3,class\n0.1,0.1,0.05,0.05,0.1,0\n1,1,0.05,0.05,0.05,2\n")
    rows, said = human_labels(path)
    assert rows.shape == (2, 5)
    assert said.tolist() == [0, 2]


@pytest.mark.parametrize(
    "text",
    [
        "",
        "heading\n",
        "a,b\nx,y\n",
        "h\n0.1,0.1,0.05,0.05,0.1\n",
        "h\n0.1,0.1,0.05,0.05,0.1,3\n",
        "h\n0.1,0.1,0.05,0.05,0.1,0.5\n",
        "h\n0.1,nan,0.05,0.05,0.1,0\n",
        "h\n0.1,0.1,-0.05,0.05,0.1,0\n",
        "h\n2.5,0.1,0.05,0.05,0.1,0\n",
    ],
)
def test_other_tables_are_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "labels.csv"
    path.write_text(text)
    with pytest.raises(InvalidInput, match=r"labels\.csv"):
        human_labels(path)
    with pytest.raises(NotFound):
        human_labels(tmp_path / "none.csv")
    path.write_bytes(b"\xff\xfe\x00binary")
    with pytest.raises(InvalidInput):
        human_labels(path)
