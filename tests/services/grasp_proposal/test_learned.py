"""The shipped network: probabilities, in order, the same bytes each time, in time."""

from __future__ import annotations

import hashlib
import time
from pathlib import Path

import numpy as np
import pytest

from services.grasp_proposal.descriptor import CHANNELS, SIZE
from services.grasp_proposal.learned import MODEL, LearnedScorer, sigmoid
from services.grasp_proposal.measures import NAMES
from services.grasp_proposal.proposer import GraspProposer
from services.grasp_proposal.settings import GraspProposalSettings
from shared.errors import InternalError
from tests.services.grasp_proposal.scenes import Scene, box, lying_cylinder

GRASPS = 120


def some_inputs() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(2)
    images = rng.normal(size=(GRASPS, CHANNELS, SIZE, SIZE)).astype(np.float32)
    return images, rng.normal(size=(GRASPS, len(NAMES))).astype(np.float32)


def test_the_same_inputs_give_the_same_bytes() -> None:
    inputs = some_inputs()
    one = LearnedScorer().probabilities(*inputs)
    other = LearnedScorer().probabilities(*inputs)
    assert one.tobytes() == other.tobytes()
    assert ((one > 0) & (one < 1)).all()
    assert len(np.unique(one)) > GRASPS / 2


def test_the_card_is_of_the_shipped_network() -> None:
    sha256 = hashlib.sha256(MODEL.read_bytes()).hexdigest()
    assert sha256 in MODEL.with_suffix(".md").read_text(encoding="utf-8")


@pytest.mark.parametrize("scene", [lying_cylinder(), box((0.025, 0.15, 0.008))])
def test_answers_are_ordered_by_probability(scene: Scene) -> None:
    answer = GraspProposer(GraspProposalSettings()).propose(scene.request())
    scores = answer.grasps[:, 8]
    assert (np.diff(scores) <= 0).all()
    assert ((scores > 0) & (scores < 1)).all()


def test_no_grasps_have_no_scores() -> None:
    images, numbers = some_inputs()
    assert LearnedScorer().probabilities(images[:0], numbers[:0]).shape == (0,)


def test_a_missing_or_foreign_network_is_told_at_once(tmp_path: Path) -> None:
    with pytest.raises(InternalError, match=r"missing: no file .*nowhere\.onnx"):
        LearnedScorer(tmp_path / "nowhere.onnx")
    foreign = tmp_path / "foreign.onnx"
    foreign.write_bytes(b"not a network")
    with pytest.raises(InternalError, match="no network"):
        LearnedScorer(foreign)


def test_sigmoid_does_not_overflow() -> None:
    assert sigmoid([-1e4, 0.0, 1e4]).tolist() == [0.0, 0.5, 1.0]


def test_a_hundred_grasps_take_little_time() -> None:
    scorer, inputs = LearnedScorer(), some_inputs()
    scorer.probabilities(*inputs)
    spent = []
    for _ in range(5):
        started = time.process_time()
        scorer.probabilities(*inputs)
        spent.append(time.process_time() - started)
    assert min(spent) < 0.05
