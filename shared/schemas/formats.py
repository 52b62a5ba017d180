"""The answer to POST /grasp in formats of other tools, `?format=...`."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from shared.schemas.ros import RosGrasp, RosHeader, RosPose
from shared.schemas.task import Reason
from shared.wire import ArrayField, Message

Format = Literal["sparge", "moveit", "graspnet", "pose_array"]

GRASPNET_COLUMNS = (
    *("score", "width", "height", "depth"),
    *(f"rotation_{row}{column}" for row in range(3) for column in range(3)),
    *("translation_x", "translation_y", "translation_z", "object_id"),
)
GraspNetRows = Annotated[NDArray[np.float64], ArrayField("float64", ("G", 17))]
"""As `graspnetAPI.GraspGroup.grasp_group_array`."""


class FormattedAnswer(Message):
    """What every format says beside its grasps."""

    request_id: str
    task: str
    gripper: str
    frame_id: str
    found: bool
    reason: Reason | None
    """Why there are no grasps."""


class MoveItAnswer(FormattedAnswer):
    """`format=moveit`."""

    pose_of: str
    """Which link `grasp_pose` is the pose of, or `tcp`."""
    grasps: tuple[RosGrasp, ...]
    """moveit_msgs/Grasp, best first."""


class GraspNetAnswer(FormattedAnswer):
    """`format=graspnet`."""

    columns: tuple[str, ...] = GRASPNET_COLUMNS
    grasps: GraspNetRows
    """Best first."""


class PoseArrayAnswer(FormattedAnswer):
    """`format=pose_array`: `header` and `poses` are a geometry_msgs/PoseArray."""

    pose_of: str
    """Which link the poses are of, or `tcp`."""
    header: RosHeader
    poses: tuple[RosPose, ...]
    """Best first."""
    scores: tuple[float, ...]
    widths: tuple[float, ...]
    """Openings in metres that the grasps need."""
