"""From tried grasps to a network: the data without torch, the network where torch is there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from services.grasp_proposal.learned import LearnedScorer, sigmoid
from services.grasp_proposal.measures import MIRROR_X, MIRROR_Y, NAMES
from services.grasp_proposal.proposer import GraspProposer
from services.grasp_proposal.settings import GraspProposalSettings
from services.grasp_proposal.training.lessons import Lessons, lessons_of, read_lessons
from services.grasp_proposal.training.mirror import mirrored
from shared.errors import InvalidInput
from shared.wire.npz import write_npz
from tests.services.grasp_proposal.scenes import box, lying_cylinder

SCENES = (lying_cylinder(), box((0.025, 0.15, 0.008)), box((0.05, 0.06, 0.18), turn=0.2))
EACH = 8


def trial(index: int) -> dict[str, NDArray[Any]]:
    """Grasps on a scene that is moved so that the sensor is at the origin."""
    scene = SCENES[index % len(SCENES)]
    motion = np.eye(4)
    motion[:3, 3] = -scene.sensor
    scene = scene.moved(motion)
    answer = GraspProposer(GraspProposalSettings()).propose(scene.request(seed=index))
    grasps = answer.grasps[:: max(1, len(answer.grasps) // EACH)][:EACH]
    held = np.full(len(grasps), index % len(SCENES) == 0)  # only the cylinder is kept
    return {
        "points": scene.points.astype(np.float32),
        "regions": np.ones((1, len(scene.points)), dtype=bool),
        "plane": np.array([*scene.up, scene.offset]),
        "up": scene.up,
        "superquadrics": np.array([[1, 1, *[0.02] * 3, *scene.points.mean(axis=0), 0, 0, 0, 1]]),
        "grippers": np.array(["panda"]),
        "question": np.zeros(len(grasps), dtype=np.int64),
        "grasps": grasps,
        "rank": np.arange(len(grasps)),
        "moved": np.arange(len(grasps)) == 3,
        "lifted": held | (np.arange(len(grasps)) == 2),
        "held": held,
        "object_class": np.array("post"),
        "number": np.array(index),
    }


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("trials")
    for index in range(6):
        (path / f"post-{index}-0.npz").write_bytes(write_npz(trial(index)))
    return path


@pytest.fixture(scope="module")
def lessons(folder: Path) -> Lessons:
    return read_lessons(folder)


def test_every_tried_grasp_is_a_lesson(lessons: Lessons) -> None:
    assert 6 * 4 <= len(lessons) <= 6 * EACH
    assert lessons.images.dtype == np.float32
    assert lessons.numbers.shape == (len(lessons), len(NAMES))
    assert np.isfinite(lessons.images).all()
    assert np.isfinite(lessons.numbers).all()
    assert np.unique(lessons.view).tolist() == list(range(6))
    assert (lessons.lifted | ~lessons.held).all()
    assert (lessons.images[:, :4] != 0).any(axis=(1, 2, 3)).all()


def test_lessons_are_what_the_proposer_shows_the_network() -> None:
    """What is read back from an answer is close to what its score came from."""
    arrays = trial(0)
    (lesson,) = lessons_of(arrays)
    again = LearnedScorer().probabilities(lesson.images, lesson.numbers)
    assert np.abs(again - arrays["grasps"][:, 8]).max() < 0.1


def test_a_question_none_of_whose_grasps_was_tried_teaches_nothing() -> None:
    arrays = trial(0)
    regions = np.concatenate([arrays["regions"], arrays["regions"]])
    more = arrays | {"regions": regions, "grippers": np.array(["panda", "panda"])}
    (lesson,), (same,) = lessons_of(arrays), lessons_of(more)
    np.testing.assert_array_equal(lesson.numbers, same.numbers)


def test_a_folder_without_trials_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InvalidInput, match="no trials"):
        read_lessons(tmp_path)


def test_mirrors_undo_themselves_and_keep_what_is_even(lessons: Lessons) -> None:
    class Always:
        def random(self, size: int) -> NDArray[np.float64]:
            return np.zeros(size)

    rng: Any = Always()
    once = mirrored(lessons.images, lessons.numbers, rng)
    twice = mirrored(*once, rng)
    np.testing.assert_array_equal(twice[0], lessons.images)
    np.testing.assert_array_equal(twice[1], lessons.numbers)
    even = (MIRROR_X > 0) & (MIRROR_Y > 0)
    np.testing.assert_array_equal(once[1][:, even], lessons.numbers[:, even])
    assert (once[0] != lessons.images).any()


def test_a_network_learns_is_exported_and_is_the_same_again(
    lessons: Lessons, folder: Path, tmp_path: Path
) -> None:
    pytest.importorskip("torch")
    pytest.importorskip("onnx")
    from services.grasp_proposal.train import train
    from services.grasp_proposal.training.calibration import Platt
    from services.grasp_proposal.training.evaluation import combined
    from services.grasp_proposal.training.export import to_onnx
    from services.grasp_proposal.training.network import train_network

    networks = [train_network(lessons, 3, seed) for seed in (0, 1)]
    path = tmp_path / "two.onnx"
    path.write_bytes(to_onnx(networks, Platt(1.5, -0.2)).SerializeToString())
    expected = sigmoid(1.5 * combined(networks, lessons) - 0.2)
    found = LearnedScorer(path).probabilities(lessons.images, lessons.numbers)
    assert found == pytest.approx(expected, abs=1e-6)

    made = []
    for name in ("one", "again"):
        out = tmp_path / name / "scorer.onnx"
        train(folder, out, folds=2, epochs=20, networks=1, seed=3)
        made.append(out.read_bytes())
        told = out.with_suffix(".md").read_text()
        assert "calibration error" in told
        assert "| post | 6 |" in told
    assert made[0] == made[1]
