"""Grasps as the array of GraspNet-1Billion.

Its frame has its origin at the grasp's centre, +x approaching, +y closing, z completing; a row is
`score, width, height, depth, rotation (row-major), translation, object_id`. The finger tips lie
`depth` beyond the centre. Source: graspnetAPI, `grasp.py` and `plot_gripper_pro_max`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.geometry.rotation import matrix_from_quaternion, quaternion_from_matrix
from shared.schemas.gripper import ParallelGripper

Array = NDArray[np.float64]

TCP_FROM_GRASPNET = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
"""Rotation: its x is our z, its y is our y, its z is our -x."""
NO_OBJECT = -1.0
"""An answer is about one object, which has no number."""


def graspnet_rows(grasps: Array, gripper: ParallelGripper) -> Array:
    """Return grasps (G, 9) as GraspNet's rows (G, 17), in the same frame and order.

    The centre is the tool centre point. `height` is the width of a finger, which in GraspNet's
    own predictions is 0.02 m for every grasp; `depth` is what the tips reach beyond the centre.
    """
    count = len(grasps)
    rotations = matrix_from_quaternion(grasps[:, 3:7]) @ TCP_FROM_GRASPNET
    return np.column_stack(
        [
            grasps[:, 8],
            grasps[:, 7],
            np.full(count, gripper.finger_width),
            np.full(count, gripper.tip_beyond_tcp),
            rotations.reshape(count, 9),
            grasps[:, :3],
            np.full(count, NO_OBJECT),
        ]
    )


def grasps_from_graspnet(rows: Array) -> Array:
    """Return GraspNet's rows (G, 17) as grasps (G, 9): x y z qx qy qz qw width score."""
    rotations = rows[:, 4:13].reshape(-1, 3, 3) @ TCP_FROM_GRASPNET.T
    quaternions = quaternion_from_matrix(rotations) if len(rows) else np.empty((0, 4))
    return np.column_stack([rows[:, 13:16], quaternions, rows[:, 1], rows[:, 0]])
