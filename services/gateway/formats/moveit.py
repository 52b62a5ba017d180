"""Grasps as moveit_msgs/Grasp."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from services.gateway.formats.poses import poses_of_link, ros_pose
from services.gateway.settings import GatewaySettings
from shared.geometry.rotation import matrix_from_quaternion
from shared.grippers.kinematics import joint_positions
from shared.schemas.gripper import Gripper, ParallelGripper
from shared.schemas.ros import (
    RosDuration,
    RosGrasp,
    RosGripperTranslation,
    RosHeader,
    RosJointTrajectory,
    RosJointTrajectoryPoint,
    RosPoseStamped,
    RosTime,
    RosVector3,
    RosVector3Stamped,
)
from shared.schemas.urdf import Link

Array = NDArray[np.float64]

FINGER_TIME = RosDuration(sec=1)
"""For opening and for closing; a controller that is slower takes longer."""
LIFT_SHARE = 0.5
"""Of the lift that must be possible before the grasp is tried at all."""
_NOWHERE = RosHeader(stamp=RosTime(), frame_id="")


@dataclass(frozen=True)
class MoveItWriter:
    """Writes the grasps of one answer.

    Attributes
    ----------
    task : str
        Names the grasps.
    gripper, link
        What holds, and whose pose `grasp_pose` is.
    header : RosHeader
        Of the input: its frame and the time it was seen.
    up : (3,) array
        Against gravity, in that frame.
    settings : GatewaySettings
        Distances.
    """

    task: str
    gripper: Gripper
    link: Link
    header: RosHeader
    up: Array
    settings: GatewaySettings

    def write(self, grasps: Array) -> tuple[RosGrasp, ...]:
        """Return the messages of grasps (G, 9), in their order."""
        moved = poses_of_link(grasps, self.gripper, self.link)
        return tuple(self._grasp(*each) for each in enumerate(zip(grasps, moved, strict=True)))

    def _grasp(self, number: int, rows: tuple[Array, Array]) -> RosGrasp:
        of_tcp, of_link = rows
        approach = matrix_from_quaternion(of_tcp[3:7])[:, 2]
        settings = self.settings
        into = min(self._reach, settings.approach_distance)
        return RosGrasp(
            id=f"{self.task}_{number}",
            pre_grasp_posture=self._posture(of_tcp[7] + settings.opening_margin),
            grasp_posture=self._posture(0.0, holds=True),
            grasp_pose=RosPoseStamped(header=self.header, pose=ros_pose(of_link)),
            grasp_quality=float(np.clip(of_tcp[8], 0, 1)),
            pre_grasp_approach=self._translation(approach, settings.approach_distance, into),
            post_grasp_retreat=self._translation(
                self.up, settings.retreat_distance, LIFT_SHARE * settings.retreat_distance
            ),
            post_place_retreat=self._translation(-approach, settings.approach_distance, into),
            max_contact_force=self.gripper.force if self._has_fingers else 0.0,
        )

    @property
    def _has_fingers(self) -> bool:
        return isinstance(self.gripper, ParallelGripper)

    @property
    def _reach(self) -> float:
        """How far a part may lie inside the hand: so far the way in has to be straight."""
        if isinstance(self.gripper, ParallelGripper):
            return self.gripper.finger_length
        return self.gripper.cup_length

    def _posture(self, opening: float, *, holds: bool = False) -> RosJointTrajectory:
        """Return where the joints go for an opening; closing ends where the part is."""
        urdf = self.gripper.urdf
        joints = urdf.joints if urdf else ()
        if urdf is None or not joints:
            return RosJointTrajectory(header=_NOWHERE, joint_names=(), points=())
        point = RosJointTrajectoryPoint(
            positions=joint_positions(urdf, opening),
            effort=(self.gripper.force,) * len(joints) if holds else (),
            time_from_start=FINGER_TIME,
        )
        return RosJointTrajectory(header=_NOWHERE, joint_names=joints, points=(point,))

    def _translation(self, direction: Array, desired: float, least: float) -> RosGripperTranslation:
        x, y, z = direction.tolist()
        return RosGripperTranslation(
            direction=RosVector3Stamped(header=self.header, vector=RosVector3(x=x, y=y, z=z)),
            desired_distance=desired,
            min_distance=least,
        )
