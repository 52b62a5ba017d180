"""What a rehearsal tells, from trials whose truth is known."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from services.grasp_proposal.measures import NAMES
from services.grasp_proposal.training.lessons import Lessons
from services.grasp_proposal.training.rehearsal import (
    OUTCOMES,
    counted,
    fit_evidence,
    report,
    right_order,
)
from shared.errors import InvalidInput

Array = NDArray[np.float64]

TRUTH = np.array([0.8, 0.0, -0.9])
GRASPS = 24_000


def drawn(evidence: Array) -> tuple[Lessons, Array, Array]:
    """Return trials in which outcomes are worth `evidence`, their logits, counts of outcomes."""
    rng = np.random.default_rng(4)
    view = np.repeat(np.arange(GRASPS // 4), 4)
    logits = rng.normal(0.5, 1.0, GRASPS)
    came = rng.integers(0, 3, (GRASPS, 3))
    shift = evidence[came].sum(axis=1)
    happened = rng.random(GRASPS) < 1 / (1 + np.exp(-(logits + shift)))
    lessons = Lessons(
        images=np.zeros((GRASPS, 1), dtype=np.float32),
        numbers=np.zeros((GRASPS, len(NAMES)), dtype=np.float32),
        lifted=happened,
        held=happened,
        moved=np.zeros(GRASPS, dtype=bool),
        score=1 / (1 + np.exp(-logits)),
        rehearsed=np.array(OUTCOMES)[came],
        geometric=np.zeros(GRASPS),
        view=view,
        number=view,
        object_class=np.full(GRASPS, "post"),
    )
    return lessons, logits, counted(lessons.rehearsed)


def test_the_evidence_is_found_again() -> None:
    lessons, logits, counts = drawn(TRUTH)
    assert fit_evidence(logits, counts, lessons) == pytest.approx(TRUTH, abs=0.12)


def test_the_evidence_makes_the_probabilities_true_on_the_whole() -> None:
    lessons, logits, counts = drawn(TRUTH)
    added = logits + counts @ fit_evidence(logits, counts, lessons)
    assert (1 / (1 + np.exp(-added))).mean() == pytest.approx(lessons.lifted.mean(), abs=1e-6)


def test_pairs_are_counted_within_questions_and_ties_by_half() -> None:
    view = np.array([0, 0, 0, 1, 1])
    happened = np.array([True, False, False, True, False])
    order = np.array([2.0, 1.0, 2.0, 0.0, 9.0])
    assert right_order(order, happened, view) == pytest.approx((0.75 + 0.0) / 2)


def test_the_report_leaves_out_what_was_not_rehearsed() -> None:
    lessons, _, _ = drawn(TRUTH)
    rehearsed = lessons.rehearsed.copy()
    rehearsed[: GRASPS // 2] = ""
    told = report(Lessons(**{**vars(lessons), "rehearsed": rehearsed}))
    assert f"{GRASPS // 2} of {GRASPS} grasps" in told
    rows = {line.split(" | ")[0].strip("| "): line.split(" | ") for line in told.splitlines()}
    assert sum(int(rows[str(times)][1]) for times in range(4)) == GRASPS // 2
    lifted = [float(rows[str(times)][2]) for times in range(4)]
    assert lifted == sorted(lifted)
    names = ("score", "score and superquadrics", "score and all shapes")
    shares = [float(rows[name][1]) for name in names]
    assert 0.5 < shares[0] < shares[1] < shares[2]


def test_trials_without_rehearsals_are_told() -> None:
    lessons, _, _ = drawn(TRUTH)
    with pytest.raises(InvalidInput, match="no trial was rehearsed"):
        report(Lessons(**{**vars(lessons), "rehearsed": np.full((GRASPS, 3), "")}))


def test_outcomes_are_counted() -> None:
    came = np.array([["held", "held", "missed"], ["slipped_in_shake", "pushed_away", "held"]])
    assert counted(came).tolist() == [[2, 0, 1], [1, 1, 1]]
