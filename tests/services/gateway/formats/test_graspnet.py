"""GraspNet's array, against the gripper that graspnetAPI draws for it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.gateway.formats.graspnet import (
    TCP_FROM_GRASPNET,
    graspnet_rows,
    grasps_from_graspnet,
)
from shared.geometry.rotation import matrix_from_quaternion
from shared.geometry.se3 import matrix_from_pose, transform_points
from shared.grippers import load_grippers
from shared.schemas.formats import GRASPNET_COLUMNS
from shared.schemas.gripper import ParallelGripper

HANDS = [each for each in load_grippers().values() if isinstance(each, ParallelGripper)]


def some_grasps(rng: np.random.Generator, count: int = 50) -> np.ndarray:
    quaternions = Rotation.random(count, rng=rng).as_quat(canonical=True)
    columns = [rng.normal(size=(count, 3)), quaternions, rng.uniform(0, 0.08, (count, 2))]
    return np.column_stack(columns)


@pytest.mark.parametrize("hand", HANDS, ids=lambda hand: hand.name)
def test_there_and_back(rng: np.random.Generator, hand: ParallelGripper) -> None:
    grasps = some_grasps(rng)
    np.testing.assert_allclose(grasps_from_graspnet(graspnet_rows(grasps, hand)), grasps)


def test_the_rotation_is_one() -> None:
    np.testing.assert_array_equal(TCP_FROM_GRASPNET.T @ TCP_FROM_GRASPNET, np.eye(3))
    assert np.linalg.det(TCP_FROM_GRASPNET) == pytest.approx(1)


@pytest.mark.parametrize("hand", HANDS, ids=lambda hand: hand.name)
def test_the_fingers_that_graspnet_draws_are_ours(
    rng: np.random.Generator, hand: ParallelGripper
) -> None:
    """`plot_gripper_pro_max` puts the inner edges of the tips at (depth, +-width/2, 0)."""
    grasps = some_grasps(rng)
    for grasp, row in zip(grasps, graspnet_rows(grasps, hand), strict=True):
        _, width, height, depth = row[:4]
        drawn = np.array([[depth, -width / 2, 0], [depth, width / 2, 0]])
        theirs = drawn @ row[4:13].reshape(3, 3).T + row[13:16]
        tips = np.array([[0, -grasp[7] / 2, 0], [0, grasp[7] / 2, 0]])
        tips[:, 2] = hand.tip_beyond_tcp
        ours = transform_points(matrix_from_pose(grasp[:3], grasp[3:7]), tips)
        np.testing.assert_allclose(theirs, ours, atol=1e-12)
        assert height == hand.finger_width


def test_columns(rng: np.random.Generator) -> None:
    grasps = some_grasps(rng)
    row = dict(zip(GRASPNET_COLUMNS, graspnet_rows(grasps, HANDS[0])[0], strict=True))
    approach = matrix_from_quaternion(grasps[0, 3:7])[:, 2]
    assert [row[f"rotation_{i}0"] for i in range(3)] == pytest.approx(approach)
    assert (row["score"], row["width"], row["object_id"]) == (grasps[0, 8], grasps[0, 7], -1)


def test_no_grasps_are_an_array_all_the_same() -> None:
    rows = graspnet_rows(np.empty((0, 9)), HANDS[0])
    assert rows.shape == (0, 17)
    assert grasps_from_graspnet(rows).shape == (0, 9)
