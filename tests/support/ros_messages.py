"""Message definitions of ROS 2, field by field, and JSON held against them.

From the .msg files of builtin_interfaces, std_msgs, geometry_msgs, sensor_msgs, std_srvs,
trajectory_msgs and moveit_msgs; comments and constants are left out.
"""

from __future__ import annotations

from typing import Any

DEFINITIONS = {
    "builtin_interfaces/Time": "int32 sec, uint32 nanosec",
    "builtin_interfaces/Duration": "int32 sec, uint32 nanosec",
    "std_msgs/Header": "builtin_interfaces/Time stamp, string frame_id",
    "geometry_msgs/Point": "float64 x, float64 y, float64 z",
    "geometry_msgs/Vector3": "float64 x, float64 y, float64 z",
    "geometry_msgs/Quaternion": "float64 x, float64 y, float64 z, float64 w",
    "geometry_msgs/Pose": "geometry_msgs/Point position, geometry_msgs/Quaternion orientation",
    "geometry_msgs/PoseStamped": "std_msgs/Header header, geometry_msgs/Pose pose",
    "geometry_msgs/Vector3Stamped": "std_msgs/Header header, geometry_msgs/Vector3 vector",
    "sensor_msgs/PointField": "string name, uint32 offset, uint8 datatype, uint32 count",
    "sensor_msgs/PointCloud2": (
        "std_msgs/Header header, uint32 height, uint32 width, sensor_msgs/PointField[] fields, "
        "bool is_bigendian, uint32 point_step, uint32 row_step, uint8[] data, bool is_dense"
    ),
    "std_srvs/Trigger_Request": "",
    "std_srvs/Trigger_Response": "bool success, string message",
    "geometry_msgs/PoseArray": "std_msgs/Header header, geometry_msgs/Pose[] poses",
    "trajectory_msgs/JointTrajectoryPoint": (
        "float64[] positions, float64[] velocities, float64[] accelerations, float64[] effort, "
        "builtin_interfaces/Duration time_from_start"
    ),
    "trajectory_msgs/JointTrajectory": (
        "std_msgs/Header header, string[] joint_names, "
        "trajectory_msgs/JointTrajectoryPoint[] points"
    ),
    "moveit_msgs/GripperTranslation": (
        "geometry_msgs/Vector3Stamped direction, float32 desired_distance, float32 min_distance"
    ),
    "moveit_msgs/Grasp": (
        "string id, trajectory_msgs/JointTrajectory pre_grasp_posture, "
        "trajectory_msgs/JointTrajectory grasp_posture, geometry_msgs/PoseStamped grasp_pose, "
        "float64 grasp_quality, moveit_msgs/GripperTranslation pre_grasp_approach, "
        "moveit_msgs/GripperTranslation post_grasp_retreat, "
        "moveit_msgs/GripperTranslation post_place_retreat, float32 max_contact_force, "
        "string[] allowed_touch_objects"
    ),
}
_PRIMITIVES: dict[str, type | tuple[type, ...]] = {
    "string": str,
    "int32": int,
    "uint32": int,
    "float32": (float, int),
    "float64": (float, int),
}


def fields_of(kind: str) -> dict[str, str]:
    """Return the type of each field of a message, in their order."""
    pairs = [each.split(" ") for each in DEFINITIONS[kind].split(", ") if each]
    return {name: of for of, name in pairs}


def require_message(kind: str, found: Any, where: str = "") -> None:
    """Assert that `found` has the fields of a message in their order, each of its type."""
    where = where or kind
    if kind.endswith("[]"):
        assert isinstance(found, list), where
        for number, each in enumerate(found):
            require_message(kind[:-2], each, f"{where}[{number}]")
        return
    if kind in _PRIMITIVES:
        assert isinstance(found, _PRIMITIVES[kind]), f"{where}: {found!r} is no {kind}"
        assert not isinstance(found, bool), where
        return
    fields = fields_of(kind)
    assert list(found) == list(fields), where
    for name, each in fields.items():
        require_message(each, found[name], f"{where}.{name}")
