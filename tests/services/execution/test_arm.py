from __future__ import annotations

import numpy as np
import pytest

from services.execution.arm import FINGERS, HOME, LEFT_FINGER, Arm
from services.execution.bullet import Bullet
from services.execution.hand import hand_points, lowest_point
from services.execution.kinematics import (
    MAX_ANGLE_ERROR,
    MAX_POSITION_ERROR,
    pose_error,
    solutions,
    straight_line,
)
from shared.geometry.se3 import inverse, pose_matrix
from tests.services.execution.scenes import from_above

BASE = pose_matrix([0.3, -0.2, 0.1], np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]))


def finger_tips(bullet: Bullet, arm: Arm) -> list[np.ndarray]:
    """Where the middle of each pad's end is in the grasp frame, by rays between the fingers."""
    frame = arm.world_from_grasp()
    tips = []
    for side in (1, -1):
        start, end = (frame @ [0, 0, 0, 1])[:3], (frame @ [0, 0.1 * side, 0, 1])[:3]
        (hit,) = bullet.rayTest(start, end)
        assert hit[0] == arm.body
        tips.append((inverse(frame) @ [*hit[3], 1])[:3])
    return tips


def test_the_grasp_frame_lies_between_the_pads_and_closes_along_y(bullet: Bullet, arm: Arm) -> None:
    arm.set_joints(HOME + 0.1)
    for opening in (0.08, 0.03):
        arm.set_opening(opening)
        left, right = finger_tips(bullet, arm)
        assert left == pytest.approx([0, opening / 2, 0], abs=2e-3)
        assert right == pytest.approx([0, -opening / 2, 0], abs=2e-3)


def test_the_approach_axis_points_from_the_hand_to_the_tips(bullet: Bullet, arm: Arm) -> None:
    frame = inverse(arm.world_from_grasp())
    hand = np.array([*bullet.getLinkState(arm.body, 8)[4], 1.0])
    assert (frame @ hand)[:3] == pytest.approx([0, 0, -0.1034], abs=1e-6)


def test_the_hands_outline_is_that_of_the_model(bullet: Bullet, arm: Arm) -> None:
    arm.set_joints(HOME)
    arm.set_opening(0.05)
    outline = hand_points(0.05)
    assert outline[:, 2].max() == pytest.approx(0.0088, abs=2e-4)
    world_from_grasp = arm.world_from_grasp()
    lowest = lowest_point(world_from_grasp, 0.05)
    wall = bullet.createCollisionShape(6, planeNormal=[0, 0, 1])
    ground = bullet.createMultiBody(0, wall, basePosition=[0, 0, lowest - 0.02])
    distance = min(c[8] for c in bullet.getClosestPoints(arm.body, ground, 0.1) if c[3] in FINGERS)
    assert distance == pytest.approx(0.02, abs=1.5e-3)


def test_inverse_kinematics_is_confirmed_by_forward_kinematics(arm: Arm) -> None:
    arm.stand_at(BASE)
    rng = np.random.default_rng(0)
    solved = 0
    for _ in range(60):
        goal = arm.base_from_grasp(0.7 * rng.uniform(arm.lower, arm.upper) + 0.3 * HOME)
        for joints in solutions(arm, goal):
            error = pose_error(goal, arm.base_from_grasp(joints))
            assert np.linalg.norm(error[:3]) < MAX_POSITION_ERROR
            assert np.linalg.norm(error[3:]) < MAX_ANGLE_ERROR
            assert (joints >= arm.lower).all()
            assert (joints <= arm.upper).all()
            solved += 1
            break
    assert solved >= 57


def test_what_is_too_far_has_no_solution(arm: Arm) -> None:
    for reach in (0.95, 2.0):
        assert not list(solutions(arm, pose_matrix([reach, 0, 0.2], from_above())))


def test_a_straight_line_is_straight(arm: Arm) -> None:
    goals = [pose_matrix([0.5, 0, 0.4 - 0.02 * k], from_above()) for k in range(8)]
    path = straight_line(arm, goals[1:], next(solutions(arm, goals[0])))
    assert path is not None
    for before, after, here, there in zip(path, path[1:], goals[1:], goals[2:], strict=False):
        middle = arm.base_from_grasp((before + after) / 2)[:3, 3]
        assert middle == pytest.approx((here[:3, 3] + there[:3, 3]) / 2, abs=5e-4)


def test_a_line_out_of_reach_is_not_followed(arm: Arm) -> None:
    goals = [pose_matrix([0.6 + 0.05 * k, 0, 0.3], from_above()) for k in range(10)]
    assert straight_line(arm, goals, next(solutions(arm, goals[0]))) is None


def test_the_jacobian_is_that_of_the_grasp_frame(arm: Arm) -> None:
    arm.stand_at(BASE)
    joints = np.array([0.1, -0.5, 0.2, -2.0, 0.3, 1.8, 0.5])
    jacobian = arm.jacobian(joints)
    for joint in range(7):
        nudge = np.zeros(7)
        nudge[joint] = 0.01
        change = pose_error(
            arm.base_from_grasp(joints + nudge), arm.base_from_grasp(joints - nudge)
        )
        assert change / 0.02 == pytest.approx(jacobian[:, joint], abs=1e-3)


def test_both_fingers_yield_to_a_push_on_one(bullet: Bullet, arm: Arm) -> None:
    arm.set_joints(HOME)
    arm.set_opening(0.05)
    for _ in range(120):
        arm.drive(HOME, np.zeros(7))
        arm.drive_fingers(0.05)
        bullet.applyExternalForce(arm.body, LEFT_FINGER, [0, 60, 0], [0, 0, 0], 1)
        bullet.stepSimulation()
    left, right = (bullet.getJointState(arm.body, finger)[0] for finger in FINGERS)
    assert abs(left - 0.025) > 2e-3
    assert left == pytest.approx(right, abs=1.5e-3)
