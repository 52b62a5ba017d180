from __future__ import annotations

import numpy as np
import pytest

from services.execution.shells import shells
from tests.services.execution.scenes import box, cylinder

Array = np.ndarray


def triangles_of(mesh: tuple[Array, Array]) -> Array:
    return np.asarray(mesh[0][mesh[1]])


def volume(triangles: Array) -> float:
    return float(np.linalg.det(triangles).sum() / 6)


BOX = triangles_of(box((0.02, 0.03, 0.04), (0.3, 0.0, 0.0)))


@pytest.mark.parametrize("seed", range(5))
def test_faces_of_any_sense_are_turned_outward(seed: int) -> None:
    turned = np.random.default_rng(seed).random(len(BOX)) < 0.5
    mixed = np.where(turned[:, None, None], BOX[:, ::-1], BOX)
    (shell,) = shells(mixed)
    assert len(shell) == len(BOX)
    assert volume(shell) == pytest.approx(8 * 0.02 * 0.03 * 0.04)


def test_faces_that_are_there_for_both_sides_count_once() -> None:
    (shell,) = shells(np.concatenate([BOX, BOX[:, ::-1]]))
    assert volume(shell) == pytest.approx(8 * 0.02 * 0.03 * 0.04)


def test_bodies_that_run_through_each_other_are_apart() -> None:
    rod = triangles_of(cylinder(0.01, 0.2))
    found = shells(np.concatenate([BOX - [0.3, 0, 0], rod[:, ::-1]]))
    assert sorted(len(each) for each in found) == sorted([len(BOX), len(rod)])
    assert all(volume(each) > 0 for each in found)


def test_faces_without_area_are_nothing() -> None:
    assert shells(np.zeros((4, 3, 3))) == []
