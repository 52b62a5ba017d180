"""Transforms with frame names: a group, and frames that must meet."""

from __future__ import annotations

import numpy as np
import pytest

from shared.errors import InvalidInput
from shared.geometry.rotation import unit
from shared.geometry.transform import Transform


def some(rng: np.random.Generator, target: str, source: str) -> Transform:
    return Transform.from_pose(target, source, rng.normal(size=3), unit(rng.normal(size=4)))


def test_neighbours_cancel(rng: np.random.Generator) -> None:
    base_from_camera, camera_from_grasp = some(rng, "base", "camera"), some(rng, "camera", "grasp")
    base_from_grasp = base_from_camera @ camera_from_grasp
    assert base_from_grasp.name == "base_from_grasp"
    points = rng.normal(size=(5, 3))
    np.testing.assert_allclose(
        base_from_grasp.apply(points), base_from_camera.apply(camera_from_grasp.apply(points))
    )


def test_the_other_order_is_refused(rng: np.random.Generator) -> None:
    with pytest.raises(InvalidInput, match=r"camera_from_grasp @ base_from_camera"):
        some(rng, "camera", "grasp") @ some(rng, "base", "camera")


def test_inverse_and_identity(rng: np.random.Generator) -> None:
    motion = some(rng, "a", "b")
    back = motion.inverse @ motion
    assert back.name == "b_from_b"
    np.testing.assert_allclose(back, np.eye(4), atol=1e-12)
    again = Transform.from_pose("a", "b", motion.position, motion.quaternion)
    np.testing.assert_allclose(again, motion, atol=1e-12)
    assert "a_from_b: position" in repr(motion)


def test_it_is_an_array_and_cannot_be_changed(rng: np.random.Generator) -> None:
    motion = some(rng, "a", "b")
    assert np.asarray(motion).shape == (4, 4)
    assert np.asarray(motion, dtype=np.float32).dtype == np.float32
    with pytest.raises(ValueError, match="read-only"):
        motion.matrix[0, 3] = 1.0
    copied = np.array(motion)
    copied[0, 3] = 1.0
    assert motion.matrix[0, 3] != 1.0


@pytest.mark.parametrize(
    "matrix",
    [np.eye(3), np.diag([1.0, 1.0, -1.0, 1.0]), 2 * np.eye(4), np.full((4, 4), np.nan)],
)
def test_what_is_no_rigid_motion(matrix: np.ndarray) -> None:
    with pytest.raises(InvalidInput, match="a_from_b"):
        Transform("a", "b", matrix)
