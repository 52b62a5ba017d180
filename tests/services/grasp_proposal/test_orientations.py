from __future__ import annotations

import numpy as np
import pytest

from services.grasp_proposal.orientations import hypothesise
from services.grasp_proposal.surface import LocalFrames
from shared.geometry.rotation import any_perpendicular, unit
from tests.services.grasp_proposal.scenes import SENSOR, UP


def random_frames(count: int = 50) -> LocalFrames:
    rng = np.random.default_rng(3)
    normals = unit(rng.normal(size=(count, 3)))
    axes = np.array([any_perpendicular(normal) for normal in normals])
    return LocalFrames(
        rng.normal(size=(count, 3)) * 0.05, normals, axes, unit(rng.normal(size=(count, 3)))
    )


@pytest.mark.parametrize("up", [UP, None])
@pytest.mark.parametrize("viewpoint", [SENSOR, np.array([0.0, 0.0, 5.0]), None])
def test_hands_are_rotations(up: np.ndarray | None, viewpoint: np.ndarray | None) -> None:
    hands = hypothesise(random_frames(), up, viewpoint)
    possible = hands.rotations[hands.possible]
    identity = np.broadcast_to(np.eye(3), possible.shape)
    assert np.allclose(possible.transpose(0, 2, 1) @ possible, identity, atol=1e-9)
    assert np.allclose(np.linalg.det(possible), 1.0)
    assert hands.possible.any(axis=1).all() or up is not None


def test_no_hand_comes_from_under_the_table() -> None:
    hands = hypothesise(random_frames(), UP, SENSOR)
    assert (hands.rotations[hands.possible][:, :, 2] @ UP < 0.31).all()


def test_hands_from_above_close_across_the_part() -> None:
    part = unit(np.array([[1.0, 2.0, 0.0]]))
    frames = LocalFrames(np.zeros((1, 3)), UP[None], part, part)
    rotations = hypothesise(frames, UP, SENSOR).rotations[0]
    down = rotations[rotations[:, :, 2] @ UP < -0.999]
    assert np.abs(down[:, :, 1] @ part[0]).min() < 1e-6
    assert len(down) >= 6
