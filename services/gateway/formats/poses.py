"""Grasps as poses of a link, in ROS's words."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from shared.geometry.se3 import matrix_from_pose, pose_from_matrix
from shared.grippers.kinematics import tcp_from_link
from shared.schemas.gripper import Gripper
from shared.schemas.ros import RosPoint, RosPose, RosQuaternion
from shared.schemas.urdf import TCP, Link

Array = NDArray[np.float64]


def poses_of_link(grasps: Array, gripper: Gripper, link: Link) -> Array:
    """Return grasps (G, 9) with the poses of `link` while the gripper holds, in place of the TCP's.

    Width and score stay. The pads are then as far apart as the part is wide.
    """
    if link.name == TCP:
        return grasps
    moved = grasps.copy()
    for row in moved:
        camera_from_tcp = matrix_from_pose(row[:3], row[3:7])
        camera_from_link = camera_from_tcp @ tcp_from_link(gripper, link, row[7])
        row[:3], row[3:7] = pose_from_matrix(camera_from_link)
    return moved


def ros_pose(grasp: Array) -> RosPose:
    """Return the geometry_msgs/Pose of a row x y z qx qy qz qw ..."""
    x, y, z, qx, qy, qz, qw = grasp[:7].tolist()
    return RosPose(
        position=RosPoint(x=x, y=y, z=z), orientation=RosQuaternion(x=qx, y=qy, z=qz, w=qw)
    )
