"""What the scorers of cuts learn from, and that they learn."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from experiments.parts.__main__ import write_lessons
from services.primitive_recovery.parts.lesson import Lesson, pieces, quality, read_lesson
from services.primitive_recovery.parts.scorer import Scorer
from services.primitive_recovery.parts.train import Rows, fitted, show, usefulness
from shared.wire.npz import write_npz


def test_a_perfect_cut_has_quality_one() -> None:
    assert quality(np.array([60.0, 0.0]), np.array([60.0, 40.0]), 60, 100) == 1.0


def test_a_cut_is_as_good_as_its_worse_side() -> None:
    found = quality(np.array([50.0, 0.0]), np.array([60.0, 40.0]), 50, 100)
    assert found == pytest.approx(min(50 / 60, 40 / 50))


def test_three_regions_may_be_parted_two_to_one() -> None:
    total = np.array([60.0, 20.0, 20.0])
    assert quality(np.array([60.0, 20.0, 0.0]), total, 80, 100) == 1.0


def test_a_cut_through_a_single_region_is_worthless() -> None:
    assert quality(np.array([50.0]), np.array([100.0]), 50, 100) == 0.0
    assert quality(np.array([55.0, 30.0]), np.array([60.0, 40.0]), 85, 100) == 0.0


def test_usefulness_grows_with_quality() -> None:
    found = usefulness(np.array([0.0, 0.4, 0.6, 0.9, 1.0]))
    assert found[0] == found[1] == 0.0
    assert 0.0 < found[2] < 1.0
    assert found[3] == found[4] == 1.0


def test_pieces_are_the_parts_and_what_they_leave(rng: np.random.Generator) -> None:
    region = np.repeat([0, 1, 2], [50, 30, 20])
    lesson = Lesson(rng.normal(size=(100, 3)), region, None)
    found = [len(piece.points) for piece in pieces(lesson)]
    assert sorted(found) == [20, 30, 50, 50, 70, 80]
    assert all(piece.is_piece for piece in pieces(lesson))
    assert pieces(Lesson(lesson.points, 0 * region, None)) == []


@pytest.fixture(scope="module")
def lessons(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("lessons")
    written, _ = write_lessons(folder, seed=5, first=0, last=1)
    assert written >= 14
    assert write_lessons(folder, seed=5, first=0, last=1)[0] == 0
    return folder


def test_lessons_show_all_parts_of_an_object(lessons: Path, rng: np.random.Generator) -> None:
    (path,) = (lessons / "double_pan-0").glob("*.npz")
    assert read_lesson(path, rng).region.max() == 2
    (path,) = (lessons / "box-0").glob("*.npz")
    assert read_lesson(path, rng).region.max() == 0


def test_training_lowers_the_error(lessons: Path, rng: np.random.Generator, tmp_path: Path) -> None:
    slices, sticks = Rows(), Rows()
    for path in sorted(lessons.glob("*/*.npz")):
        show(read_lesson(path, rng), slices, sticks, rng)
    (tmp_path / "scorer.npz").write_bytes(write_npz(fitted(slices, (16,), 1e-4, range(1))))
    features, useful = np.concatenate(slices.features), np.concatenate(slices.useful)
    predicted = Scorer.load(tmp_path / "scorer.npz")(features.astype(np.float64))
    error = float(((predicted - useful) ** 2).mean())
    assert error < 0.5 * float(useful.var())
