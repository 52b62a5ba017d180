"""ROS 2 messages as JSON, field for field; each class is named after its message.

So that `rosidl_runtime_py.set_message_fields` and rosbridge take them as they are. Sources:
the .msg files of builtin_interfaces, std_msgs, geometry_msgs, trajectory_msgs, moveit_msgs.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, FiniteFloat

from shared.wire import Message

FrameId = Annotated[str, Field(max_length=128)]


class RosTime(Message):
    """builtin_interfaces/Time; 0 s means `the latest` to tf2."""

    sec: Annotated[int, Field(ge=-(2**31), lt=2**31)] = 0
    nanosec: Annotated[int, Field(ge=0, lt=10**9)] = 0


class RosDuration(Message):
    """builtin_interfaces/Duration."""

    sec: int = 0
    nanosec: int = 0


class RosHeader(Message):
    """std_msgs/Header."""

    stamp: RosTime
    frame_id: FrameId


class RosPoint(Message):
    """geometry_msgs/Point."""

    x: float
    y: float
    z: float


class RosVector3(Message):
    """geometry_msgs/Vector3."""

    x: float
    y: float
    z: float


class RosQuaternion(Message):
    """geometry_msgs/Quaternion."""

    x: float
    y: float
    z: float
    w: float


class RosPose(Message):
    """geometry_msgs/Pose."""

    position: RosPoint
    orientation: RosQuaternion


class RosPoseStamped(Message):
    """geometry_msgs/PoseStamped."""

    header: RosHeader
    pose: RosPose


class RosVector3Stamped(Message):
    """geometry_msgs/Vector3Stamped."""

    header: RosHeader
    vector: RosVector3


class RosJointTrajectoryPoint(Message):
    """trajectory_msgs/JointTrajectoryPoint."""

    positions: tuple[FiniteFloat, ...]
    velocities: tuple[FiniteFloat, ...] = ()
    accelerations: tuple[FiniteFloat, ...] = ()
    effort: tuple[FiniteFloat, ...] = ()
    time_from_start: RosDuration


class RosJointTrajectory(Message):
    """trajectory_msgs/JointTrajectory."""

    header: RosHeader
    joint_names: tuple[str, ...]
    points: tuple[RosJointTrajectoryPoint, ...]


class RosGripperTranslation(Message):
    """moveit_msgs/GripperTranslation."""

    direction: RosVector3Stamped
    desired_distance: float
    min_distance: float


class RosGrasp(Message):
    """moveit_msgs/Grasp."""

    id: str
    pre_grasp_posture: RosJointTrajectory
    grasp_posture: RosJointTrajectory
    grasp_pose: RosPoseStamped
    grasp_quality: float
    pre_grasp_approach: RosGripperTranslation
    post_grasp_retreat: RosGripperTranslation
    post_place_retreat: RosGripperTranslation
    max_contact_force: float
    allowed_touch_objects: tuple[str, ...] = ()
