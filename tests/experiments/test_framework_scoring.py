"""Scores of regions, as laws."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from experiments.framework.scoring import holds, overlap, score_region

Mask = NDArray[np.bool_]
PAIRS = st.lists(st.tuples(st.booleans(), st.booleans()), min_size=1, max_size=60)


def masks(pairs: list[tuple[bool, bool]]) -> tuple[Mask, Mask]:
    both = np.array(pairs, dtype=np.bool_)
    return both[:, 0], both[:, 1]


def test_scores_of_a_small_example() -> None:
    truth = np.array([1, 1, 1, 0, 0, 0, 0, 0], dtype=bool)
    predicted = np.array([1, 1, 0, 1, 1, 0, 0, 0], dtype=bool)
    score = score_region(truth, predicted)
    assert (score.accuracy, score.precision, score.recall, score.iou) == (
        5 / 8,
        2 / 4,
        2 / 3,
        2 / 5,
    )
    assert not score.good


@given(PAIRS)
def test_truth_and_prediction_swap_precision_and_recall(pairs: list[tuple[bool, bool]]) -> None:
    truth, predicted = masks(pairs)
    one, other = score_region(truth, predicted), score_region(predicted, truth)
    assert (one.precision, one.recall) == (other.recall, other.precision)
    assert (one.accuracy, one.iou) == (other.accuracy, other.iou)
    assert one.iou <= min(one.precision, one.recall)


@given(PAIRS)
def test_the_truth_itself_is_perfect(pairs: list[tuple[bool, bool]]) -> None:
    truth, _ = masks(pairs)
    score = score_region(truth, truth)
    assert score.accuracy == 1
    assert score.iou == score.precision == score.recall == float(truth.any())
    assert score.good == truth.any()


def test_masks_of_different_length_are_refused() -> None:
    for one, other in ((3, 4), (0, 0)):
        with pytest.raises(ValueError, match="cannot compare"):
            score_region(np.ones(one, dtype=bool), np.ones(other, dtype=bool))


def test_empty_regions_are_the_same() -> None:
    nothing, something = np.zeros(3, dtype=bool), np.array([True, False, False])
    assert overlap(nothing, nothing) == 1
    assert overlap(nothing, something) == 0


def test_a_grasp_holds_the_nearest_seen_point() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [np.nan, 0, 0]], dtype=float)
    truth = np.array([False, True, True])
    assert holds(np.array([0.9, 0.2, 0]), points, truth)
    assert not holds(np.array([0.1, 0, 0]), points, truth)
    assert not holds(np.zeros(3), points[2:], truth[2:])
