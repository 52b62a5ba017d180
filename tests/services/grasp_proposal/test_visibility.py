from __future__ import annotations

import numpy as np
import pytest

from services.grasp_proposal.visibility import SightMap
from shared.geometry.se3 import pose_matrix, transform_points
from tests.services.grasp_proposal.scenes import about_z


@pytest.fixture
def wall() -> np.ndarray:
    """A 10 cm square 1 m ahead along z."""
    grid = np.stack(np.meshgrid(np.arange(-0.05, 0.05, 0.002), np.arange(-0.05, 0.05, 0.002)), -1)
    return np.column_stack([grid.reshape(-1, 2), np.ones(grid[..., 0].size)])


def test_depth_behind_the_surface(wall: np.ndarray) -> None:
    sight = SightMap.of(wall, np.zeros(3))
    behind = sight.depth_behind(np.array([[0.0, 0, 1.05], [0.02, 0.01, 0.9], [0.3, 0, 1.5]]))
    assert behind == pytest.approx([0.05, 0, 0], abs=0.006)
    assert behind[1:].tolist() == [0, 0]


def test_space_behind_the_sensor_and_beside_the_object_is_free(wall: np.ndarray) -> None:
    sight = SightMap.of(wall, np.zeros(3))
    around = np.array([[0.0, 0, -1], [0, 0, 0], [0.2, 0.2, 1.2], [-5, 0, 1]])
    assert not sight.depth_behind(around).any()


def test_a_rigid_motion_changes_nothing(wall: np.ndarray) -> None:
    motion = pose_matrix([0.4, -1.0, 2.0], about_z(0.8)[[2, 0, 1]])
    where = np.random.default_rng(0).uniform([-0.04, -0.04, 0.9], [0.04, 0.04, 1.2], (200, 3))
    moved = SightMap.of(transform_points(motion, wall), motion[:3, 3])
    expected = SightMap.of(wall, np.zeros(3)).depth_behind(where)
    assert moved.depth_behind(transform_points(motion, where)) == pytest.approx(expected, abs=1e-4)
    assert (expected > 0.1).any()
