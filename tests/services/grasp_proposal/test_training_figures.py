from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import Bounds
from sklearn.linear_model import LogisticRegression
from sklearn.metrics import average_precision_score, roc_auc_score

from services.grasp_proposal.training.calibration import fit_platt
from services.grasp_proposal.training.figures import (
    any_per_view,
    average_precision,
    best_per_view,
    by_kind,
    calibration_error,
    roc_auc,
)
from services.grasp_proposal.training.ranking import fit_pairs

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


def test_weights_are_those_of_a_logistic_regression_over_pairs() -> None:
    rng = np.random.default_rng(3)
    view = np.repeat(np.arange(300), 8)
    ease = np.repeat(rng.normal(0, 3, 300), 8)  # of a question, to all of its grasps
    known = np.column_stack([rng.normal(size=len(view)), rng.uniform(0, 1, len(view))])
    good = rng.random(len(view)) < 1 / (1 + np.exp(-(known @ [1.5, -6.0] + ease)))
    anything = Bounds([-np.inf, -np.inf], [np.inf, np.inf])
    found = fit_pairs(known, good, view, anything)
    assert found == pytest.approx([1.5, -6.0], rel=0.15)
    both = [
        (a, b)
        for each in np.unique(view)
        for a in np.flatnonzero((view == each) & good)
        for b in np.flatnonzero((view == each) & ~good)
    ]
    number = np.bincount(view[[a for a, _ in both]])
    difference = np.array([known[a] - known[b] for a, b in both])
    plain = LogisticRegression(C=1e9, fit_intercept=False).fit(
        np.vstack([difference, -difference]),
        np.repeat([True, False], len(both)),
        np.tile([1 / number[view[a]] for a, _ in both], 2),
    )
    assert found == pytest.approx(plain.coef_[0], rel=0.01)
    shifted = known + np.repeat(rng.normal(0, 9, (300, 2)), 8, axis=0)
    assert fit_pairs(shifted, good, view, anything) == pytest.approx(found, rel=1e-3)


def test_weights_stay_within_bounds_and_are_nothing_without_pairs() -> None:
    view, good = np.array([0, 0, 1, 1]), np.array([False, True, True, False])
    known = np.array([[0.0, 1.0], [1.0, 0.0], [2.0, 0.0], [0.5, 1.0]])
    bounded = fit_pairs(known, good, view, Bounds([-np.inf, 0.0], [5.0, 5.0]))
    assert bounded == pytest.approx([5.0, 0.0])
    assert not fit_pairs(known, np.ones(4, dtype=bool), view, Bounds([0, 0], [1, 1])).any()


def test_each_kind_of_object_is_counted_by_its_own_views() -> None:
    kind = np.array(["mug", "mug", "mug", "pan", "pan"])
    view = np.array([0, 0, 1, 2, 2])
    happened = np.array([False, True, True, True, False])
    scores = {
        "right": np.array([0.1, 0.9, 0.5, 0.9, 0.1]),
        "wrong": np.array([0.9, 0.1, 0.5, 0.1, 0.9]),
    }
    found = by_kind(kind, view, scores, happened)
    assert found == {
        "mug": {"views": 2, "right": 1.0, "wrong": 0.5, "any": 1.0},
        "pan": {"views": 1, "right": 1.0, "wrong": 0.0, "any": 1.0},
    }
