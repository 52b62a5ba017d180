from __future__ import annotations

import numpy as np
import pytest
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import average_precision_score, roc_auc_score

from services.grasp_proposal.measures import NAMES, TORQUES_OF
from services.grasp_proposal.training.calibration import fit_platt
from services.grasp_proposal.training.figures import (
    any_per_view,
    average_precision,
    best_per_view,
    calibration_error,
    roc_auc,
)
from services.grasp_proposal.training.lessons import Lessons
from services.grasp_proposal.training.order import fit_order, fit_torque

RNG = np.random.default_rng(5)
SCORES = np.round(RNG.normal(size=400), 1)  # with ties
HAPPENED = RNG.random(400) < 1 / (1 + np.exp(-2 * SCORES))


def test_ranking_figures_are_those_of_scikit_learn() -> None:
    assert roc_auc(SCORES, HAPPENED) == pytest.approx(roc_auc_score(HAPPENED, SCORES))
    assert average_precision(SCORES, HAPPENED) == pytest.approx(
        average_precision_score(HAPPENED, SCORES)
    )


def test_ranking_figures_need_both_outcomes() -> None:
    assert np.isnan(roc_auc(SCORES, np.ones(400, dtype=bool)))
    assert np.isnan(average_precision(SCORES, np.zeros(400, dtype=bool)))


def test_platt_is_logistic_regression_with_softer_targets() -> None:
    platt = fit_platt(SCORES, HAPPENED)
    plain = LogisticRegression(C=1e9).fit(SCORES[:, None], HAPPENED)
    assert platt.slope == pytest.approx(plain.coef_[0, 0], rel=0.05)
    assert platt.shift == pytest.approx(plain.intercept_[0], abs=0.05)
    assert calibration_error(platt(SCORES), HAPPENED) < 0.06


def test_platt_keeps_the_order_strictly() -> None:
    logits = np.linspace(-12, 12, 200)
    assert (np.diff(fit_platt(SCORES, HAPPENED)(logits)) > 0).all()
    with pytest.raises(ValueError, match="no more likely"):
        fit_platt(-SCORES, HAPPENED)


def test_platt_stays_finite_where_the_outcomes_are_separate() -> None:
    logits = np.array([-2.0, -1.0, 1.0, 2.0])
    platt = fit_platt(logits, logits > 0)
    assert 0 < platt(logits)[0] < 0.5 < platt(logits)[-1] < 1


def test_calibration_error_by_hand() -> None:
    certain = np.array([0.95, 0.95, 0.05, 0.05])
    happened = np.array([True, False, False, False])
    assert calibration_error(certain, happened) == pytest.approx(0.5 * 0.45 + 0.5 * 0.05)


def test_best_of_every_view() -> None:
    view = np.array([7, 7, 2, 2, 2])
    scores = np.array([0.1, 0.9, 0.3, 0.8, 0.8])
    assert best_per_view(scores, view).tolist() == [3, 1]
    happened = np.array([True, False, False, False, False])
    assert any_per_view(happened, view).tolist() == [False, True]


def test_the_fall_with_torque_is_found_within_questions() -> None:
    rng = np.random.default_rng(3)
    view = np.repeat(np.arange(300), 8)
    ease = np.repeat(rng.normal(0, 3, 300), 8)  # of a question, to all of its grasps
    logits, torque = rng.normal(size=len(view)), rng.uniform(0, 1, len(view))
    held = rng.random(len(view)) < 1 / (1 + np.exp(-(1.5 * logits - 6 * torque + ease)))
    assert fit_torque(logits + ease, torque, held, view) == pytest.approx(4.0, rel=0.15)
    pairs = [
        (good, bad)
        for each in np.unique(view)
        for good in np.flatnonzero((view == each) & held)
        for bad in np.flatnonzero((view == each) & ~held)
    ]
    number = np.bincount(view[[good for good, _ in pairs]])
    difference = np.array([[logits[a] - logits[b], torque[a] - torque[b]] for a, b in pairs])
    plain = LogisticRegression(C=1e9, fit_intercept=False).fit(
        np.vstack([difference, -difference]),
        np.repeat([True, False], len(pairs)),
        np.tile([1 / number[view[good]] for good, _ in pairs], 2),
    )
    expected = -plain.coef_[0, 1] / plain.coef_[0, 0]
    assert fit_torque(logits, torque, held, view) == pytest.approx(expected, rel=0.01)


def test_torque_never_helps_and_unknown_is_nothing() -> None:
    logits, view = np.array([0.0, 1.0, 0.5, 2.0]), np.array([0, 0, 1, 1])
    held, torque = np.array([False, True, True, False]), np.array([0.0, 1.0, 1.0, 0.0])
    assert fit_torque(np.array([0.0, 1.0, 2.0, 0.5]), torque, held, view) == 0
    assert fit_torque(logits, torque, np.ones(4, dtype=bool), view) == 0
    with pytest.raises(ValueError, match="no better"):
        fit_torque(-logits, np.zeros(4), np.array([False, True, False, True]), view)


def test_torque_counts_beyond_what_is_usual_for_an_object() -> None:
    rng = np.random.default_rng(8)
    questions = 3000
    view = np.repeat(np.arange(questions), 6)
    weight, length = (
        np.repeat(rng.uniform(0.5, 6, questions), 6),
        np.repeat(rng.uniform(1, 4, questions), 6),
    )
    lever = length * rng.uniform(0, 0.8, len(view))
    logits = rng.normal(size=len(view))
    excess = weight * (lever - 0.4 * length) / 10
    happened = rng.random(len(view)) < 1 / (1 + np.exp(-(0.7 * logits - 2.8 * excess + 0.5)))
    numbers = np.zeros((len(view), len(NAMES)), dtype=np.float32)
    for name, column in zip(TORQUES_OF, (weight, lever, length), strict=True):
        numbers[:, NAMES.index(name)] = column
    lessons = Lessons(
        images=np.zeros((len(view), 1), dtype=np.float32),
        numbers=numbers,
        lifted=happened,
        held=happened,
        moved=np.zeros(len(view), dtype=bool),
        score=np.full(len(view), 0.5),
        rehearsed=np.full((len(view), 3), ""),
        geometric=np.zeros(len(view)),
        view=view,
        number=view,
        object_class=np.full(len(view), "post"),
    )
    order = fit_order(lessons, logits)
    assert order.per_nm == pytest.approx(4.0, rel=0.15)
    assert order.usual == pytest.approx(0.4, abs=0.06)
    assert order.platt == pytest.approx((0.7, 0.5), abs=0.1)
    assert calibration_error(order(logits, numbers), happened) < 0.03
