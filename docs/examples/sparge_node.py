"""A ROS 2 node that asks SPaRGE about the latest point cloud. Needs rclpy and SPaRGE's client.

Subscribes
    points (sensor_msgs/PointCloud2)
Publishes
    ~/grasps (geometry_msgs/PoseArray): tool centre points in the cloud's frame, best first
    ~/pregrasp (geometry_msgs/PoseStamped): where the straight approach of the first one begins
Services
    ~/grasp (std_srvs/Trigger): ask now; `message` says what was found, or why nothing was
Parameters
    url, task, gripper, max_grasps; all but the URL are read anew for every question
"""

from __future__ import annotations

import numpy as np
import rclpy
from geometry_msgs.msg import Pose, PoseArray, PoseStamped
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger

from shared.client import GraspResult, Sparge
from shared.errors import SpargeError
from shared.schemas.point_cloud2 import PointCloud2 as Cloud
from shared.schemas.point_cloud2 import cloud_points

MAX_BYTES = 256 * 2**20
TIMEOUT_S = 30.0


class SpargeNode(Node):
    """Keeps the latest cloud and asks about it when it is told to."""

    def __init__(self, sparge: Sparge | None = None) -> None:
        super().__init__("sparge")
        url = self.declare_parameter("url", "http://127.0.0.1:8000").value
        for name, default in (("task", "handover"), ("gripper", "panda"), ("max_grasps", 10)):
            self.declare_parameter(name, default)
        self._sparge = sparge or Sparge(url, timeout_s=TIMEOUT_S)
        self._latest: PointCloud2 | None = None
        self._grasps = self.create_publisher(PoseArray, "~/grasps", 1)
        self._pregrasp = self.create_publisher(PoseStamped, "~/pregrasp", 1)
        self.create_subscription(PointCloud2, "points", self._keep, qos_profile_sensor_data)
        self.create_service(Trigger, "~/grasp", self._answer)

    def _keep(self, message: PointCloud2) -> None:
        self._latest = message

    def _answer(self, _: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        if self._latest is None:
            response.success, response.message = False, "no cloud has come in yet"
            return response
        try:
            result = self._ask(self._latest)
        except SpargeError as error:
            self.get_logger().error(f"{error.code}: {error.message}")
            response.success, response.message = False, f"{error.code}: {error.message}"
            return response
        self._publish(result, self._latest)
        response.success = result.best is not None
        if result.reason:
            response.message = f"{result.reason.code}: {result.reason.message}"
        else:
            response.message = result.why or f"{len(result.grasps)} grasps"
        return response

    def _ask(self, message: PointCloud2) -> GraspResult:
        return self._sparge.grasp(
            points_of(message),
            self.get_parameter("task").value,
            gripper=self.get_parameter("gripper").value,
            max_grasps=self.get_parameter("max_grasps").value,
            frame_id=message.header.frame_id or "camera",
        )

    def _publish(self, result: GraspResult, message: PointCloud2) -> None:
        """Publish what was found, with the header of the cloud: tf2 moves it from there."""
        poses = [grasp.pose for grasp in result.answer.grasps]
        array = PoseArray(header=message.header)
        array.poses = [ros_pose(pose.position, pose.quaternion) for pose in poses]
        self._grasps.publish(array)
        if result.answer.grasps:
            before = result.answer.grasps[0].pregrasp
            pose = ros_pose(before.position, before.quaternion)
            self._pregrasp.publish(PoseStamped(header=message.header, pose=pose))


def points_of(message: PointCloud2) -> NDArray[np.float64]:
    """Return the points (height*width, 3) of a message, in metres, row-major; NaN: no return."""
    fields = [
        {"name": each.name, "offset": each.offset, "datatype": each.datatype, "count": each.count}
        for each in message.fields
    ]
    cloud = Cloud.model_validate(
        {
            "height": message.height,
            "width": message.width,
            "fields": fields,
            "is_bigendian": message.is_bigendian,
            "point_step": message.point_step,
            "row_step": message.row_step,
            "data": bytes(message.data),
        }
    )
    return cloud_points(cloud, MAX_BYTES)


def ros_pose(position: tuple[float, ...], quaternion: tuple[float, ...]) -> Pose:
    """Return the message of a position and a quaternion [x, y, z, w]."""
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = position
    turn = pose.orientation
    turn.x, turn.y, turn.z, turn.w = quaternion
    return pose


def main() -> None:
    """Run the node until it is told to stop."""
    rclpy.init()
    node = SpargeNode()
    try:
        rclpy.spin(node)
    finally:
        node.destroy_node()
        rclpy.shutdown()


if __name__ == "__main__":
    main()
