"""moveit_msgs/Grasp: every field, and the pose of the link that MoveIt means."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.gateway.formats.moveit import MoveItWriter
from services.gateway.settings import GatewaySettings
from shared.geometry.se3 import matrix_from_pose, pose_matrix
from shared.grippers import load_grippers
from shared.grippers.kinematics import choose_link
from shared.schemas.ros import RosGrasp, RosHeader, RosTime
from tests.support.ros_messages import require_message

GRIPPERS = load_grippers()
HEADER = RosHeader(stamp=RosTime(sec=12, nanosec=34), frame_id="camera_optical")
UP = np.array([0.0, -0.8, -0.6])
QUATERNION = Rotation.from_euler("xyz", [2.0, 0.3, -1.0]).as_quat()
GRASP = np.array([[0.1, -0.2, 0.7, *QUATERNION, 0.05, 0.9]])


def written(gripper: str, link: str | None = None, grasps: np.ndarray = GRASP) -> RosGrasp:
    held = GRIPPERS[gripper]
    settings = GatewaySettings()
    writer = MoveItWriter("pouring", held, choose_link(held, link), HEADER, UP, settings)
    return writer.write(grasps)[0]


def pose(grasp: RosGrasp) -> np.ndarray:
    found = grasp.grasp_pose.pose
    position = list(found.position.model_dump().values())
    return matrix_from_pose(position, list(found.orientation.model_dump().values()))


@pytest.mark.parametrize("gripper", GRIPPERS)
def test_it_is_the_message(gripper: str) -> None:
    require_message("moveit_msgs/Grasp", written(gripper).model_dump(mode="json"))


def test_the_flange_of_the_panda_leads_to_the_tool_centre_point() -> None:
    """By the joints of franka_description: link8 -> hand is -45 degrees, hand -> TCP 103.4 mm."""
    link8_from_hand = pose_matrix(
        [0, 0, 0], Rotation.from_euler("z", -45, degrees=True).as_matrix()
    )
    hand_from_tcp = pose_matrix([0, 0, 0.1034], np.eye(3))
    camera_from_tcp = matrix_from_pose(GRASP[0, :3], QUATERNION)
    at_flange = pose(written("panda"))
    np.testing.assert_allclose(
        at_flange @ link8_from_hand @ hand_from_tcp, camera_from_tcp, atol=1e-12
    )
    at_hand = pose(written("panda", "panda_hand"))
    np.testing.assert_allclose(at_hand @ hand_from_tcp, camera_from_tcp, atol=1e-12)
    np.testing.assert_allclose(pose(written("panda", "tcp")), camera_from_tcp, atol=1e-12)


def test_directions_are_in_the_frame_of_the_view() -> None:
    grasp = written("panda")
    approach = Rotation.from_quat(QUATERNION).as_matrix()[:, 2]
    for translation, direction in (
        (grasp.pre_grasp_approach, approach),
        (grasp.post_grasp_retreat, UP),
        (grasp.post_place_retreat, -approach),
    ):
        assert translation.direction.header == HEADER
        assert list(translation.direction.vector.model_dump().values()) == pytest.approx(direction)
        assert 0 < translation.min_distance <= translation.desired_distance == 0.10


def test_the_hand_opens_a_little_wider_than_the_part_and_closes_on_it() -> None:
    grasp = written("panda")
    for posture in (grasp.pre_grasp_posture, grasp.grasp_posture):
        assert posture.joint_names == ("panda_finger_joint1", "panda_finger_joint2")
        assert posture.points[0].time_from_start.sec > 0
    assert grasp.pre_grasp_posture.points[0].positions == pytest.approx([0.03, 0.03])
    assert grasp.grasp_posture.points[0].positions == pytest.approx([0, 0])
    assert grasp.grasp_posture.points[0].effort == pytest.approx([20, 20])
    widest = GRASP.copy()
    widest[0, 7] = 0.079
    opened = written("panda", grasps=widest).pre_grasp_posture.points[0]
    assert opened.positions == pytest.approx([0.04, 0.04])


def test_a_cup_has_no_joints() -> None:
    grasp = written("onrobot_vgc10")
    for posture in (grasp.pre_grasp_posture, grasp.grasp_posture):
        assert len(posture.joint_names) == len(posture.points) == 0
    assert grasp.max_contact_force == 0
