"""The recorded motion as numbers, in the frame of the request."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.execution.arm import Arm
from services.execution.body import RigidBody
from services.execution.recording import Recording
from services.execution.scene import Scene
from services.execution.world import SETTLE_S
from shared.geometry.se3 import inverse, matrix_from_pose, pose_from_matrix, pose_matrix
from shared.schemas.execution import ExecuteRequest

Array = NDArray[np.float64]


def motion_fields(
    request: ExecuteRequest, scene: Scene, body: RigidBody, recording: Recording, arm: Arm | None
) -> dict[str, Any]:
    """Return the fields of the answer that hold the motion.

    Parameters
    ----------
    request : ExecuteRequest
    scene : Scene
    body : RigidBody
        As it was before anything moved.
    recording : Recording
    arm : Arm or None
        What moved, unless a hand flew by itself. Its joints are moved about: forward kinematics
        is left for when the simulation is over, so that recording only reads.
    """
    given = matrix_from_pose(request.pose.position, request.pose.quaternion)
    frame_from_world = given @ inverse(scene.world_from_grasp)
    raised = pose_matrix([0.0, 0.0, scene.raised], np.eye(3))
    body_from_object = inverse(body.world_from_body) @ raised @ scene.world_from_mesh
    snapshots = recording.snapshots
    fields = {
        "motion_times": np.array([SETTLE_S + each.since_s for each in snapshots]).round(9),
        "motion_object": pose_rows(
            [frame_from_world @ each.world_from_body @ body_from_object for each in snapshots]
        ),
        "motion_opening": np.array([each.opening for each in snapshots]),
        "motion_phases": tuple(each.phase for each in snapshots),
    }
    if arm is None:
        flown = [each.world_from_grasp for each in snapshots if each.world_from_grasp is not None]
        return {**fields, "motion_hand": pose_rows([frame_from_world @ each for each in flown])}
    joints = np.array([each.joints for each in snapshots])
    frame_from_base = frame_from_world @ recording.world_from_base
    hands = [frame_from_base @ arm.base_from_grasp(each) for each in joints]
    return {
        **fields,
        "motion_hand": pose_rows(hands),
        "motion_joints": joints,
        "motion_base": pose_rows([frame_from_base])[0],
    }


def pose_rows(poses: list[Array]) -> Array:
    """Return rows (F, 7: x y z qx qy qz qw) of poses (4, 4); quaternions follow each other.

    Of the two quaternions of a rotation each is the one nearer to that before it, so that
    numbers between two rows are poses between them.
    """
    rows = np.array([np.concatenate(pose_from_matrix(pose)) for pose in poses])
    if len(rows) > 1:
        turned = np.sign(np.einsum("fi,fi->f", rows[1:, 3:], rows[:-1, 3:]))
        rows[1:, 3:] *= np.cumprod(np.where(turned < 0, -1.0, 1.0))[:, None]
    return rows
