"""Which format an answer is written in, and whether the gripper fits it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from services.gateway.formats.graspnet import graspnet_rows
from services.gateway.formats.moveit import MoveItWriter
from services.gateway.formats.poses import poses_of_link, ros_pose
from services.gateway.request import GraspParameters
from services.gateway.settings import GatewaySettings
from shared.errors import InvalidInput
from shared.grippers.kinematics import choose_link
from shared.schemas.answer import GraspAnswer
from shared.schemas.formats import (
    FormattedAnswer,
    GraspNetAnswer,
    MoveItAnswer,
    PoseArrayAnswer,
)
from shared.schemas.gripper import Gripper, ParallelGripper
from shared.schemas.ros import RosHeader, RosTime
from shared.schemas.urdf import TCP
from shared.wire import Message

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Rendered:
    """An answer in its format.

    Attributes
    ----------
    answer : Message
        For JSON.
    grasps : (G, K) array
        For npz: K is 17 for graspnet, else 9, of the poses that the answer holds.
    """

    answer: Message
    grasps: Array


def require_fitting(parameters: GraspParameters, gripper: Gripper) -> None:
    """Return if grasps of this gripper can be written in the format that was asked for.

    Raises
    ------
    InvalidInput
        The format is for grippers with fingers; or the link is not known.
    """
    if parameters.format == "graspnet" and not isinstance(gripper, ParallelGripper):
        raise InvalidInput(
            f"format=graspnet writes grasps of two fingers; {gripper.name!r} is a suction cup. "
            "Formats for it are sparge, moveit and pose_array",
            field="format",
            found="graspnet",
            allowed=["sparge", "moveit", "pose_array"],
        )
    if parameters.format in ("moveit", "pose_array"):
        choose_link(gripper, _pose_of(parameters))


def render(
    answer: GraspAnswer,
    grasps: Array,
    parameters: GraspParameters,
    gripper: Gripper,
    settings: GatewaySettings,
) -> Rendered:
    """Return an answer and its grasps (G, 9) in the format that the parameters name."""
    common: dict[str, Any] = {name: getattr(answer, name) for name in FormattedAnswer.model_fields}
    header = RosHeader(stamp=parameters.stamp or RosTime(), frame_id=answer.frame_id)
    match parameters.format:
        case "sparge":
            return Rendered(answer, grasps)
        case "graspnet":
            assert isinstance(gripper, ParallelGripper)  # require_fitting
            rows = graspnet_rows(grasps, gripper)
            return Rendered(GraspNetAnswer(**common, grasps=rows), rows)
        case "moveit":
            link = choose_link(gripper, _pose_of(parameters))
            up = np.asarray(answer.scene.up)
            writer = MoveItWriter(answer.task, gripper, link, header, up, settings)
            written = MoveItAnswer(**common, pose_of=link.name, grasps=writer.write(grasps))
            return Rendered(written, poses_of_link(grasps, gripper, link))
        case "pose_array":
            link = choose_link(gripper, _pose_of(parameters))
            moved = poses_of_link(grasps, gripper, link)
            return Rendered(
                PoseArrayAnswer(
                    **common,
                    pose_of=link.name,
                    header=header,
                    poses=tuple(ros_pose(row) for row in moved),
                    scores=tuple(np.clip(moved[:, 8], 0, 1).tolist()),
                    widths=tuple(moved[:, 7].tolist()),
                ),
                moved,
            )


def _pose_of(parameters: GraspParameters) -> str | None:
    """Return the name that was asked for; MoveIt wants a link, others the grasp frame."""
    if parameters.pose_of is None and parameters.format == "pose_array":
        return TCP
    return parameters.pose_of
